# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough mirrors while the view moves: what they would show if they were sharp, blurred in the picture.

One path a pixel flickers from frame to frame. Here each pixel shows the mean over the pixels whose sharp rays end where
its own lobe would, by places that do not change: a view that moves looks calm, and one that rests is drawn by paths.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

from ...scene.camera.view import View
from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.shaders import FULL_SCREEN, Piece, build_shader, named, set_matrix
from ..device.state import drawing_state, scissored, set_viewport
from ..device.textures import empty_texture
from ..programs.buffers import Buffers, reads
from ..surfaces.canvas import Canvas
from ..surfaces.materials import TABLE, Materials
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import VIEW
from ..surfaces.windows import Window

LEVELS = 7
"""Each half as large as the one before; the last one's texels are 64 pixels wide"""
TAPS = 24
"""Places whose mean a pixel shows"""
WIDTH, WIDER = 0.6, 2.3
"""Of the ellipse, in lobes: the first for sharp ones, as levels blur, too, and more by alpha, as slopes are no angles.
Least error at roughness 0.1 to 0.6 against converged paths"""
LARGEST_REACH = 0.25
"""Of an ellipse that holds half of a lobe, in heights of the picture"""
LEAST_COSINE = 0.2
"""Lobes are no narrower across the plane of incidence"""
PIXEL = 0.5
"""Standard deviation of a filter over all that, in pixels: a filtered pixel is not much narrower"""
PART_OF_NOW, MARGIN = 0.12, 1.0
"""Of a frame; the rest is of those before it, as far as they are within the range of the pixels around, or this much of
the range beside it"""
CREASE = 0.2
"""Normals turn so far, radians, without being another face's"""
DARKEST_TINT = 1e-3
_SEEN = ("seen_position", "seen_normal", "seen_color")


class CalmHistory:
    """What one viewport has shown last while it moves."""

    def __init__(self) -> None:
        self.view: View | None = None
        """Of the last frame"""
        self._canvases: list[Canvas] = []

    def turn(self, width: int, height: int) -> tuple[Canvas, Canvas]:
        """The last frame and the place of the next, of this size."""
        if not self._canvases or self._canvases[0].texture.width != width or self._canvases[0].texture.height != height:
            self._canvases = [Canvas.of_size(width, height) for _ in range(2)]
            self.view = None
        self._canvases.reverse()
        return self._canvases[0], self._canvases[1]


