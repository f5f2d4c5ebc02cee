# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels out of files and out of Blender, as Cycles keeps them."""

from __future__ import annotations

from typing import Any

import bpy
import imbuf
import numpy as np
from numpy.typing import NDArray

from ..arrays import Float32Array

_BRIGHT_SCREENS = {"Rec.2100-PQ": 2.03, "Rec.2100-HLG": 2.03}
"""Color spaces and Blender's factor on them: white has 203 nits there, not 100"""

type Bytes = NDArray[np.uint8]

LARGEST_HALF = 65504.0
LEAST_HALF = 2.0**-14
"""With all of its digits"""


def decoded(file: str | bytes) -> Bytes | Float32Array:
    """(h, w, 1..4) of a file, by its path or all of its bytes, as they are in it. Raises OSError if there are none."""
    try:
        loaded = imbuf.load(file) if isinstance(file, str) else imbuf.load_from_buffer(file)
    except (OSError, ValueError) as error:
        raise OSError(str(error)) from None
    try:
        with loaded.with_buffer() as buffer:
            return np.array(buffer)
    finally:
        loaded.free()


def multiplied(pixels: Bytes) -> Bytes:
    """Colors of bytes times alpha, in place, rounded down as Cycles does."""
    # A few rows at a time, which stay in the cache.
    for start in range(0, len(pixels), 64):
        rows = pixels[start : start + 64]
        product = rows[..., :3].astype(np.uint16)
        product *= rows[..., 3:]
        product //= 255
        rows[..., :3] = product
    return pixels


def without_alpha(pixels: NDArray[Any]) -> NDArray[Any]:
    """Alpha of (h, w, 4) made 1, in place."""
    pixels[..., 3] = 255 if pixels.dtype == np.uint8 else 1.0
    return pixels


def blender_pixels(image: bpy.types.Image) -> Float32Array | None:
    """(h, w, 4) float32 as Blender has them now: of bytes a 255th each, of floats scene-linear; None: it has none."""
    was_loaded = image.has_data
    width, height = image.size
    # (A property that stubs know as a list of floats.)
    own: Any = image.pixels
    values = np.empty(width * height * image.channels, np.float32)
    if values.size == 0 or len(own) != values.size or not image.has_data:
        return None
    own.foreach_get(values)
    if not was_loaded and image.source in ("FILE", "SEQUENCE"):
        image.buffers_free()
    return four_channels(values.reshape(height, width, -1))


def raw_pixels(path: str) -> Float32Array | None:
    """(h, w, 4) float32 of a file as they are in it; None: there are none."""
    try:
        image: Any = bpy.data.images.load(path)
    except RuntimeError:
        return None
    try:
        image.colorspace_settings.name = "Non-Color"
        image.alpha_mode = "CHANNEL_PACKED"
        return blender_pixels(image)
    finally:
        bpy.data.images.remove(image)


def four_channels(pixels: NDArray[Any]) -> NDArray[Any]:
    """(h, w, 1..4) to (h, w, 4): gray is spread, alpha is 1."""
    height, width, channels = pixels.shape
    if channels == 4:
        return pixels
    result = np.empty((height, width, 4), pixels.dtype)
    result[..., :3] = pixels[..., :3] if channels == 3 else pixels[..., :1]
    if channels == 2:
        result[..., 3] = pixels[..., 1]
        return result
    return without_alpha(result)


def to_bytes(pixels: Float32Array) -> Bytes:
    """Blender's floats as the bytes that they are made of."""
    return np.rint(pixels * np.float32(255.0)).astype(np.uint8)


def scene_linear(colors: Float32Array, space: str) -> Float32Array:
    """Colors (h, w, 3) of one of Blender's color spaces, by its own configuration."""
    # (Blender converts the floats of files as it loads them: here of a file within the image itself.)
    height, width = colors.shape[:2]
    image: Any = bpy.data.images.new("curvrefl colors", width, height, float_buffer=True)
    try:
        image.colorspace_settings.name = "Non-Color"
        pixels = np.ones((height, width, 4), np.float32)
        pixels[..., :3] = colors
        image.pixels.foreach_set(pixels.ravel())
        image.pack()
        image.colorspace_settings.name = space
        result = blender_pixels(image)
    finally:
        bpy.data.images.remove(image)
    assert result is not None
    # (Blender, and not Cycles, scales what is made for bright screens.)
    return result[..., :3] * np.float32(_BRIGHT_SCREENS.get(space, 1.0))


def narrowed(pixels: Float32Array) -> NDArray[np.float16] | Float32Array:
    """In half precision, where that holds them."""
    return pixels.astype(np.float16) if np.abs(pixels).max(initial=0.0) <= LARGEST_HALF else pixels


def truncated(values: Float32Array) -> Float32Array:
    """What Cycles' own half floats keep of them: they are rounded towards 0."""
    bits = np.ascontiguousarray(values, np.float32).view(np.uint32) & np.uint32(0xFFFFE000)
    result = np.clip(bits.view(np.float32), -LARGEST_HALF, LARGEST_HALF)
    result[np.abs(result) < LEAST_HALF] = 0.0
    return result
