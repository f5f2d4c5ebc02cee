# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The diagnostic pass: takes the place of the shade pass on mirrors and shows how the picture came about.

Iterations as in figure 3c of Roger & Holzschuch 2006; zebra stripes and line lights as in surface inspection.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...diagnostic_colors import (
    MODES,
    RAMP_TEXELS,
    SOLVED_MODES,
    DiagnosticColors,
    DiagnosticOptions,
    method_color,
    ramp_colors,
)
from ...scene.arrays import Float32Array
from ..device.batches import bare_batch, full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.records import record_texture
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from ..device.state import drawing_state, points_sized_by_shader, set_viewport
from ..device.textures import depth_texture, empty_texture, texture_2d
from ..geometry.chunk import CHUNK
from ..surfaces.pixel_classes import CHOSEN_MIRRORS
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import VIEW
from ..vertices.solution import SolvedChunk
from .lookup import Environment, lookup_piece

_SEEN = ("seen_position", "seen_normal", "seen_color")
_REFLECTED = ("reflected_position", "reflected_normal", "reflected_color")
_AXES = {"ZEBRA": ("stripe_axis",), "LINES": ("stripe_up", "stripe_side")}
_DARK, _BRIGHT = (0.008, 0.008, 0.010), (0.900, 0.900, 0.900)


class DiagnosticPass:
    """Draws diagnostic views of surface buffers; make it where a GPU context is."""

    def __init__(self, colors: DiagnosticColors | None = None) -> None:
        self.colors = colors or DiagnosticColors()
        ramp = np.ones((1, RAMP_TEXELS, 4), np.float32)
        ramp[0, :, :3] = ramp_colors(self.colors.ramp)
        self._ramp = texture_2d(ramp, "RGBA16F", linear=True)
        self._marks: _Marks | None = None
        self._points: tuple[int, Any] = (0, None)

    def add(
        self,
        target: Any,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer | Sequence[Environment],
        view_uniforms: Any,
        weight: float,
        mode: str,
        options: DiagnosticOptions,
        methods: Sequence[str],
        parts: Sequence[Sequence[SolvedChunk]] = (),
        chosen: Any = None,
    ) -> None:
        """Add view `mode` (of `MODES`), times `weight`, to the frame buffer `target` on the pixels of mirrors.

        Writes premultiplied scene-linear color with alpha = `weight`, as the shade pass does. `reflected` is the
        reflected scene's surface buffer, or for each mirror the environment whose positions stand for it; views that
        are not in `SOLVED_MODES` do not look at it.
        `methods` are the catalog names by which each mirror is drawn; the status view shows the vertices of `parts`,
        per mirror. `chosen`: record texture by mirrors' numbers, 1 of those that are drawn, None for all.
        """
        if mode not in MODES:
            raise ValueError(f"no diagnostic view {mode}")
        marks = None
        if mode == "STATUS" and isinstance(reflected, SurfaceBuffer):
            marks = self._draw_marks(seen, reflected, view_uniforms, options, parts)
        environments: Sequence[Environment | None] = (None,)
        if not isinstance(reflected, SurfaceBuffer) and mode in SOLVED_MODES:
            environments = reflected
        # Before the frame buffer is bound: what is made only now draws, too.
        textures = [environment.positions() if environment else None for environment in environments]
        with drawing_state(blend="ADDITIVE_PREMULT"), target.bind():
            set_viewport(0, 0, seen.width, seen.height)
            for environment, positions in zip(environments, textures, strict=True):
                shader = _shader(mode, environment.lookup if environment else "", marks is not None, chosen is not None)
                shader.bind()
                shader.uniform_block("view", view_uniforms)
                shader.uniform_float("weight", weight)
                for name, texture in zip(_SEEN, (seen.position, seen.normal, seen.color), strict=True):
                    shader.uniform_sampler(name, texture)
                # Held until the draw: a sampler is bound by reference.
                palette = self._set_look(shader, mode, options, methods)
                if environment is not None:
                    shader.uniform_float("mirror", float(environment.mirror))
                    environment.bind(shader, positions)
                elif mode in SOLVED_MODES and isinstance(reflected, SurfaceBuffer):
                    buffers = (reflected.position, reflected.normal, reflected.color)
                    for name, texture in zip(_REFLECTED, buffers, strict=True):
                        shader.uniform_sampler(name, texture)
                if marks is not None:
                    shader.uniform_sampler("marks", marks)
                if chosen is not None:
                    shader.uniform_sampler("chosen_mirrors", chosen)
                full_screen_triangle().draw(shader)
                del palette

    def _set_look(self, shader: Any, mode: str, options: DiagnosticOptions, methods: Sequence[str]) -> Any:
        """Set a view's own constants on the bound shader; returns what has to live until the draw."""
        if mode in ("ZEBRA", "LINES"):
            lines = mode == "LINES"
            axes = options.axes.tolist()
            # A constant that a shader declares and does not use cannot be set.
            for name, direction in zip(_AXES[mode], axes[1:] if lines else axes[:1], strict=True):
                shader.uniform_float(name, direction)
            shader.uniform_float("count", float(options.lines if lines else options.stripes))
            shader.uniform_float("duty", min(options.line_width * options.lines / 360.0, 1.0) if lines else 0.5)
            shader.uniform_float("dark", _DARK)
            shader.uniform_float("bright", _BRIGHT)
            return None
        if mode != "ANGLE_ERROR":
            shader.uniform_float("background", self.colors.background)
        if mode in ("ITERATIONS", "ANGLE_ERROR"):
            ends = np.log2(options.angles) if mode == "ANGLE_ERROR" else np.array(options.iterations)
            shader.uniform_float("range", ends.tolist())
            shader.uniform_sampler("ramp", self._ramp)
            return None
        palette = record_texture(self._palette(mode, methods))
        shader.uniform_sampler("palette", palette)
        return palette

    def _palette(self, mode: str, methods: Sequence[str]) -> Float32Array:
        """(mirrors + 1, 4): the color of each mirror's number."""
        rows = np.ones((len(methods) + 1, 4), np.float32)
        for row, method in zip(rows[1:], methods, strict=True):
            # The vertices' own colors are laid over this: it is only where they belong.
            row[:3] = method_color(method) if mode == "METHOD" else 0.4 * np.array(self.colors.converged)
        return rows

    def _draw_marks(
        self,
        seen: SurfaceBuffer,
        reflected: SurfaceBuffer,
        view_uniforms: Any,
        options: DiagnosticOptions,
        parts: Sequence[Sequence[SolvedChunk]],
    ) -> Any:
        """Texture with the left-out triangles and the vertices, alpha 1 where they are."""
        marks = self._marks
        if marks is None or (marks.width, marks.height) != (seen.width, seen.height):
            marks = self._marks = _Marks(seen.width, seen.height)
        with drawing_state("LESS_EQUAL", depth_write=True), marks.frame_buffer.bind():
            set_viewport(0, 0, seen.width, seen.height)
            marks.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            for mirror, chunks in enumerate(parts, 1):
                for chunk in (part for part in chunks if part.image == 0):
                    self._draw_failed(mirror, chunk, seen, view_uniforms)
                    if options.point_size > 0.0:
                        self._draw_vertices(mirror, chunk, seen, reflected, view_uniforms, options.point_size)
        return marks.color

    def _draw_failed(self, mirror: int, part: SolvedChunk, seen: SurfaceBuffer, view_uniforms: Any) -> None:
        shader = _failed_shader()
        shader.bind()
        shader.uniform_block("view", view_uniforms)
        shader.uniform_float("mirror", float(mirror))
        shader.uniform_float("failed_color", self.colors.failed)
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
        shader.uniform_float("reflected_color", self.colors.converged)
        shader.uniform_float("hidden_color", self.colors.hidden)
        shader.uniform_float("failed_color", self.colors.failed)
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


