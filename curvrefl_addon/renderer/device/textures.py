# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures, from numpy arrays or to draw to, and back again.

Nothing is created at import. Blender 5.2's traps that these functions steer round: buffers must be contiguous float32,
and sampling is linear unless told.
"""

from __future__ import annotations

from typing import Any

import gpu
import numpy as np

from ...scene.arrays import Float32Array

DEPTH = "DEPTH_COMPONENT32F"


def _buffer_of(array: np.ndarray) -> Any:
    """Zero-copy `gpu.types.Buffer` of a float array; keep the array alive while it is used."""
    flat = np.ascontiguousarray(array, np.float32).ravel()
    return gpu.types.Buffer("FLOAT", flat.size, flat)


_EXTENSIONS = {"REPEAT": "REPEAT", "EXTEND": "EXTEND", "MIRROR": "MIRRORED_REPEAT", "CLIP": "CLAMP_TO_BORDER"}


def largest_texture() -> int:
    """Pixels along a side."""
    return int(gpu.capabilities.max_texture_size_get())


def texture_2d(array: np.ndarray, fmt: str = "RGBA32F", linear: bool = False, extension: str = "EXTEND") -> Any:
    """Texture of a (height, width, channels) float array, row 0 at t = 0; `extension`: of `_EXTENSIONS`."""
    height, width = array.shape[:2]
    texture = gpu.types.GPUTexture((width, height), format=fmt, data=_buffer_of(array))
    texture.filter_mode(linear)
    texture.extend_mode(_EXTENSIONS[extension])
    return texture


def texture_layers(array: np.ndarray, fmt: str = "RGBA32F") -> Any:
    """Array texture of (layers, height, width, channels) floats, sampled linearly."""
    layers, height, width = array.shape[:3]
    return gpu.types.GPUTexture((width, height), layers=layers, format=fmt, data=_buffer_of(array))


def empty_texture(width: int, height: int, fmt: str = "RGBA32F", linear: bool = False) -> Any:
    """Unfilled, to be drawn or written to."""
    texture = gpu.types.GPUTexture((width, height), format=fmt)
    texture.filter_mode(linear)
    return texture


def empty_layers(width: int, height: int, layers: int, fmt: str) -> Any:
    """Array texture, unfilled."""
    texture = gpu.types.GPUTexture((width, height), layers=layers, format=fmt)
    texture.filter_mode(False)
    return texture


def depth_texture(width: int, height: int) -> Any:
    """Depths in 32 bits, unfilled."""
    return gpu.types.GPUTexture((width, height), format=DEPTH)


def depth_layers(resolution: int, layers: int) -> Any:
    """Array texture of square depth maps, unfilled."""
    return gpu.types.GPUTexture((resolution, resolution), layers=layers, format=DEPTH)


def read_texture(texture: Any, channels: int = 4) -> Float32Array:
    """(height, width, channels) float32 copy; waits for the GPU."""
    buffer = texture.read()
    buffer.dimensions = texture.width * texture.height * channels
    return np.array(buffer, np.float32).reshape(texture.height, texture.width, channels)
