# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What environment lookups show, as geometry: for comparisons, at the pixels' centers."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import gpu

from ....gpu_shaders.loader import load
from ...scene.arrays import Float32Array
from ..device.gpu_objects import drawing_state, full_screen_triangle, read_texture
from ..shading.lookup import Environment, declare
from ..surfaces.surfaces import SurfaceBuffer
from ..surfaces.view_block import TYPEDEF

_SEEN = ("seen_position", "seen_normal", "seen_color")


def environment_hits(seen: SurfaceBuffer, environments: Sequence[Environment], view_uniforms: Any) -> Float32Array:
    """(h, w, 4) world position and object_id of what the mirrors of these environments show, or the background's unit
    direction and 0; all 0 off the mirrors."""
    target = gpu.types.GPUTexture((seen.width, seen.height), format="RGBA32F")
    frame_buffer = gpu.types.GPUFrameBuffer(color_slots=(target,))
    # Before the frame buffer is bound: what is made only now draws, too.
    textures = [environment.positions() for environment in environments]
    with drawing_state(), frame_buffer.bind():
        gpu.state.viewport_set(0, 0, seen.width, seen.height)
        frame_buffer.clear(color=(0.0, 0.0, 0.0, 0.0))
        for environment, texture in zip(environments, textures, strict=True):
            shader = _hits_shader(environment.lookup)
            shader.bind()
            shader.uniform_block("view", view_uniforms)
            shader.uniform_float("mirror", float(environment.mirror))
            for name, buffer in zip(_SEEN, (seen.position, seen.normal, seen.color), strict=True):
                shader.uniform_sampler(name, buffer)
            environment.bind(shader, texture)
            full_screen_triangle().draw(shader)
    return read_texture(target)


@cache
def _hits_shader(lookup: str) -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.typedef_source(TYPEDEF)
    info.vertex_in(0, "VEC2", "pos")
    info.fragment_out(0, "VEC4", "color")
    info.uniform_buf(0, "ViewBlock", "view")
    info.push_constant("FLOAT", "mirror")
    info.define("SHOWS_SCENE")
    for slot, name in enumerate(_SEEN):
        info.sampler(slot, "FLOAT_2D", name)
    source = declare(info, lookup, len(_SEEN))
    info.vertex_source(load("common/full_screen.vert.glsl"))
    info.fragment_source(source + load("environments/environment_hits.frag.glsl"))
    return gpu.shader.create_from_info(info)
