# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points for the sub-frames of a picture, spread evenly."""

from __future__ import annotations

import numpy as np

from ..arrays import Float64Array

type IntArray = np.ndarray[tuple[int, ...], np.dtype[np.int64]]

MOST_AT_ONCE = 32
"""Sub-frames of a picture that is looked at when it is done; of one with more any beginning is a picture too"""
_ORDERS = (20260, 52026)
"""Seeds of the orders in which lenses and shutters are gone through"""


def is_progressive(samples: int) -> bool:
    """Whether the first 2, 4, 8, ... of so many sub-frames are spread as evenly as all of them."""
    return samples > MOST_AT_ONCE


def hammersley(samples: int) -> Float64Array:
    """(samples, 2) low-discrepancy points in the unit square, in the middle of their strata."""
    index = np.arange(samples)
    bits = np.zeros(samples)
    scale, left = 0.5, index.copy()
    while left.any():
        bits += scale * (left & 1)
        left >>= 1
        scale *= 0.5
    return np.column_stack([(index + 0.5) / samples, bits + 0.5 / samples])


def scattered_points(samples: int) -> Float64Array:
    """(samples, 2) as evenly spread, in an order that has nothing to do with theirs: what is sampled beside pixels."""
    if is_progressive(samples):
        return progressive_points(samples, _ORDERS[0])
    return hammersley(samples)[np.random.default_rng(_ORDERS[0]).permutation(samples)]


def scattered_strata(samples: int) -> Float64Array:
    """(samples,) middles of equal parts of 0..1, in an order that has nothing to do with the other points'."""
    if is_progressive(samples):
        return progressive_points(samples, _ORDERS[1])[:, 0]
    return (np.random.default_rng(_ORDERS[1]).permutation(samples) + 0.5) / samples


def progressive_points(samples: int, seed: int) -> Float64Array:
    """(samples, 2) points of the unit square of which the first 2^k are a (0, k, 2)-net, for any k: each of 2^k equal
    boxes of any shape has one.

    Sobol's first two dimensions, scrambled as Owen does (1995) and gone through in an order that is scrambled alike
    (Burley, "Practical Hash-based Owen Scrambling", 2020, section 4): sets of other seeds are as good as independent.
    """
    bits = max(int(samples - 1).bit_length(), 1)
    chance = np.random.default_rng(seed)
    # (Runs of a power of two change places with their like.)
    index = _scrambled(np.arange(samples, dtype=np.int64), bits, chance)
    second = np.zeros(samples, np.int64)
    column = 1 << (bits - 1)
    for bit in range(bits):
        second ^= np.where(index >> bit & 1, column, 0)
        column ^= column >> 1
    found = [_scrambled(values, bits, chance) for values in (_reversed(index, bits), second)]
    return (np.column_stack(found) + 0.5) / (1 << bits)


def _reversed(values: IntArray, bits: int) -> IntArray:
    result = np.zeros_like(values)
    for bit in range(bits):
        result |= (values >> bit & 1) << (bits - 1 - bit)
    return result


def _scrambled(values: IntArray, bits: int, chance: np.random.Generator) -> IntArray:
    """Owen's scrambling: halves change places or not, in each of them its halves, and so on, each by chance."""
    result = np.zeros_like(values)
    for level in range(bits):
        place = bits - 1 - level
        flips = chance.integers(0, 2, 1 << level)
        result |= (values >> place & 1 ^ flips[values >> (place + 1)]) << place
    return result
