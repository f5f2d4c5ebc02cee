# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies the pixels of one image to its rows of an array texture, a strip at a time.

Blender takes floats alone for textures. Three bytes go over as one number below 2^24 and are taken apart on the GPU,
which is a quarter of the data and exact.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..device.batches import full_screen_triangle
from ..device.context import gpu_cache
from ..device.frame_buffers import frame_buffer, layer_of, wait_for
from ..device.shaders import FULL_SCREEN, Piece, build_shader
from ..device.state import drawing_state, set_viewport
from ..device.textures import texture_2d
from .image_rows import PAGE_WIDTH, Place

STRIP_ROWS = 256
_LARGEST_HALF = 65504.0


@gpu_cache
def _shader() -> Any:
    piece = Piece(
        samplers={"strip": "FLOAT_2D"},
        constants={"first_row": "INT", "is_packed": "INT", "is_opaque": "INT"},
        outputs={"color": "VEC4"},
        fragment="programs/fill_page.frag.glsl",
    )
    return build_shader("image page", FULL_SCREEN, piece)


class Filling:
    """An image that was read and is being copied."""

    def __init__(self, place: Place) -> None:
        """Reads it; raises OSError where it cannot be read."""
        self.place = place
        source = place.source
        pixels = source.read()
        if pixels.shape != (source.height, source.width, 4) or (pixels.dtype == np.uint8) != source.is_bytes:
            raise OSError(f"{source.name} has changed")
        self._pixels: NDArray[Any] = pixels
        self._halvings = place.halvings
        self._row = 0

    def copy_strip(self) -> bool:
        """Copy some rows, all in one layer, or make the image smaller first; says whether all is copied."""
        place = self.place
        assert place.array is not None
        if self._halvings:
            # (By itself: that takes about as long as to read it.)
            self._halvings -= 1
            self._pixels = _halved(self._pixels)
            return False
        if self._row == 0:
            self._make_ready()
        row = place.first_row + self._row
        layer, first = row >> place.array.bits, row & ((1 << place.array.bits) - 1)
        rows = min(STRIP_ROWS, (1 << place.array.bits) - first, place.rows - self._row)
        strip = self._strip(rows)
        target = frame_buffer(layer_of(place.array.texture, layer))
        with target.bind(), drawing_state():
            set_viewport(0, first, PAGE_WIDTH, rows)
            shader = _shader()
            shader.bind()
            shader.uniform_sampler("strip", strip)
            shader.uniform_int("first_row", first)
            shader.uniform_int("is_packed", place.source.is_bytes)
            shader.uniform_int("is_opaque", place.source.is_opaque)
            full_screen_triangle().draw(shader)
        self._row += rows
        is_last = self._row == place.rows
        if is_last:
            # (The time of all that was drawn counts.)
            wait_for(target)
        return is_last

    def _make_ready(self) -> None:
        """One pixel after the other, and the factor that floats need in half precision."""
        place = self.place
        place.factor = 1.0
        if not place.source.is_bytes:
            largest = float(np.abs(self._pixels).max(initial=0.0))
            if largest > _LARGEST_HALF:
                place.factor = 2.0 ** np.ceil(np.log2(largest / _LARGEST_HALF))
        self._pixels = np.ascontiguousarray(self._pixels).reshape(-1, 4)

    def _strip(self, rows: int) -> Any:
        """Texture of the next rows, the end of the last one blank."""
        start = self._row * PAGE_WIDTH
        pixels = self._pixels[start : start + rows * PAGE_WIDTH]
        missing = rows * PAGE_WIDTH - len(pixels)
        if missing:
            pixels = np.concatenate([pixels, np.zeros((missing, 4), pixels.dtype)])
        if not self.place.source.is_bytes:
            values = pixels.astype(np.float32) / np.float32(self.place.factor)
            return texture_2d(values.reshape(rows, PAGE_WIDTH, 4))
        numbers = pixels.view("<u4")[:, 0]
        colors = (numbers & 0xFFFFFF).astype(np.float32)
        if self.place.source.is_opaque:
            return texture_2d(colors.reshape(rows, PAGE_WIDTH, 1), "R32F")
        both = np.stack([colors, (numbers >> 24).astype(np.float32)], axis=-1)
        return texture_2d(both.reshape(rows, PAGE_WIDTH, 2), "RG32F")


def _halved(pixels: NDArray[Any]) -> NDArray[Any]:
    """(h, w, 4) at half the size, each pixel the mean of four; sides of an odd length lose their last."""
    height, width = pixels.shape[:2]
    tall, wide = max(height // 2, 1), max(width // 2, 1)
    rows, columns = slice(0, 2 * tall), slice(0, 2 * wide)
    part = pixels[rows, columns]
    result = np.empty((tall, wide, 4), pixels.dtype)
    # (Some rows at a time: the sums take more memory than the bytes.)
    for start in range(0, tall, 128):
        some: NDArray[Any] = part[2 * start : 2 * (start + 128)]
        some = some.astype(np.uint16 if pixels.dtype == np.uint8 else np.float32)
        if height > 1:
            some = np.add(some[0::2], some[1::2])
        if width > 1:
            some = np.add(some[:, 0::2], some[:, 1::2])
        count = (2 if height > 1 else 1) * (2 if width > 1 else 1)
        result[start : start + 128] = np.floor_divide(some, count) if pixels.dtype == np.uint8 else some / float(count)
    return result
