# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Depth maps of shadow views: layers of one array texture, each drawn once, when first needed."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import Any

import gpu
import numpy as np

from ...gpu_shaders.loader import load
from ..scene.arrays import Float32Array, Float64Array
from .gpu_objects import drawing_state
from .lighting_shadow_views import SceneExtent, ShadowView

SLOPE_LIMIT_TEXELS = 20.0
"""Steepest bias: surfaces steeper than this towards the light get none of its light to speak of"""


MANY_TRIANGLES = 300_000
"""More than these are drawn into every map rather than sorted for each"""
BORDER = 1
"""Texels round a map that stay empty: they stand for all that lies outside of it"""


class ShadowCasters:
    """Positions and triangles on the GPU, nothing else."""

    def __init__(self, positions: Float32Array, extent: SceneExtent) -> None:
        """`positions` (n, 3), those of `extent`, whose triangles are drawn."""
        self._extent = extent
        self._batches: dict[frozenset[int], Any] = {}
        layout = gpu.types.GPUVertFormat()
        layout.attr_add(id="pos", comp_type="F32", len=3, fetch_mode="FLOAT")
        self._vertices = gpu.types.GPUVertBuf(format=layout, len=max(len(positions), 1))
        if len(positions):
            self._vertices.attr_fill("pos", np.ascontiguousarray(positions, np.float32))

    def batch(self, idle_planes: frozenset[int]) -> Any:
        """GPUBatch of the casting triangles outside these planes of the hull, None when there are none."""
        if len(self._extent.triangles) > MANY_TRIANGLES:
            idle_planes = frozenset()
        if idle_planes not in self._batches:
            chosen = self._extent.triangles[self._extent.casts & ~self._extent.in_planes(idle_planes)]
            made = None
            if len(chosen):
                elements = gpu.types.GPUIndexBuf(type="TRIS", seq=np.ascontiguousarray(chosen, np.int32))
                made = gpu.types.GPUBatch(type="TRIS", buf=self._vertices, elem=elements)
            self._batches[idle_planes] = made
        return self._batches[idle_planes]


class ShadowMaps:
    """Square depth maps of `resolution`, one layer per view."""

    def __init__(self, casters: ShadowCasters, resolution: int, views: list[ShadowView], bias_texels: float) -> None:
        """`bias_texels`: how far from its middle a texel counts: 1 in bilinear comparison, 0.5 for the nearest."""
        self.casters = casters
        self.resolution = resolution
        self.views = views
        self.bias_texels = bias_texels
        self.texture = gpu.types.GPUTexture(
            (resolution, resolution) if views else (1, 1), layers=max(len(views), 1), format="DEPTH_COMPONENT32F"
        )
        self.texture.filter_mode(False)
        self._drawn = [False] * len(views)

    def draw(self, layers: Iterable[int]) -> None:
        """Make sure that these layers are there; restores the frame buffer and the state."""
        missing = [layer for layer in layers if not self._drawn[layer]]
        if not missing:
            return
        shader = shadow_depth_shader()
        for layer in missing:
            view = self.views[layer]
            batch = self.casters.batch(view.idle_planes)
            target = gpu.types.GPUFrameBuffer(depth_slot={"texture": self.texture, "layer": layer})
            with target.bind(), drawing_state("LESS_EQUAL", depth_write=True):
                gpu.state.viewport_set(0, 0, self.resolution, self.resolution)
                target.clear(depth=1.0)
                gpu.state.viewport_set(BORDER, BORDER, self.resolution - 2 * BORDER, self.resolution - 2 * BORDER)
                if batch is not None:
                    shader.bind()
                    shader.uniform_float("world_to_clip", _matrix(view))
                    shader.uniform_float("bias", (self.bias_texels, *_slope_limit(view)))
                    batch.draw(shader)
            self._drawn[layer] = True


def _slope_limit(view: ShadowView) -> tuple[float, float]:
    """Greatest bias in window depth: the first plus the second times (1 - depth)."""
    limit = SLOPE_LIMIT_TEXELS * view.texel_slope
    return (limit * (view.depth_terms[0] - 1.0), limit) if view.is_perspective else (limit, 0.0)


def _matrix(view: ShadowView) -> Any:
    from mathutils import Matrix

    return Matrix(view.world_to_clip.tolist())


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


@cache
def shadow_depth_shader() -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.vertex_in(0, "VEC3", "pos")
    info.push_constant("MAT4", "world_to_clip")
    info.push_constant("VEC3", "bias")
    info.depth_write("ANY")
    info.vertex_source(load("shadow_depth.vert.glsl"))
    info.fragment_source(load("shadow_depth.frag.glsl"))
    return gpu.shader.create_from_info(info)
