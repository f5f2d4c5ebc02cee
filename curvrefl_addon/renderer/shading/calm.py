# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough mirrors while the view moves: what they would show if they were sharp, blurred in the picture.

One path a pixel flickers from frame to frame. Here each pixel shows the mean over the pixels whose sharp rays end where
its own lobe would, by places that do not change: a view that moves looks calm, and one that rests is drawn by paths.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.shaders import FULL_SCREEN, Piece, build_shader, named
from ..device.state import drawing_state, scissored, set_viewport
from ..device.textures import empty_texture
from ..paths.features import SHARPEST_LOBE
from ..surfaces.canvas import Canvas
from ..surfaces.materials import TABLE, Materials
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import VIEW
from ..surfaces.windows import Window

LEVELS = 7
"""Each half as large as the one before; the last one's texels are 64 pixels wide"""
TAPS = 16
"""Places whose mean a pixel shows"""
WIDTH = 1.0
"""Of the ellipse, in lobes"""
LARGEST_REACH = 0.25
"""Of an ellipse that holds half of a lobe, in heights of the picture"""
LEAST_COSINE = 0.2
"""Lobes are no narrower across the plane of incidence"""
CREASE = 0.2
"""Normals turn so far, radians, without being another face's"""
DARKEST_TINT = 1e-3
_SEEN = ("seen_position", "seen_normal", "seen_color")


class CalmMirrors:
    """Targets of the size of a picture."""

    def __init__(self, width: int, height: int) -> None:
        self.sharp = Canvas.of_size(width, height)
        """What mirrors show with sharp rays: draw to it what is to be blurred, with a weight of 1"""
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
        shader = _reach_shader()
        with drawing_state(), self._reach_buffer.bind(), scissored(window):
            set_viewport(0, 0, seen.width, seen.height)
            shader.bind()
            _bind(shader, seen, materials, view_uniforms)
            shader.uniform_sampler("path_position", path.position)
            full_screen_triangle().draw(shader)

    def add(
        self,
        canvas: Canvas,
        weight: float,
        seen: SurfaceBuffer,
        materials: Materials,
        view_uniforms: Any,
        window: Window,
    ) -> None:
        """Add the mirrors to a picture, rough ones blurred, times `weight`."""
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
        shader = _blur_shader()
        with drawing_state(blend="ADDITIVE_PREMULT"), canvas.frame_buffer.bind(), scissored(window):
            set_viewport(0, 0, seen.width, seen.height)
            shader.bind()
            _bind(shader, seen, materials, view_uniforms)
            shader.uniform_float("weight", weight)
            shader.uniform_sampler("sharp_picture", self.sharp.texture)
            shader.uniform_sampler("calm_reach", self._reach)
            for number, (level, _) in enumerate(self._levels):
                shader.uniform_sampler(f"level_{number}", level)
            full_screen_triangle().draw(shader)


def _bind(shader: Any, seen: SurfaceBuffer, materials: Materials, view_uniforms: Any) -> None:
    shader.uniform_block("view", view_uniforms)
    shader.uniform_sampler("materials", materials.table)
    for name, texture in zip(_SEEN, (seen.position, seen.normal, seen.color), strict=True):
        shader.uniform_sampler(name, texture)


_OF_MIRRORS = (FULL_SCREEN, VIEW, TABLE, Piece(samplers=named("FLOAT_2D", *_SEEN)))


@gpu_cache
def _reach_shader() -> Any:
    return build_shader(
        "calm reach",
        *_OF_MIRRORS,
        Piece(
            samplers={"path_position": "FLOAT_2D"},
            defines={
                "SHARPEST_LOBE": SHARPEST_LOBE,
                "WIDTH": WIDTH,
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
def _blur_shader() -> Any:
    names = [f"level_{number}" for number in range(LEVELS)]
    return build_shader(
        "calm blur",
        *_OF_MIRRORS,
        Piece(
            samplers=named("FLOAT_2D", "sharp_picture", "calm_reach", *names),
            constants={"weight": "FLOAT"},
            defines={
                "LEVELS": LEVELS,
                "TAPS": TAPS,
                "SPACING": sqrt(pi / TAPS),
                "GOLDEN_ANGLE": pi * (3.0 - sqrt(5.0)),
                "CREASE": CREASE,
                "LEVEL_CASES": " ".join(f"CASE({number}, {name})" for number, name in enumerate(names)),
            },
            outputs={"color": "VEC4"},
            fragment="calm/calm_blur.frag.glsl",
        ),
    )
