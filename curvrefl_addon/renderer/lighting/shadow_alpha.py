# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Casters that let light straight on: how much of it, place by place, for shadow maps and shadow rays.

A depth map is there or not, so of such a caster it holds some texels by chance and leaves out the others, each map
others: the mean over a lamp's maps is the light that gets on, of any number of surfaces one behind the other (Enderton
et al., "Stochastic transparency", 2010). The maps of one lamp take turns, so that each texel of a surface is there in
its share of them, to one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scene.arrays import Float32Array, Float64Array, ImageArrays, MaterialArrays, SceneArrays
from ...scene.materials.pixels import averaged
from ...scene.remarks import Remark, sentences
from ..device.records import TEXTURE_WIDTH, padded_count, record_texture
from ..device.shaders import Piece
from ..device.textures import largest_texture
from ..paths.features import lets_straight_on

ALPHA = "LIGHTING_ALPHA"
"""Define of the shaders that light a scene with such casters"""
ALPHA_RECORDS = 4
SHADOW_ALPHA = Piece(samplers={"caster_alphas": "FLOAT_2D"}, defines={"ALPHA_RECORDS": ALPHA_RECORDS})
"""What `light_through.glsl` needs"""
ROW_TEXELS = 4 * TEXTURE_WIDTH
"""Alphas of an image in one row of the texture"""
HASHED_SAMPLES, MOST_KEPT = 8, 16
"""Maps of a lamp without size where something is there by chance; pictures of more than so many sub-frames, whose maps
are not kept anyway, have one for each"""
GRAY = 0.02
"""A tint's channels differ by no more"""
EXTENSIONS = {"REPEAT": 0, "EXTEND": 1, "MIRROR": 2, "CLIP": 3}
IS_NEAREST = 4


class ShadowAlpha:
    """Of one scene."""

    def __init__(self, scene: SceneArrays) -> None:
        self._materials: tuple[MaterialArrays, ...] = ()
        self._images: tuple[ImageArrays, ...] = ()
        self.materials: frozenset[int] = frozenset()
        """Indices of those that are no opaque casters"""
        self.hashed: frozenset[int] = frozenset()
        """Those of them that cast a shadow at all"""
        self.warnings: tuple[str, ...] = ()
        self._texture: Any = None
        self.follow(scene)

    def follow(self, scene: SceneArrays) -> bool:
        """Know another state of the scene; whether shadows differ by it."""
        if scene.materials is self._materials and scene.images is self._images:
            return False
        before = (self.materials, [self._key(index) for index in sorted(self.materials)])
        self._materials, self._images = scene.materials, scene.images
        through = [self._passes(index) for index in range(len(scene.materials))]
        self.materials = frozenset(index for index, share in enumerate(through) if share > 0.0)
        self.hashed = frozenset(index for index in self.materials if through[index] < 1.0)
        cause = "Shadows {of} are gray where shadow maps serve: its tint is left out."
        tinted = [self._materials[index] for index in sorted(self.materials)]
        self.warnings = sentences(
            Remark(cause, "material", item.name) for item in tinted if np.ptp(item.transparent_tint) > GRAY
        )
        if before == (self.materials, [self._key(index) for index in sorted(self.materials)]):
            return False
        self._texture = None
        return True

    @property
    def is_hashed(self) -> bool:
        """Whether maps of one point differ, in what is there by chance: not so where thresholds decide."""
        return any(
            self._materials[index].alpha_threshold < 0.0 or np.mean(self._materials[index].transparent_tint) < 1.0
            for index in self.hashed
        )

    def repeated(self, places: Float64Array, count: int) -> Float64Array:
        """Points of a lamp (n, k), that of one without size as often as its maps differ in what they hold."""
        if not self.is_hashed or len(places) > 1:
            return places
        return np.repeat(places, count if count > MOST_KEPT else min(count, HASHED_SAMPLES), axis=0)

    def bind(self, shader: Any) -> None:
        """Set what `SHADOW_ALPHA` names on a bound shader."""
        if self._texture is None:
            self._texture = self._uploaded()
        shader.uniform_sampler("caster_alphas", self._texture)

    def _image_of(self, index: int) -> ImageArrays | None:
        """In whose alpha a material has its own."""
        scalars = self._materials[index].scalars
        return None if scalars is None else self._images[scalars.image]

    def _key(self, index: int) -> tuple[object, ...]:
        """What shadows depend on."""
        item, image = self._materials[index], self._image_of(index)
        return (item.alpha, item.alpha_threshold, item.alpha_inverted, item.transparent_tint, item.scalars, id(image))

    def _passes(self, index: int) -> float:
        """Share of light that gets through; of a material with an image between 0 and 1."""
        item = self._materials[index]
        if not lets_straight_on(item):
            return 0.0
        tint = float(np.mean(item.transparent_tint))
        if item.scalars is not None:
            return 0.5 * min(tint, 1.0)
        alpha = item.alpha
        if item.alpha_threshold >= 0.0:
            alpha = float((alpha > item.alpha_threshold) != item.alpha_inverted)
        return (1.0 - alpha) * tint

    def _uploaded(self) -> Any:
        """Records of all materials, then the alphas of their images, each from a row of its own, four to a record (see
        `light_through.glsl`)."""
        records = np.zeros((padded_count(len(self._materials) * ALPHA_RECORDS), 4), np.float32)
        rows = [records.reshape(-1, ROW_TEXELS)]
        starts: dict[int, tuple[int, int, int]] = {}
        images = {id(image): image for index in self.hashed if (image := self._image_of(index)) is not None}
        # (Fewer texels of each where all would not fit.)
        room = ((largest_texture() - len(rows[0])) // max(len(images), 1) - 1) * ROW_TEXELS
        for key, image in images.items():
            alpha = _shrunk(image.pixels[..., 3:], room)
            height, width = alpha.shape[:2]
            starts[key] = (sum(len(part) for part in rows), width, height)
            texels = np.zeros(-(-width * height // ROW_TEXELS) * ROW_TEXELS, np.float32)
            texels[: width * height] = alpha.ravel()
            rows.append(texels.reshape(-1, ROW_TEXELS))
        for index in self.materials:
            item, record = self._materials[index], records[ALPHA_RECORDS * index :]
            record[0] = (item.alpha, item.alpha_threshold, float(item.alpha_inverted), 0.0)
            record[3, :3] = item.transparent_tint
            image = self._image_of(index)
            if image is None or item.scalars is None:
                continue
            start, width, height = starts[id(image)]
            record[0, 0], record[0, 3] = -1.0, start
            record[1] = (*item.scalars.uv_scale, *item.scalars.uv_offset)
            record[2] = (*item.scalars.uv_turn, width, height)
            record[3, 3] = EXTENSIONS[image.extension] + IS_NEAREST * image.nearest
        return record_texture(np.concatenate(rows).reshape(-1, 4))


def _shrunk(alpha: Float32Array, room: int) -> Float32Array:
    """(height, width, 1) of no more texels than there is `room` for."""
    height, width = alpha.shape[:2]
    if width * height <= room:
        return alpha
    share = np.sqrt(room / (width * height))
    return np.asarray(averaged(alpha, max(int(height * share), 1), max(int(width * share), 1)), np.float32)
