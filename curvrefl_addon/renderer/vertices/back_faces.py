# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a mirror's own back hides what its front shows."""

from __future__ import annotations

from typing import Any

from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.shaders import Piece, build_shader
from ..device.state import drawing_state, hide_faces, set_viewport
from ..device.textures import depth_texture, empty_texture
from ..geometry.chunk import CHUNK, Batches, Chunk
from ..surfaces.view_block import VIEW


class BackFaces:
    """Distance from the eye to a reflector's nearest back face, 0 where there is none."""

    def __init__(self, width: int, height: int) -> None:
        self.distance = empty_texture(width, height, "R32F")
        self._depth = depth_texture(width, height)
        self.frame_buffer = frame_buffer(self.distance, depth=self._depth)
        self.width, self.height = width, height

    def draw(self, surface: tuple[Chunk, Batches], view_uniforms: Any, mirrored: bool) -> None:
        """Fill from the reflector's triangles (closed, counter-clockwise from outside); see `drawing_state`."""
        chunk, batches = surface
        shader = _back_faces_shader()
        with drawing_state("LESS_EQUAL", depth_write=True, mirrored=mirrored), self.frame_buffer.bind():
            set_viewport(0, 0, self.width, self.height)
            hide_faces("FRONT")
            self.frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            shader.bind()
            shader.uniform_block("view", view_uniforms)
            shader.uniform_sampler("positions", chunk.positions)
            shader.uniform_sampler("corners", chunk.corners)
            for _, batch in batches:
                batch.draw(shader)


@gpu_cache
def _back_faces_shader() -> Any:
    return build_shader(
        "back faces",
        VIEW,
        CHUNK,
        Piece(
            smooth={"world_position": "VEC3"},
            outputs={"eye_distance": "FLOAT"},
            vertex="vertices/back_faces.vert.glsl",
            fragment="vertices/back_faces.frag.glsl",
        ),
    )
