# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Depth maps of shadow views: layers of one array texture, each drawn when first needed.

Where there are more views than layers some share one: it holds the view that was needed last.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import compress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...pacing.pieces import piece_of_work
from ...scene.arrays import EVERY_SET, Float64Array
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer, layer_of
from ..device.shaders import Piece, build_shader, flags, set_matrix
from ..device.state import drawing_state, set_viewport
from ..device.textures import depth_layers
from ..geometry.chunk import CHUNK, Chunk, Pieces
from ..geometry.chunk_attributes import CORNER_ATTRIBUTES
from ..geometry.scene_geometry import SceneGeometry
from .shadow_alpha import SHADOW_ALPHA, ShadowAlpha
from .shadow_views import MARGIN_TEXELS, SceneExtent, ShadowView
from .world import WorldLight

DIRECTION_RECORDS = 5
SLOPE_LIMIT_TEXELS = 20.0
"""Steepest bias: surfaces steeper than this towards the light get none of its light to speak of"""


BORDER = 1
"""Texels round a map that stay empty: they stand for all that lies outside of it"""


class ShadowCasters:
    """What is drawn into the maps: the scene's chunks without what casts on nothing."""

    def __init__(self, geometry: SceneGeometry, extent: SceneExtent, alpha: ShadowAlpha) -> None:
        self._geometry = geometry
        self._extent = extent
        self._alpha = alpha
        self._idle: dict[tuple[frozenset[int], int], dict[int, Pieces]] = {}
        self._revision = geometry.revision

    def draw(self, view: ShadowView, bias: tuple[float, float, float]) -> None:
        """All that casts in a view."""
        shader = _shadow_depth_shader()
        shader.bind()
        set_matrix(shader, "world_to_clip", view.world_to_clip)
        shader.uniform_float("bias", bias)
        for chunk, idle in self._in_view(view):
            batch = chunk.casters(idle, self._alpha.materials)
            if batch is not None:
                shader.uniform_sampler("positions", chunk.positions)
                batch.draw(shader)
        if not self._alpha.hashed:
            return
        shader = _hashed_depth_shader()
        shader.bind()
        set_matrix(shader, "world_to_clip", view.world_to_clip)
        shader.uniform_float("bias", bias)
        shader.uniform_int("turn", view.turn)
        self._alpha.bind(shader)
        for chunk, idle in self._in_view(view):
            for material, batch in chunk.casters_of(idle, self._alpha.hashed):
                shader.uniform_sampler("positions", chunk.positions)
                shader.uniform_sampler("corners", chunk.corners)
                shader.uniform_sampler("corner_attribute_records", chunk.attributes.texture(self._alpha.attributes))
                shader.uniform_int("material", material)
                batch.draw(shader)

    def _in_view(self, view: ShadowView) -> Iterator[tuple[Chunk, Pieces]]:
        """Chunks, and what of them casts on nothing."""
        key = (view.idle_planes, view.blocked_by)
        if self._revision != self._geometry.revision:
            self._revision = self._geometry.revision
            self._idle.clear()
        if key not in self._idle:
            self._idle[key] = self._idle_in_chunks(*key)
        idle = self._idle[key]
        chunks = self._geometry.chunks
        for chunk in compress(chunks, self._geometry.may_be_in(chunks, view.world_to_clip)):
            yield chunk, idle.get(id(chunk), frozenset())

    def _idle_in_chunks(self, planes: frozenset[int], blocked_by: int) -> dict[int, Pieces]:
        """By a chunk's id, pairs (instance in the chunk, piece)."""
        found: dict[int, set[tuple[int, int]]] = {}
        spared = [] if blocked_by == EVERY_SET else self._spared_pieces(blocked_by)
        for index, piece in [*self._extent.pieces_in_planes(planes), *spared]:
            chunk, local = self._geometry.place_of(int(index))
            found.setdefault(id(chunk), set()).add((local, int(piece)))
        return {key: frozenset(pairs) for key, pairs in found.items()}

    def _spared_pieces(self, blocked_by: int) -> list[tuple[int, int]]:
        """(instance, piece) of all that casts no shadow in a light which these shadow sets block."""
        return [
            (index, int(piece))
            for index, item in enumerate(self._geometry.placed)
            if not blocked_by >> item.instance.shadow_set & 1
            for piece in np.unique(item.pieces)
        ]


