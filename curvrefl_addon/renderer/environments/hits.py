# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What environment lookups show, as geometry: for comparisons, at the pixels' centers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...scene.arrays import Float32Array
from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer
from ..device.shaders import FULL_SCREEN, Piece, build_shader, flags, named
from ..device.state import drawing_state, set_viewport
from ..device.textures import empty_texture, read_texture
from ..shading.lookup import Environment, lookup_piece
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.view_block import VIEW

_SEEN = ("seen_position", "seen_normal", "seen_color")


def environment_hits(seen: SurfaceBuffer, environments: Sequence[Environment], view_uniforms: Any) -> Float32Array:
    """(h, w, 4) world position and object_id of what the mirrors of these environments show, or the background's unit
    direction and 0; all 0 off the mirrors."""
    picture = empty_texture(seen.width, seen.height)
    target = frame_buffer(picture)
    # Before the frame buffer is bound: what is made only now draws, too.
    textures = [environment.positions() for environment in environments]
    with drawing_state(), target.bind():
        set_viewport(0, 0, seen.width, seen.height)
        target.clear(color=(0.0, 0.0, 0.0, 0.0))
        for environment, texture in zip(environments, textures, strict=True):
            shader = _hits_shader(environment.lookup)
            shader.bind()
            shader.uniform_block("view", view_uniforms)
            shader.uniform_float("mirror", float(environment.mirror))
            for name, buffer in zip(_SEEN, (seen.position, seen.normal, seen.color), strict=True):
                shader.uniform_sampler(name, buffer)
            environment.bind(shader, texture)
            full_screen_triangle().draw(shader)
    return read_texture(picture)


@gpu_cache
def _hits_shader(lookup: str) -> Any:
    return build_shader(
        f"hits {lookup}",
        VIEW,
        FULL_SCREEN,
        lookup_piece(lookup),
        Piece(
            samplers=named("FLOAT_2D", *_SEEN),
            constants={"mirror": "FLOAT"},
            outputs={"color": "VEC4"},
            defines=flags("SHOWS_SCENE"),
            fragment="environments/environment_hits.frag.glsl",
        ),
    )
