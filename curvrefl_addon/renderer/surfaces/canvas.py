# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture that sub-frames are added to."""

from __future__ import annotations

from typing import Any

from ...scene.arrays import Float32Array
from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import FrameBuffers, frame_buffer, layer_of, wait_for
from ..device.shaders import FULL_SCREEN, Piece, build_shader
from ..device.state import blended, set_viewport
from ..device.textures import empty_texture, read_texture

MOST_DEPTHS = 4
"""Frame buffers that are kept"""


class Canvas:
    """A color texture, scene-linear and premultiplied, and the frame buffers that draw to it."""

    def __init__(self, texture: Any, face: int | None = None) -> None:
        """`face`: of a cube map."""
        self.texture = texture
        slot = texture if face is None else layer_of(texture, face)
        self.frame_buffer = frame_buffer(slot)
        self._frame_buffers = FrameBuffers(slot, most=MOST_DEPTHS)

    @classmethod
    def of_size(cls, width: int, height: int, linear: bool = False) -> Canvas:
        """An empty picture; `linear`: how its texels are to be looked up."""
        texture = empty_texture(width, height, linear=linear)
        texture.extend_mode("EXTEND")
        canvas = cls(texture)
        canvas.clear()
        return canvas

    def clear(self) -> None:
        """Nothing anywhere."""
        with self.frame_buffer.bind():
            self.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0))

    def scale(self, factor: float) -> None:
        """Multiply all of it."""
        shader = _scale_shader()
        with blended("MULTIPLY"), self.frame_buffer.bind():
            set_viewport(0, 0, self.texture.width, self.texture.height)
            shader.bind()
            shader.uniform_float("factor", factor)
            full_screen_triangle().draw(shader)

    def pixels(self) -> Float32Array:
        """(height, width, 4) copy; waits for the GPU."""
        return read_texture(self.texture)

    def wait(self) -> None:
        """Return when the GPU has finished."""
        wait_for(self.frame_buffer)

    def with_depth(self, depth: Any) -> Any:
        """Frame buffer of the picture and a depth texture of its size."""
        return self._frame_buffers.with_depth(depth)


@gpu_cache
def _scale_shader() -> Any:
    return build_shader(
        "scale",
        FULL_SCREEN,
        Piece(constants={"factor": "FLOAT"}, outputs={"color": "VEC4"}, fragment="common/scale.frag.glsl"),
    )
