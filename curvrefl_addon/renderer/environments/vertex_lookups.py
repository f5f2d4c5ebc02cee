# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The environment looked up at mirrors' own vertices, and interpolated over their triangles.

What smooth shading does with light, done with reflections: the first answer of McGill COMP 557, lecture 18. Kept to be
compared with lookups per pixel: within a triangle there is nothing but a blend of what its three corners reflect.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..device.batches import bare_batch
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.records import record_texture
from ..device.shaders import Piece, build_shader, flags
from ..device.state import drawing_state, set_viewport
from ..device.textures import depth_texture, empty_texture
from ..geometry.chunk import CHUNK, Batches, Chunk
from ..shading.lookup import Environment
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import VIEW


class VertexLookups:
    """Render target of what mirrors' vertices have looked up."""

    def __init__(self, width: int, height: int) -> None:
        self._picture = empty_texture(width, height)
        self._depth = depth_texture(width, height)
        self._frame_buffer = frame_buffer(self._picture, depth=self._depth)
        self._corners: dict[int, tuple[Chunk, Any, Any]] = {}
        self.width, self.height = width, height

    def draw(
        self,
        mirrors: Sequence[tuple[int, tuple[Chunk, Batches], Environment]],
        seen: SurfaceBuffer,
        view_uniforms: Any,
        of_positions: bool,
    ) -> list[Environment]:
        """Per mirror the environment in which each pixel finds what the vertices about it have looked up.

        `mirrors` has number, own surface and cube of each. With `of_positions` only `Environment.positions` serves, and
        it has what the triangle's corner of the largest weight has looked up: a blend of colors is a color, but a blend
        of points of two objects is on neither. Without it only `Environment.radiance` does. All is drawn over by the
        next call.
        """
        shader = _vertex_shader(of_positions)
        # Before the frame buffer is bound: what is made only now draws, too.
        cubes = [known.positions() if of_positions else known.radiance for _, _, known in mirrors]
        with drawing_state("LESS_EQUAL", depth_write=True), self._frame_buffer.bind():
            set_viewport(0, 0, self.width, self.height)
            self._frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            shader.bind()
            shader.uniform_block("view", view_uniforms)
            shader.uniform_sampler("mirror_color", seen.color)
            for (number, (chunk, batches), _), cube in zip(mirrors, cubes, strict=True):
                shader.uniform_float("mirror", float(number))
                shader.uniform_sampler("positions", chunk.positions)
                shader.uniform_sampler("corners", chunk.corners)
                shader.uniform_sampler("environment", cube)
                if of_positions:
                    triangles, batch = self._own_corners(chunk)
                    shader.uniform_sampler("triangles", triangles)
                    batch.draw(shader)
                else:
                    for _, batch in batches:
                        batch.draw(shader)
        if of_positions:
            used = {id(chunk) for _, (chunk, _), _ in mirrors}
            self._corners = {key: known for key, known in self._corners.items() if key in used}
        return [
            replace(environment, radiance=self._picture, positions=lambda: self._picture)
            for _, _, environment in mirrors
        ]

    def _own_corners(self, chunk: Chunk) -> tuple[Any, Any]:
        """Record texture of the triangles of a mirror's chunk (three corners each), and a batch of as many vertices."""
        known = self._corners.get(id(chunk))
        if known is None:
            (mirror,) = chunk.placed
            triangles = mirror.drawn.triangles
            records = np.zeros((len(triangles), 4), np.float32)
            records[:, :3] = triangles
            known = self._corners[id(chunk)] = (chunk, record_texture(records), bare_batch(3 * len(triangles)))
        return known[1:]


@gpu_cache
def _vertex_shader(nearest_corner: bool) -> Any:
    corner = Piece(
        samplers={"triangles": "FLOAT_2D"},
        defines=flags("NEAREST_CORNER"),
        flat={"triangle": "INT"},
        smooth={"weights": "VEC3"},
    )
    return build_shader(
        f"environment {'corner' if nearest_corner else 'vertex'}",
        VIEW,
        CHUNK,
        corner if nearest_corner else Piece(smooth={"looked_up": "VEC4"}),
        Piece(
            samplers={"mirror_color": "FLOAT_2D", "environment": "FLOAT_CUBE"},
            constants={"mirror": "FLOAT"},
            outputs={"color": "VEC4"},
            vertex="environments/environment_vertex.vert.glsl",
            fragment="environments/environment_vertex.frag.glsl",
        ),
    )