class ShadowMaps:
    """Square depth maps of `resolution`."""

    def __init__(self, resolution: int, bias_texels: float) -> None:
        """`bias_texels`: how far from its middle a texel counts: 1 in bilinear comparison, 0.5 for the nearest."""
        self.resolution = resolution
        self.views: list[ShadowView] = []
        self._bias_texels = bias_texels
        self.texture: Any = None
        """Once something has been drawn: it is large"""
        self.layers: Sequence[int] = ()
        """Of the texture, by view"""
        self._size = (0, 0)
        self._held: list[tuple[int, int]] = []
        """By layer its view, -1 for none, and the visit"""

    def plan(self, views: list[ShadowView], resolution: int | None = None, layers: Sequence[int] | None = None) -> None:
        """Hold these views from now on, in a layer each or in these `layers`, numbered from 0."""
        self.views = views
        self.layers = range(len(views)) if layers is None else layers
        self.resolution = resolution or self.resolution
        size = (self.resolution if views else 1, max(self.layers, default=0) + 1)
        if size != self._size:
            self._size, self.texture = size, None
        self.forget()

    def forget(self) -> None:
        """What casts has moved: all are drawn again when needed."""
        self._held = [(-1, 0)] * self._size[1]

    def draw(self, needed: Iterable[int], casters: ShadowCasters, visit: tuple[int, int] = (0, 1)) -> None:
        """Make sure that these views are there; restores the frame buffer and the state.

        `visit`: which of how many times each view is looked at; each time it holds something else of what is there by
        chance.
        """
        if self.texture is None:
            with piece_of_work("room for shadows"):
                self.texture = depth_layers(*self._size)
                self.texture.filter_mode(False)
        number, count = visit
        missing = [index for index in needed if self._held[self.layers[index]] != (index, number)]
        if not missing:
            return
        for index in missing:
            view, layer = self.views[index], self.layers[index]
            if count > 1:
                view = replace(view, turn=(view.turn[0] * count + number, count))
            target = frame_buffer(depth=layer_of(self.texture, layer))
            with piece_of_work("shadows"), target.bind(), drawing_state("LESS_EQUAL", depth_write=True):
                set_viewport(0, 0, self.resolution, self.resolution)
                target.clear(depth=1.0)
                set_viewport(BORDER, BORDER, self.resolution - 2 * BORDER, self.resolution - 2 * BORDER)
                casters.draw(view, (self._bias_texels, *_slope_limit(view)))
            self._held[layer] = (index, number)

    def hold(self, views: Sequence[int], points: Float64Array) -> bool:
        """Whether all world points (n, 3) are inside of every one of these views."""
        if not views:
            return True
        matrices = np.array([self.views[index].world_to_clip for index in views])
        clip = np.einsum("vij,nj->vni", matrices[:, :, :3], points) + matrices[:, None, :, 3]
        return bool((np.abs(clip[..., :3]) <= clip[..., 3:]).all())


def _slope_limit(view: ShadowView) -> tuple[float, float]:
    """Greatest bias in window depth: the first plus the second times (1 - depth)."""
    limit = SLOPE_LIMIT_TEXELS * view.texel_slope
    return (limit * (view.depth_terms[0] - 1.0), limit) if view.is_perspective else (limit, 0.0)


def window_rows(view: ShadowView, resolution: int) -> Float64Array:
    """(4, 4) rows that give a world point's texel x, texel y and depth in 0..1, each times w, and w."""
    half = 0.5 * resolution - BORDER
    to_window = np.array(
        [
            [half, 0.0, 0.0, 0.5 * resolution],
            [0.0, half, 0.0, 0.5 * resolution],
            [0.0, 0.0, 0.5, 0.5],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
    return to_window @ view.world_to_clip


def fill_shadow_records(block: Float64Array, maps: ShadowMaps, views: tuple[int, ...]) -> None:
    """Fill in how to look up the shadow: kind in [6, 3] (0 none, 1 one map, 2 cube), data in rows 7 to 11."""
    layers = [-1 if index < 0 else maps.layers[index] for index in views]
    if len(views) == 1 and views[0] >= 0:
        block[6, 3] = 1.0
        block[7:11] = window_rows(maps.views[views[0]], maps.resolution)
        block[11, 0] = layers[0]
    elif len(views) == 6 and max(views) >= 0:
        block[6, 3] = 2.0
        near_term, far_term = maps.views[max(views)].depth_terms
        block[7] = layers[:4]
        block[8] = [layers[4], layers[5], near_term, far_term]
        half = 0.5 * maps.resolution - BORDER
        block[9, :2] = [0.5 * maps.resolution, half * (1.0 - 2.0 * MARGIN_TEXELS / maps.resolution)]


def direction_records(
    light: WorldLight, layers: NDArray[np.int64], maps: ShadowMaps, draws: range
) -> tuple[Float64Array, list[int]]:
    """(n, 4) DIRECTION_RECORDS for each of the `draws` of the world's directions that has a map, and these maps;
    `layers`: of each direction its map, or -1."""
    found: list[int] = []
    records = []
    for number in draws:
        draw = number % len(light.draws)
        direction = light.draws[draw]
        layer = int(layers[direction])
        if layer < 0:
            continue
        weight = light.weights[draw] * (len(light.draws) / len(draws))
        rows = window_rows(maps.views[layer], maps.resolution)[:3]
        records.append([[*light.directions[direction], layer], *rows, [*weight, weight.sum()]])
        found.append(layer)
    return np.array(records, np.float64).reshape(-1, 4), found


_DEPTH = Piece(constants={"world_to_clip": "MAT4", "bias": "VEC3"}, writes_depth=True)


@gpu_cache
def _shadow_depth_shader() -> Any:
    return build_shader(
        "shadow depth",
        _DEPTH,
        Piece(
            samplers={"positions": "FLOAT_2D"},
            vertex="lighting/shadow_depth.vert.glsl",
            fragment="lighting/shadow_depth.frag.glsl",
        ),
    )


@gpu_cache
def _hashed_depth_shader() -> Any:
    """For casters that let light straight on."""
    return build_shader(
        "hashed shadow depth",
        _DEPTH,
        CHUNK,
        CORNER_ATTRIBUTES,
        SHADOW_ALPHA,
        Piece(
            constants={"material": "INT", "turn": "IVEC2"},
            smooth={"uv": "VEC2"},
            flat={"surface": "IVEC2"},
            defines=flags("HASHED"),
            vertex="lighting/shadow_depth.vert.glsl",
            fragment="lighting/shadow_depth.frag.glsl",
        ),
    )
