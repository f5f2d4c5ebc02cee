# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's images as scene-linear pixels."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ..arrays import Float32Array
from ..color_spaces import rec709_to_scene

MISSING_COLOR = (1.0, 0.0, 1.0, 1.0)
"""What Blender shows for an image that is not there"""
# Blender's names of the color spaces whose numbers are those of the scene (or are no colors at all).
_DATA = ("Non-Color", "Raw", "scene_linear")
_LINEAR = ("Non-Color", "Linear Rec.709", "Linear", "Raw", "scene_linear")


class ImageReader:
    """Reads each image once, and again after `forget`."""

    def __init__(self) -> None:
        self.reads = 0
        """How many images have been read"""
        self._pixels: dict[int, Float32Array] = {}
        self._warnings: dict[int, list[str]] = {}

    @property
    def warnings(self) -> list[str]:
        """One sentence for each image that is not drawn as it is."""
        return [warning for warnings in self._warnings.values() for warning in warnings]

    def read(self, image: bpy.types.Image) -> Float32Array:
        """(height, width, 4) scene-linear, row 0 at the bottom, colors not multiplied with alpha.

        Packed and generated images too. A missing file gives one magenta pixel and a warning.
        """
        key = image.original.session_uid
        if key not in self._pixels:
            self._warnings[key] = []
            self._pixels[key] = self._read(image, self._warnings[key])
            self.reads += 1
        return self._pixels[key]

    def forget_all(self) -> None:
        """Any may have changed."""
        self.forget(set(self._pixels))

    def forget(self, images: set[int]) -> None:
        """These images (session_uid) changed."""
        for key in images:
            self._pixels.pop(key, None)
            self._warnings.pop(key, None)

    def _read(self, image: bpy.types.Image, warnings: list[str]) -> Float32Array:
        if image.source in ("MOVIE", "SEQUENCE", "TILED"):
            what = "first tile" if image.source == "TILED" else "loaded frame"
            warnings.append(f'Of image "{image.name}" only the {what} is drawn.')
        width, height = image.size
        image_pixels: Any = image.pixels
        pixels = np.empty(width * height * image.channels, np.float32)
        if pixels.size and len(image_pixels) == pixels.size:
            image_pixels.foreach_get(pixels)
        if pixels.size == 0 or not image.has_data:
            warnings.append(f'Image "{image.name}" has no pixels: it is drawn magenta, as in Blender.')
            return np.array([[MISSING_COLOR]], np.float32)
        pixels = _four_channels(pixels.reshape(height, width, -1))
        # Blender makes float images linear as it loads them; bytes stay as they are in the file.
        space = image.colorspace_settings.name
        if not image.is_float and space not in _LINEAR:
            if space != "sRGB":
                warnings.append(f'Color space "{space}" of image "{image.name}" is taken for sRGB.')
            _decode_srgb(pixels)
        if not image.is_float and space not in _DATA:
            # Blender's own bytes hold linear Rec.709 then, whatever the file's working space.
            pixels = rec709_to_scene(pixels)
        return pixels


def srgb_to_linear(values: Float32Array) -> Float32Array:
    """IEC 61966-2-1, any shape."""
    return np.where(values <= 0.04045, values / 12.92, ((np.maximum(values, 0.0) + 0.055) / 1.055) ** 2.4).astype(
        np.float32
    )


def _decode_srgb(pixels: Float32Array) -> None:
    """Make the colors of a byte image (h, w, 4) linear, in place; a few rows at a time, which stay in the cache."""
    table = _srgb_table()
    for start in range(0, len(pixels), 16):
        rows = pixels[start : start + 16]
        alpha = rows[..., 3].copy()
        rows[...] = table.take((rows * np.float32(255.0) + np.float32(0.5)).astype(np.uint8))
        rows[..., 3] = alpha


def _srgb_table() -> Float32Array:
    """(256,) linear value of each byte."""
    return srgb_to_linear(np.arange(256, dtype=np.float32) / 255.0)


def _four_channels(pixels: Float32Array) -> Float32Array:
    """(h, w, 1..4) to (h, w, 4): gray is spread, alpha is 1."""
    height, width, channels = pixels.shape
    if channels == 4:
        return pixels
    result = np.ones((height, width, 4), np.float32)
    result[..., :3] = pixels[..., :3] if channels == 3 else pixels[..., :1]
    if channels == 2:
        result[..., 3] = pixels[..., 1]
    return result
