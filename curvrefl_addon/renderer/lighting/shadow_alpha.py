# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Casters that let light straight on: how much of it, place by place, for shadow maps and shadow rays.

A depth map is there or not, so of such a caster it holds some texels by chance and leaves out the others, each map
others: the mean over a lamp's maps is the light that gets on, of any number of surfaces one behind the other (Enderton
et al., "Stochastic transparency", 2010). The maps of one lamp take turns, so that each texel of a surface is there in
its share of them, to one.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from ...scene.arrays import Float32Array, Float64Array, ImageSource, MaterialArrays, SceneArrays
from ...scene.materials.pixels import averaged
from ...scene.remarks import Remark, sentences
from ..device.records import TEXTURE_WIDTH, padded_count, record_texture
from ..device.shaders import Piece
from ..device.textures import largest_texture
from ..geometry.chunk_attributes import LACKING_BY_NAME, attributes_of
from ..paths.features import lets_straight_on
from .programs.casters import CasterImage

ALPHA = "LIGHTING_ALPHA"
"""Define of the shaders that light a scene with such casters"""
ALPHA_RECORDS = 3
SIDE = 4096
"""More than any image has texels along a side"""
SHADOW_ALPHA = Piece(
    samplers={"caster_alphas": "FLOAT_2D"},
    defines={"ALPHA_RECORDS": ALPHA_RECORDS, "SIDE": SIDE, "LACKING_BY_NAME": LACKING_BY_NAME},
)
"""What `light_through.glsl` needs"""
ROW_TEXELS = 4 * TEXTURE_WIDTH
"""Alphas of an image in one row of the texture"""
HASHED_SAMPLES, MOST_KEPT = 8, 16
"""Maps of a lamp without size where something is there by chance; pictures of more than so many sub-frames, whose maps
are not kept anyway, have one for each"""
GRAY = 0.02
"""A tint's channels differ by no more"""


class Bake(Protocol):
    """Of materials whose alpha differs from place to place: `CasterBake`."""

    def is_known(self, index: int) -> bool: ...
    def __call__(self, scene: SceneArrays, index: int) -> CasterImage: ...


