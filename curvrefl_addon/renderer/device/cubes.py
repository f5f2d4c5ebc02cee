# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cube maps.

In Blender 5.2 they are filled face by face (uploading one fills all faces with the first on OpenGL), and read-back goes
through a frame buffer.
"""

from __future__ import annotations

from typing import Any

import gpu
import numpy as np

from ...scene.arrays import Float32Array
from .batches import full_screen_triangle
from .context import gpu_cache
from .frame_buffers import frame_buffer, layer_of, read_colors
from .shaders import FULL_SCREEN, Piece, build_shader
from .state import drawing_state, set_viewport
from .textures import texture_layers


def empty_cube(resolution: int, fmt: str = "RGBA32F", linear: bool = True) -> Any:
    """Unfilled, to be drawn to face by face."""
    cube = gpu.types.GPUTexture(resolution, is_cubemap=True, format=fmt)
    cube.filter_mode(linear)
    return cube


def cube_texture(faces: np.ndarray, fmt: str = "RGBA32F", linear: bool = True) -> Any:
    """Cube map of (6, n, n, 4) faces in GL order (+X, -X, +Y, -Y, +Z, -Z), row 0 at t = 0."""
    size = faces.shape[1]
    source = texture_layers(faces)
    cube = empty_cube(size, fmt, linear)
    shader = _copy_shader()
    with drawing_state():
        for face in range(6):
            with frame_buffer(layer_of(cube, face)).bind():
                set_viewport(0, 0, size, size)
                shader.bind()
                shader.uniform_int("face", face)
                shader.uniform_sampler("source", source)
                full_screen_triangle().draw(shader)
    return cube


def read_cube(cube: Any) -> Float32Array:
    """(6, n, n, 4) faces of a color cube map; waits for the GPU."""
    size = cube.width
    faces = np.empty((6, size, size, 4), np.float32)
    for face in range(6):
        target = frame_buffer(layer_of(cube, face))
        with target.bind():
            faces[face] = read_colors(target, size, size)
    return faces


@gpu_cache
def _copy_shader() -> Any:
    return build_shader(
        "cube copy",
        FULL_SCREEN,
        Piece(
            samplers={"source": "FLOAT_2D_ARRAY"},
            constants={"face": "INT"},
            outputs={"color": "VEC4"},
            fragment="bake/cube_copy.frag.glsl",
        ),
    )