class _Marks:
    """Render target of what lies over the status view."""

    def __init__(self, width: int, height: int) -> None:
        self.color = empty_texture(width, height, "RGBA16F")
        self._depth = depth_texture(width, height)
        self.frame_buffer = frame_buffer(self.color, depth=self._depth)
        self.width, self.height = width, height


_FRAGMENTS = {
    "ITERATIONS": "ramp",
    "ANGLE_ERROR": "ramp",
    "STATUS": "palette",
    "METHOD": "palette",
    "ZEBRA": "stripes",
    "LINES": "stripes",
}
"""Kind of shader by the view"""
_OF_MIRROR = (
    VIEW,
    FULL_SCREEN,
    Piece(samplers=named("FLOAT_2D", *_SEEN), constants={"weight": "FLOAT"}, outputs={"color": "VEC4"}),
)
_OF_REFLECTED = Piece(samplers=named("FLOAT_2D", *_REFLECTED))
_MARK = (VIEW, Piece(constants={"mirror": "FLOAT"}, outputs={"mark": "VEC4"}))


@gpu_cache
def _shader(mode: str, lookup: str, marks: bool, with_choice: bool) -> Any:
    pieces = [*_OF_MIRROR, Piece(defines=flags(mode))]
    if mode in SOLVED_MODES:
        pieces.append(Piece(defines=flags("SHOWS_SCENE")))
        if mode != "ANGLE_ERROR":
            pieces.append(Piece(constants={"background": "VEC3"}))
        pieces += [Piece(constants={"mirror": "FLOAT"}), lookup_piece(lookup)] if lookup else [_OF_REFLECTED]
    look = _FRAGMENTS[mode]
    if look == "ramp":
        pieces.append(Piece(samplers={"ramp": "FLOAT_2D"}, constants={"range": "VEC2"}))
    elif look == "palette":
        pieces.append(Piece(samplers={"palette": "FLOAT_2D"}))
    else:
        pieces.append(
            Piece(constants={**named("VEC3", *_AXES[mode], "dark", "bright"), **named("FLOAT", "count", "duty")})
        )
    if marks:
        pieces.append(Piece(samplers={"marks": "FLOAT_2D"}, defines=flags("MARKS")))
    if with_choice:
        pieces.append(CHOSEN_MIRRORS)
    pieces.append(Piece(fragment=f"diagnostics/diagnostic_{look}.frag.glsl"))
    return build_shader(f"diagnostic {mode}", *pieces)


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
