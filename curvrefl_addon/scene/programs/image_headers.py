# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the first bytes of an image's file say of it, so that its pixels need not be read for that."""

from __future__ import annotations

import struct
from dataclasses import dataclass

HEADER_BYTES = 1 << 16
"""Of the file are looked at"""
_PNG = b"\x89PNG\r\n\x1a\n"
_PNG_GRAY_ALPHA, _PNG_COLOR_ALPHA = 4, 6
_JPEG_SIZES = (*range(0xC0, 0xC4), *range(0xC5, 0xC8), *range(0xC9, 0xCC), *range(0xCD, 0xD0))
"""Markers of segments that begin with the size"""


@dataclass(frozen=True, slots=True)
class Header:
    """Of a file with 8 bits a channel."""

    width: int
    height: int
    is_opaque: bool
    is_gray_alpha: bool = False
    """Two channels: Cycles leaves their gray as it is, where it multiplies colors with alpha"""


def header_of(data: bytes) -> Header | None:
    """By the first HEADER_BYTES of a file; None where they do not tell, or there are more than 8 bits a channel."""
    if data.startswith(_PNG):
        return _png(data)
    if data.startswith(b"\xff\xd8"):
        return _jpeg(data)
    return None


def _png(data: bytes) -> Header | None:
    if len(data) < 26 or data[12:16] != b"IHDR":
        return None
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    start = 8
    while data[start + 4 : start + 8] not in (b"IDAT", b"tRNS", b""):
        start += 12 + int.from_bytes(data[start : start + 4], "big")
    has_alpha = kind in (_PNG_GRAY_ALPHA, _PNG_COLOR_ALPHA) or data[start + 4 : start + 8] != b"IDAT"
    return None if depth > 8 else Header(width, height, not has_alpha, kind == _PNG_GRAY_ALPHA)


def _jpeg(data: bytes) -> Header | None:
    start = 2
    while start + 10 <= len(data) and data[start] == 0xFF:
        marker = data[start + 1]
        if marker == 0xFF:
            start += 1
            continue
        if marker in _JPEG_SIZES:
            depth, height, width = struct.unpack(">BHH", data[start + 4 : start + 9])
            # (Four channels are inks, which files keep in more than one way.)
            return Header(width, height, True) if depth == 8 and data[start + 9] in (1, 3) else None
        start += 2 + int.from_bytes(data[start + 2 : start + 4], "big")
    return None
