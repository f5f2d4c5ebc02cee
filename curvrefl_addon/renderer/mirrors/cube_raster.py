# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rasterises a mesh from the origin onto the six faces of a cube: farthest and nearest hit along every direction."""

from __future__ import annotations

from functools import cache
from typing import Any

import gpu
import numpy as np

from ....gpu_shaders.loader import load
from ...optics.surfaces.cube_map import FACE_AXES
from ...scene.arrays import Float32Array, Int32Array
from ..device.gpu_objects import drawing_state

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
        layout = gpu.types.GPUVertFormat()
        layout.attr_add(id="position", comp_type="F32", len=3, fetch_mode="FLOAT")
        layout.attr_add(id="normal", comp_type="F32", len=3, fetch_mode="FLOAT")
        vertices = gpu.types.GPUVertBuf(format=layout, len=len(positions))
        vertices.attr_fill("position", np.ascontiguousarray(positions, np.float32))
        vertices.attr_fill("normal", np.ascontiguousarray(normals, np.float32))
        elements = gpu.types.GPUIndexBuf(type="TRIS", seq=np.ascontiguousarray(triangles, np.int32))
        self._batch = gpu.types.GPUBatch(type="TRIS", buf=vertices, elem=elements)
        size = (resolution, resolution)
        self._targets = [gpu.types.GPUTexture(size, format="RGBA32F") for _ in range(2)]
        self._depth = gpu.types.GPUTexture(size, format="DEPTH_COMPONENT32F")
        self._frame_buffer = gpu.types.GPUFrameBuffer(depth_slot=self._depth, color_slots=tuple(self._targets))

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
                gpu.state.viewport_set(0, 0, size, size)
                self._frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=clear_depth)
                shader.uniform_float("axis_s", axis_s)
                shader.uniform_float("axis_t", axis_t)
                shader.uniform_float("axis_forward", axis_forward)
                self._batch.draw(shader)
                for slot in range(slots):
                    buffer = self._frame_buffer.read_color(0, 0, size, size, 4, slot, "FLOAT")
                    buffer.dimensions = size * size * 4
                    faces[slot, face] = np.array(buffer, np.float32).reshape(size, size, 4)
        return faces


@cache
def _shader() -> Any:
    varyings = gpu.types.GPUStageInterfaceInfo("bake_reflector")
    varyings.smooth("VEC3", "map_position")
    varyings.smooth("VEC3", "map_normal")
    info = gpu.types.GPUShaderCreateInfo()
    info.vertex_in(0, "VEC3", "position")
    info.vertex_in(1, "VEC3", "normal")
    info.vertex_out(varyings)
    info.fragment_out(0, "VEC4", "hit_position")
    info.fragment_out(1, "VEC4", "hit_normal")
    info.depth_write("ANY")
    info.push_constant("VEC3", "axis_s")
    info.push_constant("FLOAT", "near")
    info.push_constant("VEC3", "axis_t")
    info.push_constant("FLOAT", "depth_range")
    info.push_constant("VEC3", "axis_forward")
    info.push_constant("INT", "inverted")
    info.push_constant("INT", "outside_only")
    info.vertex_source(load("bake/bake_reflector.vert.glsl"))
    info.fragment_source(load("bake/bake_reflector.frag.glsl"))
    return gpu.shader.create_from_info(info)
