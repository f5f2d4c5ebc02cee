# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""PNG files that say how large they are printed. (Blender's own follow the render settings of a scene.)"""

from __future__ import annotations

import struct
import zlib

import numpy as np

from ...scene.arrays import Float32Array

INCH = 0.0254
"""Meters"""


def png_bytes(pixels: Float32Array, dots_per_inch: float | None = None) -> bytes:
    """A file of 8 bits and four channels: `pixels` (h, w, 4) on the curve of sRGB, alpha not multiplied in, row 0 at
    the bottom."""
    height, width = pixels.shape[:2]
    levels = np.rint(np.clip(pixels[::-1], 0.0, 1.0) * 255.0).astype(np.uint8)
    # (Filter 1, differences to the left, as most of an anamorphosis is plain.)
    rows = np.zeros((height, 1 + 4 * width), np.uint8)
    rows[:, 0] = 1
    rows[:, 1:5] = levels[:, 0]
    rows[:, 5:] = (levels[:, 1:] - levels[:, :-1]).reshape(height, -1)
    parts = [b"\x89PNG\r\n\x1a\n", _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))]
    parts.append(_chunk(b"sRGB", b"\0"))
    if dots_per_inch is not None:
        dots = round(dots_per_inch / INCH)
        parts.append(_chunk(b"pHYs", struct.pack(">IIB", dots, dots, 1)))
    parts += [_chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)), _chunk(b"IEND", b"")]
    return b"".join(parts)


def _chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(content, zlib.crc32(kind)))
