# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rasterizes a mesh from the origin onto the six faces of a cube: farthest and nearest hit along every direction."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...optics.surfaces.cube_map import FACE_AXES
from ...scene.arrays import Float32Array, Int32Array
from ..device.batches import vertex_batch
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer, read_colors
from ..device.shaders import Piece, build_shader, named
from ..device.state import drawing_state, set_viewport
from ..device.textures import depth_texture, empty_texture

NEAR = 1e-5
"""Near plane, relative to the largest distance from the origin"""


class CubeRaster:
    """A mesh on the GPU, ready to be drawn through the faces of cubes about the origin."""

    def __init__(self, positions: Float32Array, normals: Float32Array, triangles: Int32Array, resolution: int) -> None:
        """Corners at `positions` (n, 3) with `normals` (n, 3), `triangles` (m, 3) that index them, counter-clockwise
        seen from outside, for faces of `resolution` x `resolution` texels. At least one triangle.
        """
        self.inverted = False
        """Take the triangles as clockwise seen from outside"""
        self.resolution = resolution
        self.depth_range = 1.001 * float(np.sqrt(np.einsum("ij,ij->i", positions, positions).max()))
        self._batch = vertex_batch({"position": positions, "normal": normals}, triangles)
        self._targets = [empty_texture(resolution, resolution) for _ in range(2)]
        self._depth = depth_texture(resolution, resolution)
        self._frame_buffer = frame_buffer(*self._targets, depth=self._depth)

    def farthest(self) -> tuple[Float32Array, Float32Array]:
        """Position and interpolated normal (6, n, n, 4) of the farthest hit, of either side of a triangle.

        w: 1 on the outside, -1 on the inside, 0 where there is no hit.
        """
        position, normal = self._draw("GREATER", 0.0, outside_only=False, slots=2)
        return position, normal

    def nearest_outside(self) -> Float32Array:
        """Position (6, n, n, 4) of the nearest hit on the outside of a triangle, where a ray first leaves the mesh.

        w: 1, or 0 where there is no hit.
        """
        return self._draw("LESS", 1.0, outside_only=True, slots=1)[0]

    def _draw(self, depth_test: str, clear_depth: float, outside_only: bool, slots: int) -> Float32Array:
        """Read back (slots, 6, n, n, 4) of position and normal."""
        size = self.resolution
        faces = np.empty((slots, 6, size, size, 4), np.float32)
        shader = _shader()
        shader.bind()
        shader.uniform_float("near", NEAR * self.depth_range)
        shader.uniform_float("depth_range", self.depth_range)
        shader.uniform_int("inverted", int(self.inverted))
        shader.uniform_int("outside_only", int(outside_only))
        for face, (axis_s, axis_t, axis_forward) in enumerate(FACE_AXES):
            with self._frame_buffer.bind(), drawing_state(depth_test, depth_write=True):
                set_viewport(0, 0, size, size)
                self._frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=clear_depth)
                shader.uniform_float("axis_s", axis_s)
                shader.uniform_float("axis_t", axis_t)
                shader.uniform_float("axis_forward", axis_forward)
                self._batch.draw(shader)
                for slot in range(slots):
                    faces[slot, face] = read_colors(self._frame_buffer, size, size, slot)
        return faces


@gpu_cache
def _shader() -> Any:
    return build_shader(
        "bake reflector",
        Piece(
            inputs=named("VEC3", "position", "normal"),
            smooth=named("VEC3", "map_position", "map_normal"),
            outputs=named("VEC4", "hit_position", "hit_normal"),
            # (In an order that leaves no gaps between them.)
            constants={
                "axis_s": "VEC3",
                "near": "FLOAT",
                "axis_t": "VEC3",
                "depth_range": "FLOAT",
                "axis_forward": "VEC3",
                "inverted": "INT",
                "outside_only": "INT",
            },
            writes_depth=True,
            vertex="bake/bake_reflector.vert.glsl",
            fragment="bake/bake_reflector.frag.glsl",
        ),
    )
