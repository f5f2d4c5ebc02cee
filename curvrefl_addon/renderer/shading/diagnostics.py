# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The diagnostic pass: takes the place of the shade pass on mirrors and shows how the picture came about.

Iterations as in figure 3c of Roger & Holzschuch 2006. Of the patterns of surface inspection zebra stripes and line
lights are what is seen in the mirror; isophotes and highlight lines depend on the normal alone. Highlight lines: Beier
and Chen, "Highlight-line algorithm for realtime surface-quality assessment", 1994, with the lamps endlessly far away:
the line along the normal passes a lamp within its radius where it is within an angle.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...diagnostics.colors import (
    LAMP_MODES,
    MODES,
    NORMAL_MODES,
    ONE_SIDED,
    PATTERN_MODES,
    RAMP_TEXELS,
    SOLVED_MODES,
    Color,
    DiagnosticColors,
    DiagnosticOptions,
    curvature_ramp,
    method_color,
    ramp_colors,
)
from ...scene.arrays import Float32Array, Float64Array
from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.records import record_texture
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from ..device.state import drawing_state, set_viewport
from ..device.textures import texture_2d
from ..surfaces.pixel_classes import CHOSEN_MIRRORS
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import VIEW
from ..vertices.solution import SolvedChunk
from .curvature import CurvatureBuffer
from .diagnostic_marks import DiagnosticMarks
from .lookup import Environment, lookup_piece

_SEEN = ("seen_position", "seen_normal", "seen_color")
_REFLECTED = ("reflected_position", "reflected_normal", "reflected_color")
_FRAME = ("stripe_axis", "stripe_up", "stripe_side")
_DARK, _BRIGHT = (0.008, 0.008, 0.010), (0.900, 0.900, 0.900)


class DiagnosticPass:
    """Draws diagnostic views of surface buffers; make it where a GPU context is."""

    def __init__(self, colors: DiagnosticColors | None = None) -> None:
        self.colors = colors or DiagnosticColors()
        self._ramps: dict[tuple[Color, ...], Any] = {}
        self._marks = DiagnosticMarks()

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
        turns: Float64Array | None = None,
        curved: CurvatureBuffer | None = None,
    ) -> None:
        """Add view `mode` (of `MODES`), times `weight`, to the frame buffer `target` on the pixels of mirrors.

        Writes premultiplied scene-linear color with alpha = `weight`, as the shade pass does. `reflected` is the
        reflected scene's surface buffer, or for each mirror the environment whose positions stand for it; views that
        are not in `SOLVED_MODES` do not look at it.
        `methods` are the catalog names by which each mirror is drawn; the status view shows the vertices of `parts`,
        per mirror. `chosen`: record texture by mirrors' numbers, 1 of those that are drawn, None for all. `turns`: what
        the options' directions are turned by, (3, 3), or (mirrors, 3, 3) for each; None: they are those of the world.
        The curvature view shows what is `curved`.
        """
        if mode not in MODES:
            raise ValueError(f"no diagnostic view {mode}")
        marks = None
        if mode == "STATUS" and isinstance(reflected, SurfaceBuffer):
            marks = self._marks.draw(seen, reflected, view_uniforms, self.colors, options.point_size, parts)
        environments: Sequence[Environment | None] = (None,)
        if not isinstance(reflected, SurfaceBuffer) and mode in SOLVED_MODES:
            environments = reflected
        by_mirror = turns is not None and turns.ndim == 3 and mode in PATTERN_MODES
        # Before the frame buffer is bound: what is made only now draws, too.
        textures = [environment.positions() if environment else None for environment in environments]
        with drawing_state(blend="ADDITIVE_PREMULT"), target.bind():
            set_viewport(0, 0, seen.width, seen.height)
            for environment, positions in zip(environments, textures, strict=True):
                lookup = environment.lookup if environment else ""
                shader = _shader(
                    mode, lookup, marks is not None, chosen is not None, by_mirror, _curvature_defines(mode, options)
                )
                shader.bind()
                shader.uniform_block("view", view_uniforms)
                shader.uniform_float("weight", weight)
                for name, texture in zip(_SEEN, (seen.position, seen.normal, seen.color), strict=True):
                    shader.uniform_sampler(name, texture)
                # Held until the draw: a sampler is bound by reference.
                held = self._set_look(shader, mode, options, methods, turns, curved)
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
                del held

    def _set_look(
        self,
        shader: Any,
        mode: str,
        options: DiagnosticOptions,
        methods: Sequence[str],
        turns: Float64Array | None,
        curved: CurvatureBuffer | None,
    ) -> Any:
        """Set a view's own constants on the bound shader; returns what has to live until the draw."""
        if mode in PATTERN_MODES:
            return _set_pattern(shader, mode, options, turns)
        if mode != "ANGLE_ERROR":
            shader.uniform_float("background", self.colors.background)
        if mode == "CURVATURE":
            if curved is None:
                raise ValueError("the curvature view needs a buffer of curvature")
            ramp = self._ramp(curvature_ramp(options, self.colors))
            start = 0.0 if options.curvature == ONE_SIDED else -curved.end
            shader.uniform_float("range", (start, curved.end))
            shader.uniform_float("opacity", 1.0 - options.transparency)
            shader.uniform_sampler("ramp", ramp)
            shader.uniform_sampler("curved_diagonal", curved.diagonal)
            shader.uniform_sampler("curved_across", curved.across)
            return ramp
        if mode in ("ITERATIONS", "ANGLE_ERROR"):
            ends = np.log2(options.angles) if mode == "ANGLE_ERROR" else np.array(options.iterations)
            shader.uniform_float("range", ends.tolist())
            shader.uniform_sampler("ramp", self._ramp(self.colors.ramp))
            return None
        palette = record_texture(self._palette(mode, methods))
        shader.uniform_sampler("palette", palette)
        return palette

    def _ramp(self, stops: tuple[Color, ...]) -> Any:
        if stops not in self._ramps:
            ramp = np.ones((1, RAMP_TEXELS, 4), np.float32)
            ramp[0, :, :3] = ramp_colors(stops)
            self._ramps[stops] = texture_2d(ramp, "RGBA16F", linear=True)
        return self._ramps[stops]

    def _palette(self, mode: str, methods: Sequence[str]) -> Float32Array:
        """(mirrors + 1, 4): the color of each mirror's number."""
        rows = np.ones((len(methods) + 1, 4), np.float32)
        for row, method in zip(rows[1:], methods, strict=True):
            # The vertices' own colors are laid over this: it is only where they belong.
            row[:3] = method_color(method) if mode == "METHOD" else 0.4 * np.array(self.colors.converged)
        return rows