class ShadowAlpha:
    """Of one scene."""

    def __init__(self, scene: SceneArrays, bake: Bake) -> None:
        self._bake = bake
        self._materials: tuple[MaterialArrays, ...] = ()
        self._images: tuple[ImageSource, ...] = ()
        self._known: frozenset[int] = frozenset()
        """Those whose alpha differs from place to place, and can be told by now; others are opaque until then"""
        self._baked: dict[int, tuple[object, CasterImage]] = {}
        """By material, with what it was made of"""
        self.materials: frozenset[int] = frozenset()
        """Indices of those that are no opaque casters"""
        self.hashed: frozenset[int] = frozenset()
        """Those of them that cast a shadow at all"""
        self._texture: Any = None
        self.follow(scene)

    def follow(self, scene: SceneArrays) -> bool:
        """Know another state of the scene; whether shadows differ by it."""
        self._scene = scene
        self.attributes = attributes_of(scene)
        """What programs read of meshes, in the order of their numbers"""
        varying = [index for index, item in enumerate(scene.materials) if _varies(item)]
        known = frozenset(index for index in varying if self._bake.is_known(index))
        if scene.materials is self._materials and scene.images is self._images and known == self._known:
            return False
        before = (self.materials, [self._key(index) for index in sorted(self.materials)])
        self._materials, self._images, self._known = scene.materials, scene.images, known
        through = [self._passes(index) for index in range(len(scene.materials))]
        self.materials = frozenset(index for index, share in enumerate(through) if share > 0.0)
        self.hashed = frozenset(index for index in self.materials if through[index] < 1.0)
        if before == (self.materials, [self._key(index) for index in sorted(self.materials)]):
            return False
        self._texture = None
        return True

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        cause = "Shadows {of} are gray where shadow maps serve: its tint is left out."
        tinted = [self._materials[index] for index in sorted(self.materials)]
        found = [Remark(cause, "material", item.name) for item in tinted if np.ptp(item.transparent_tint) > GRAY]
        cause = "Shadows {of} let light through everywhere alike: its transparency is on no UV map."
        for index in sorted(self.hashed):
            if _varies(self._materials[index]) and self._image_of(index).attribute < 0:
                found.append(Remark(cause, "material", self._materials[index].name))
        return sentences(found)

    @property
    def is_hashed(self) -> bool:
        """Whether maps of one point differ, in what is there by chance: not so where all is there or not."""
        return any(
            np.mean(self._materials[index].transparent_tint) < 1.0
            or not (_varies(self._materials[index]) and self._image_of(index).is_binary)
            for index in self.hashed
        )

    def repeated(self, places: Float64Array, count: int) -> Float64Array:
        """Points of a lamp (n, k), that of one without size as often as its maps differ in what they hold."""
        if not self.is_hashed or len(places) > 1:
            return places
        return np.repeat(places, count if count > MOST_KEPT else min(count, HASHED_SAMPLES), axis=0)

    def prepare(self) -> None:
        """Before anything is drawn with it: images are drawn here that are not there yet."""
        if self._texture is None and self.materials:
            self._texture = self._uploaded()

    def bind(self, shader: Any) -> None:
        """Set what `SHADOW_ALPHA` names on a bound shader, once prepared."""
        shader.uniform_sampler("caster_alphas", self._texture)

    def _image_of(self, index: int) -> CasterImage:
        """The alpha of a material for which it `_varies`."""
        key = self._key(index)
        if index not in self._baked or self._baked[index][0] != key:
            self._baked[index] = (key, self._bake(self._scene, index))
        return self._baked[index][1]

    def _key(self, index: int) -> tuple[object, ...]:
        """What shadows depend on."""
        item = self._materials[index]
        if item.program is None or not _varies(item):
            return (item.alpha, item.transparent_tint)
        images = [id(self._images[use.image]) for use in item.program.images]
        return (item.transparent_tint, item.program.shape, item.program.records.tobytes(), images)

    def _passes(self, index: int) -> float:
        """Share of light that gets through; of a material whose alpha differs between 0 and 1."""
        item = self._materials[index]
        if not lets_straight_on(item):
            return 0.0
        tint = float(np.mean(item.transparent_tint))
        if _varies(item):
            return 0.5 * min(tint, 1.0) if index in self._known else 0.0
        return (1.0 - item.range_of("alpha")[0]) * tint

    def _uploaded(self) -> Any:
        """Records of all materials, then the alphas of their images, each from a row of its own, four to a record (see
        `light_through.glsl`)."""
        records = np.zeros((padded_count(len(self._materials) * ALPHA_RECORDS), 4), np.float32)
        rows = [records.reshape(-1, ROW_TEXELS)]
        images = {index: self._image_of(index) for index in sorted(self.materials) if _varies(self._materials[index])}
        # (Fewer texels of each where all would not fit.)
        room = ((largest_texture() - len(rows[0])) // max(len(images), 1) - 1) * ROW_TEXELS
        for index in self.materials:
            item, record = self._materials[index], records[ALPHA_RECORDS * index :]
            record[0] = (item.range_of("alpha")[0], 0.0, -1.0, 0.0)
            record[2, :3] = item.transparent_tint
            image = images.get(index)
            if image is None:
                continue
            if image.attribute < 0:
                record[0, 0] = image.alpha.mean()
                continue
            alpha = _shrunk(image.alpha, room)
            height, width = alpha.shape
            record[0] = (-1.0, sum(len(part) for part in rows), image.attribute, float(image.is_binary))
            record[1] = (*image.low, *image.size)
            record[2, 3] = width + SIDE * height
            texels = np.zeros(-(-width * height // ROW_TEXELS) * ROW_TEXELS, np.float32)
            texels[: width * height] = alpha.ravel()
            rows.append(texels.reshape(-1, ROW_TEXELS))
        return record_texture(np.concatenate(rows).reshape(-1, 4))


def _varies(material: MaterialArrays) -> bool:
    """Whether alpha differs from place to place."""
    low, high = material.range_of("alpha")
    return low < high


def _shrunk(alpha: Float32Array, room: int) -> Float32Array:
    """(height, width) of no more texels than there is `room` for."""
    height, width = alpha.shape
    if width * height <= room:
        return alpha
    share = np.sqrt(room / (width * height))
    shrunk = averaged(alpha[..., None], max(int(height * share), 1), max(int(width * share), 1))
    return np.asarray(shrunk[..., 0], np.float32)
