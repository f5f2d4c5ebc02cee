# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What lies over the status view: the vertices where they are reflected, and the triangles that are left out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...diagnostics.colors import DiagnosticColors
from ..device.batches import bare_batch
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.shaders import Piece, build_shader, named
from ..device.state import drawing_state, points_sized_by_shader, set_viewport
from ..device.textures import depth_texture, empty_texture
from ..geometry.chunk import CHUNK
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import VIEW
from ..vertices.solution import SolvedChunk


class DiagnosticMarks:
    """Draws them; its target is kept."""

    def __init__(self) -> None:
        self._target: _Target | None = None
        self._points: tuple[int, Any] = (0, None)

    def draw(
        self,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer,
        view_uniforms: Any,
        colors: DiagnosticColors,
        point_size: float,
        parts: Sequence[Sequence[SolvedChunk]],
    ) -> Any:
        """Texture with the left-out triangles and the vertices (`point_size` pixels), alpha 1 where they are."""
        marks = self._target
        if marks is None or (marks.width, marks.height) != (seen.width, seen.height):
            marks = self._target = _Target(seen.width, seen.height)
        with drawing_state("LESS_EQUAL", depth_write=True), marks.frame_buffer.bind():
            set_viewport(0, 0, seen.width, seen.height)
            marks.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            for mirror, chunks in enumerate(parts, 1):
                for chunk in (part for part in chunks if part.image == 0):
                    self._draw_failed(mirror, chunk, seen, view_uniforms, colors)
                    if point_size > 0.0:
                        self._draw_vertices(mirror, chunk, seen, reflected, view_uniforms, colors, point_size)
        return marks.color

    def _draw_failed(
        self, mirror: int, part: SolvedChunk, seen: SurfaceBuffer, view_uniforms: Any, colors: DiagnosticColors
    ) -> None:
        shader = _failed_shader()
        shader.bind()
        shader.uniform_block("view", view_uniforms)
        shader.uniform_float("mirror", float(mirror))
        shader.uniform_float("failed_color", colors.failed)
        for name, texture in (
            ("positions", part.chunk.positions),
            ("corners", part.chunk.corners),
            ("reflection_points", part.solution.reflection_points),
            ("virtual_positions", part.solution.virtual_positions),
            ("mirror_color", seen.color),
        ):
            shader.uniform_sampler(name, texture)
        for _, batch in part.batches:
            batch.draw(shader)

    def _draw_vertices(
        self,
        mirror: int,
        part: SolvedChunk,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer,
        view_uniforms: Any,
        colors: DiagnosticColors,
        size: float,
    ) -> None:
        count = part.solution.count
        if count == 0:
            return
        if self._points[0] < count:
            self._points = count, bare_batch(count, "POINTS")
        shader = _vertices_shader()
        shader.bind()
        shader.uniform_block("view", view_uniforms)
        shader.uniform_float("mirror", float(mirror))
        shader.uniform_float("point_size", size)
        shader.uniform_float("reflected_color", colors.converged)
        shader.uniform_float("hidden_color", colors.hidden)
        shader.uniform_float("failed_color", colors.failed)
        for name, texture in (
            ("reflection_points", part.solution.reflection_points),
            ("virtual_positions", part.solution.virtual_positions),
            ("mirror_position", seen.position),
            ("mirror_color", seen.color),
            ("reflected_position", reflected.position),
        ):
            shader.uniform_sampler(name, texture)
        with points_sized_by_shader():
            self._points[1].draw_range(shader, elem_start=0, elem_count=count)


class _Target:
    """Render target of what lies over the status view."""

    def __init__(self, width: int, height: int) -> None:
        self.color = empty_texture(width, height, "RGBA16F")
        self._depth = depth_texture(width, height)
        self.frame_buffer = frame_buffer(self.color, depth=self._depth)
        self.width, self.height = width, height


_MARK = (VIEW, Piece(constants={"mirror": "FLOAT"}, outputs={"mark": "VEC4"}))


@gpu_cache
def _vertices_shader() -> Any:
    return build_shader(
        "diagnostic vertices",
        *_MARK,
        Piece(
            samplers=named(
                "FLOAT_2D",
                "reflection_points",
                "virtual_positions",
                "mirror_position",
                "mirror_color",
                "reflected_position",
            ),
            constants={**named("VEC3", "reflected_color", "hidden_color", "failed_color"), "point_size": "FLOAT"},
            flat={"reflection_point": "VEC3", **named("FLOAT", "length_to_vertex", "vertex_status")},
            vertex="diagnostics/diagnostic_vertices.vert.glsl",
            fragment="diagnostics/diagnostic_vertices.frag.glsl",
        ),
    )


@gpu_cache
def _failed_shader() -> Any:
    return build_shader(
        "diagnostic failed",
        *_MARK,
        CHUNK,
        Piece(
            samplers=named("FLOAT_2D", "reflection_points", "virtual_positions", "mirror_color"),
            constants={"failed_color": "VEC3"},
            smooth={"failed": "VEC2"},
            vertex="diagnostics/diagnostic_failed.vert.glsl",
            fragment="diagnostics/diagnostic_failed.frag.glsl",
        ),
    )
