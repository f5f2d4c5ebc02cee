# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts a picture of mirrors over a viewport's own."""

from __future__ import annotations

from functools import cache
from typing import Any

from ..renderer.device.batches import full_screen_triangle
from ..renderer.device.shaders import FULL_SCREEN, Piece, build_shader
from ..renderer.device.state import drawing_state, set_viewport, write_depth_again
from ..renderer.surfaces.canvas import Canvas


def composite(canvas: Canvas, sub_frames: int, frame_buffer: Any, viewport: tuple[int, int, int, int]) -> None:
    """The mean of so many sub-frames, over what the frame buffer holds."""
    shader = _composite_shader()
    with frame_buffer.bind():
        set_viewport(*viewport)
        with drawing_state(blend="ALPHA_PREMULT"):
            shader.bind()
            shader.uniform_float("sub_frames", float(max(sub_frames, 1)))
            shader.uniform_float("region", tuple(float(number) for number in viewport))
            shader.uniform_sampler("picture", canvas.texture)
            full_screen_triangle().draw(shader)
    write_depth_again()


@cache
def _composite_shader() -> Any:
    return build_shader(
        "composite",
        FULL_SCREEN,
        Piece(
            samplers={"picture": "FLOAT_2D"},
            constants={"sub_frames": "FLOAT", "region": "VEC4"},
            outputs={"color": "VEC4"},
            fragment="common/composite.frag.glsl",
        ),
    )