class CalmMirrors:
    """Targets of the size of a picture."""

    def __init__(self, width: int, height: int) -> None:
        self.sharp = Canvas.of_size(width, height)
        """What mirrors show with sharp rays: draw to it what is to be blurred, with a weight of 1"""
        self._blurred = Canvas.of_size(width, height)
        self._reach = empty_texture(width, height)
        self._reach_buffer = frame_buffer(self._reach)
        self._levels = []
        for _ in range(LEVELS):
            level = empty_texture(width, height)
            self._levels.append((level, frame_buffer(level)))
            width, height = -(-width // 2), -(-height // 2)

    def begin(self, seen: SurfaceBuffer, path: Any, materials: Materials, view_uniforms: Any, window: Window) -> None:
        """Forget the last picture. `path`: PathBuffer of the first rays off the mirrors that `seen` sees, all of them
        in the `window`."""
        self.sharp.clear()
        shader = _reach_shader(materials.buffers)
        with drawing_state(), self._reach_buffer.bind(), scissored(window):
            set_viewport(0, 0, seen.width, seen.height)
            shader.bind()
            _bind(shader, seen, materials, view_uniforms)
            seen.made.bind(shader, materials.buffers)
            shader.uniform_sampler("path_position", path.position)
            full_screen_triangle().draw(shader)

    def add(
        self,
        canvas: Canvas,
        weight: float,
        seen: SurfaceBuffer,
        materials: Materials,
        view: View,
        view_uniforms: Any,
        window: Window,
        history: CalmHistory | None,
    ) -> None:
        """Add the mirrors to a picture, rough ones blurred, times `weight`. `history`: of the frames before; None for
        sub-frames after a frame's first."""
        shader = _first_shader()
        level, target = self._levels[0]
        with target.bind():
            target.clear(color=(0.0, 0.0, 0.0, 0.0))
        with drawing_state(), target.bind(), scissored(window):
            set_viewport(0, 0, level.width, level.height)
            shader.bind()
            _bind(shader, seen, materials, view_uniforms)
            shader.uniform_sampler("sharp_picture", self.sharp.texture)
            shader.uniform_sampler("calm_reach", self._reach)
            full_screen_triangle().draw(shader)
        shader = _next_shader()
        for (finer, _), (level, target) in zip(self._levels, self._levels[1:], strict=False):
            with drawing_state(), target.bind():
                set_viewport(0, 0, level.width, level.height)
                shader.bind()
                shader.uniform_sampler("finer", finer)
                full_screen_triangle().draw(shader)
        shader = _blur_shader(materials.buffers)
        self._blurred.clear()
        with drawing_state(), self._blurred.frame_buffer.bind(), scissored(window):
            set_viewport(0, 0, seen.width, seen.height)
            shader.bind()
            _bind(shader, seen, materials, view_uniforms)
            seen.made.bind(shader, materials.buffers)
            shader.uniform_sampler("sharp_picture", self.sharp.texture)
            shader.uniform_sampler("calm_reach", self._reach)
            for number, (level, _) in enumerate(self._levels):
                shader.uniform_sampler(f"level_{number}", level)
            full_screen_triangle().draw(shader)
        shown = self._blurred if history is None else self._resolved(history, seen, view, view_uniforms, window)
        shader = _show_shader()
        with drawing_state(blend="ADDITIVE_PREMULT"), canvas.frame_buffer.bind(), scissored(window):
            set_viewport(0, 0, seen.width, seen.height)
            shader.bind()
            shader.uniform_float("weight", weight)
            shader.uniform_sampler("calm_picture", shown.texture)
            full_screen_triangle().draw(shader)

    def _resolved(
        self, history: CalmHistory, seen: SurfaceBuffer, view: View, view_uniforms: Any, window: Window
    ) -> Canvas:
        """With what was shown before."""
        last, shown = history.turn(seen.width, seen.height)
        shown.clear()
        shader = _resolve_shader()
        with drawing_state(), shown.frame_buffer.bind(), scissored(window):
            set_viewport(0, 0, seen.width, seen.height)
            shader.bind()
            shader.uniform_block("view", view_uniforms)
            set_matrix(shader, "last_to_clip", (history.view or view).world_to_clip)
            for name, texture in (
                ("seen_position", seen.position),
                ("seen_color", seen.color),
                ("calm_reach", self._reach),
                ("blurred_picture", self._blurred.texture),
                ("last_picture", self._blurred.texture if history.view is None else last.texture),
            ):
                shader.uniform_sampler(name, texture)
            full_screen_triangle().draw(shader)
        history.view = view
        return shown


def _bind(shader: Any, seen: SurfaceBuffer, materials: Materials, view_uniforms: Any) -> None:
    shader.uniform_block("view", view_uniforms)
    shader.uniform_sampler("materials", materials.table)
    for name, texture in zip(_SEEN, (seen.position, seen.normal, seen.color), strict=True):
        shader.uniform_sampler(name, texture)


_OF_MIRRORS = (FULL_SCREEN, VIEW, TABLE, Piece(samplers=named("FLOAT_2D", *_SEEN)))


@gpu_cache
def _reach_shader(buffers: Buffers) -> Any:
    return build_shader(
        "calm reach",
        *_OF_MIRRORS,
        reads(buffers),
        Piece(
            samplers={"path_position": "FLOAT_2D"},
            defines={
                "WIDTH": WIDTH,
                "WIDER": WIDER,
                "LARGEST_REACH": LARGEST_REACH,
                "LEAST_COSINE": LEAST_COSINE,
            },
            outputs={"reach": "VEC4"},
            fragment="calm/calm_reach.frag.glsl",
        ),
    )


@gpu_cache
def _first_shader() -> Any:
    return build_shader(
        "calm first",
        *_OF_MIRRORS,
        Piece(
            samplers=named("FLOAT_2D", "sharp_picture", "calm_reach"),
            defines={"DARKEST_TINT": DARKEST_TINT},
            outputs={"color": "VEC4"},
            fragment="calm/calm_first.frag.glsl",
        ),
    )


@gpu_cache
def _next_shader() -> Any:
    return build_shader(
        "calm next",
        FULL_SCREEN,
        Piece(samplers={"finer": "FLOAT_2D"}, outputs={"color": "VEC4"}, fragment="calm/calm_next.frag.glsl"),
    )


@gpu_cache
def _blur_shader(buffers: Buffers) -> Any:
    names = [f"level_{number}" for number in range(LEVELS)]
    return build_shader(
        "calm blur",
        *_OF_MIRRORS,
        reads(buffers),
        Piece(
            samplers=named("FLOAT_2D", "sharp_picture", "calm_reach", *names),
            defines={
                "LEVELS": LEVELS,
                "TAPS": TAPS,
                "PIXEL": PIXEL,
                "SPACING": sqrt(pi / TAPS),
                "GOLDEN_ANGLE": pi * (3.0 - sqrt(5.0)),
                "CREASE": CREASE,
                "LEVEL_CASES": " ".join(f"CASE({number}, {name})" for number, name in enumerate(names)),
            },
            outputs={"color": "VEC4"},
            fragment="calm/calm_blur.frag.glsl",
        ),
    )


@gpu_cache
def _resolve_shader() -> Any:
    return build_shader(
        "calm resolve",
        FULL_SCREEN,
        VIEW,
        Piece(
            samplers=named("FLOAT_2D", "seen_position", "seen_color", "calm_reach", "blurred_picture", "last_picture"),
            constants={"last_to_clip": "MAT4"},
            defines={"PART_OF_NOW": PART_OF_NOW, "MARGIN": MARGIN},
            outputs={"color": "VEC4"},
            fragment="calm/calm_resolve.frag.glsl",
        ),
    )


@gpu_cache
def _show_shader() -> Any:
    return build_shader(
        "calm show",
        FULL_SCREEN,
        Piece(
            samplers={"calm_picture": "FLOAT_2D"},
            constants={"weight": "FLOAT"},
            outputs={"color": "VEC4"},
            fragment="calm/calm_show.frag.glsl",
        ),
    )