def _set_pattern(shader: Any, mode: str, options: DiagnosticOptions, turns: Float64Array | None) -> Any:
    """As `_set_look`, for stripes, bands and lamps."""
    is_lamps = mode in LAMP_MODES
    axes = options.axes if turns is None else options.axes @ np.swapaxes(turns, -1, -2)
    held = None
    if axes.ndim == 3:
        records = np.zeros((len(axes) + 1, 3, 4), np.float32)
        records[1:, :, :3] = axes
        held = record_texture(records.reshape(-1, 4))
        shader.uniform_sampler("stripe_frames", held)
    else:
        # A constant that a shader declares and does not use cannot be set.
        for name, direction in list(zip(_FRAME, axes.tolist(), strict=True))[
            1 if is_lamps else 0 : 3 if is_lamps else 1
        ]:
            shader.uniform_float(name, direction)
    duty = min(options.line_width * options.lines / 360.0, 1.0) if is_lamps else 0.5
    shader.uniform_float("count", float(options.lines if is_lamps else options.stripes))
    shader.uniform_float("duty", duty)
    shader.uniform_float("softness", options.softness * min(duty, 1.0 - duty))
    shader.uniform_float("opacity", 1.0 - options.transparency)
    shader.uniform_float("dark", _DARK)
    shader.uniform_float("bright", _BRIGHT)
    return held


def _curvature_defines(mode: str, options: DiagnosticOptions) -> tuple[str, ...]:
    """Of the shader of the curvature view."""
    return () if mode != "CURVATURE" else (options.curvature, *(["DIRECTIONS"] if options.directions else []))


_FRAGMENTS = {
    "ITERATIONS": "ramp",
    "ANGLE_ERROR": "ramp",
    "STATUS": "palette",
    "METHOD": "palette",
    "ZEBRA": "stripes",
    "LINES": "stripes",
    "ISOPHOTES": "stripes",
    "HIGHLIGHTS": "stripes",
    "CURVATURE": "curvature",
}
"""Kind of shader by the view"""
_OF_MIRROR = (
    VIEW,
    FULL_SCREEN,
    Piece(samplers=named("FLOAT_2D", *_SEEN), constants={"weight": "FLOAT"}, outputs={"color": "VEC4"}),
)
_OF_REFLECTED = Piece(samplers=named("FLOAT_2D", *_REFLECTED))


@gpu_cache
def _shader(mode: str, lookup: str, marks: bool, with_choice: bool, by_mirror: bool, curvature: tuple[str, ...]) -> Any:
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
    elif look == "curvature":
        pieces.append(
            Piece(
                samplers=named("FLOAT_2D", "ramp", "curved_diagonal", "curved_across"),
                constants={"range": "VEC2", "background": "VEC3", "opacity": "FLOAT"},
                defines=flags(*curvature),
            )
        )
    else:
        pieces.append(_pattern_piece(mode, by_mirror))
    if marks:
        pieces.append(Piece(samplers={"marks": "FLOAT_2D"}, defines=flags("MARKS")))
    if with_choice:
        pieces.append(CHOSEN_MIRRORS)
    pieces.append(Piece(fragment=f"diagnostics/diagnostic_{look}.frag.glsl"))
    return build_shader(f"diagnostic {mode}", *pieces)


def _pattern_piece(mode: str, by_mirror: bool) -> Piece:
    is_lamps = mode in LAMP_MODES
    axes = () if by_mirror else _FRAME[1:] if is_lamps else _FRAME[:1]
    chosen = [(is_lamps, "LAMPS"), (mode in NORMAL_MODES, "OF_NORMALS"), (by_mirror, "FRAMES_BY_MIRROR")]
    return Piece(
        samplers={"stripe_frames": "FLOAT_2D"} if by_mirror else {},
        constants={**named("VEC3", *axes, "dark", "bright"), **named("FLOAT", "count", "duty", "softness", "opacity")},
        defines=flags(*(name for applies, name in chosen if applies)),
    )
