# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles' hash of whole numbers, by Bob Jenkins (util/hash.h). Pure numpy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..arrays import Float32Array


def hashed_to_unit(numbers: NDArray[np.uint32], words: int = 1) -> Float32Array:
    """0 to 1, of `numbers` (n,): hash_uint_to_float, or with 2 `words` hash_uint2_to_float(number, 0)."""

    def turned(value: NDArray[np.uint32], by: int) -> NDArray[np.uint32]:
        return value << np.uint32(by) | value >> np.uint32(32 - by)

    start = np.uint32((0xDEADBEEF + (words << 2) + 13) & 0xFFFFFFFF)
    a = numbers + start
    b, c = np.full_like(numbers, start), np.full_like(numbers, start)
    c = (c ^ b) - turned(b, 14)
    a = (a ^ c) - turned(c, 11)
    b = (b ^ a) - turned(a, 25)
    c = (c ^ b) - turned(b, 16)
    a = (a ^ c) - turned(c, 4)
    b = (b ^ a) - turned(a, 14)
    c = (c ^ b) - turned(b, 24)
    return (c.astype(np.float32) * np.float32(1.0 / 0xFFFFFFFF)).astype(np.float32)
