# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers of paths: four for each vertex, fixed for pixel, sub-frame and bounce.

All pixels of a picture share one four-dimensional Sobol sequence (Joe and Kuo, "Constructing Sobol Sequences with
Better Two-Dimensional Projections", 2008), its axes scrambled as Owen by hashes (Burley, "Practical Hash-based Owen
Scrambling", JCGT 9(4), 2020; the hash is Vegdahl's). A pixel has a block of 2^k of its points, where 2^k sub-frames are
asked for, and pixels have their blocks in Morton's order, itself scrambled (Ahmed and Wonka, "Screen-Space Blue-Noise
Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels", ACM TOG 39(6), 2020): a pixel's numbers
are stratified, the numbers of a quad of pixels together are, and those of its quad of quads, so that what error remains
is spread as noise of high frequency, which the eye averages.

Sobol points are linear in the bits of their number: the point of (block ^ sub-frame) is that of the block, which the
shader computes, ^ that of the sub-frame, which comes as a push constant. A bounce takes sub-frames in an order of its
own, a scramble that keeps aligned blocks of 2^j together, for else the numbers of two bounces would go hand in hand.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["path_point", "path_random"]

type Float64Array = NDArray[np.float64]
type UInt32Array = NDArray[np.uint32]

_BITS = 16
"""Of sub-frames; after 65,536 other scrambles begin"""
_PIXEL_BITS = 12
"""Of a pixel's coordinates"""
_MOST = 256
"""Sub-frames where no number is asked for"""
_FULL = 0xFFFFFFFF


def _directions() -> tuple[list[int], list[int], list[int], list[int]]:
    """Of each axis the points of the numbers 1, 2, 4, ..., from the highest bit down.

    The recurrences of Sobol's polynomials of degree 0 to 3.
    """
    a = [1 << 31 - index for index in range(32)]
    b, c, d = a[:1], [a[0], 3 << 30], [a[0], 3 << 30, 1 << 29]
    for _ in range(31):
        b.append(b[-1] ^ b[-1] >> 1)
        c.append(c[-1] ^ c[-2] ^ c[-2] >> 2)
        d.append(d[-2] ^ d[-3] ^ d[-3] >> 3)
    return a, b, c, d


_AXES = _directions()


def _hashed(x: int) -> int:
    x ^= x >> 16
    x = x * 0x7FEB352D & _FULL
    x ^= x >> 15
    x = x * 0x846CA68B & _FULL
    return x ^ x >> 16


def _scrambled(reversed_bits: int, seed: int) -> int:
    x = reversed_bits
    x ^= x * 0x3D20ADEA & _FULL
    x = x + seed & _FULL
    x = x * (seed >> 16 | 1) & _FULL
    x ^= x * 0x05526C56 & _FULL
    return x ^ x * 0x53A22864 & _FULL


def path_point(sub_frame: int, bounce: int, sub_frames: int = _MOST) -> tuple[int, int, int, int]:
    """The push constant `path_point` of `random.glsl` for the vertices after `bounce` others, in one sub-frame.

    `sub_frames`: how many the picture will have, where that is known; the error is spread best when they are complete.
    Answers the point of the sub-frame, four axes of 16 bits in two numbers; the seed of the bounce; and the logarithm
    of a pixel's block. All as signed 32-bit integers.
    """
    seed = _hashed(_hashed(bounce + 1) ^ (sub_frame >> _BITS))
    index = _turned(_scrambled(_turned(sub_frame), _hashed(seed)) & (1 << _BITS) - 1)
    point = [0] * 4
    for axis, directions in enumerate(_AXES):
        for bit in range(_BITS):
            if index >> bit & 1:
                point[axis] ^= directions[bit] >> _BITS
    a, b, c, d = point
    block = min(max(sub_frames - 1, 0).bit_length(), _BITS)
    return _signed(a | b << 16), _signed(c | d << 16), _signed(seed), block


def _turned(value: int) -> int:
    """The lowest `_BITS` bits in reverse order."""
    return int(f"{value & (1 << _BITS) - 1:0{_BITS}b}"[::-1], 2)


def _signed(value: int) -> int:
    return value - (1 << 32) if value >> 31 else value


def path_random(pixels: NDArray[np.integer], sub_frame: int, bounce: int, sub_frames: int = _MOST) -> Float64Array:
    """(n, 4) numbers in 0..1, 1 excluded, of (n, 2) pixels: what `path_random` of `random.glsl` answers."""
    first, second, seed, _ = (np.uint32(value & _FULL) for value in path_point(sub_frame, bounce, sub_frames))
    bits = np.uint32(path_point(sub_frame, bounce, sub_frames)[3])
    x, y = (np.asarray(pixels)[:, axis].astype(np.uint32) for axis in (0, 1))
    sixteen, low = np.uint32(16), np.uint32(0xFFFF)
    with np.errstate(over="ignore"):
        place = _reversed(_scramble_array(_reversed(_morton(x, y)), seed)) >> np.uint32(32 - 2 * _PIXEL_BITS)
        within = hash_array(seed ^ hash_array(x ^ hash_array(y))) & (np.uint32(1) << bits) - np.uint32(1)
        number = place << bits | within
        columns = []
        for axis, point in enumerate((first & low, first >> sixteen, second & low, second >> sixteen)):
            value = np.full_like(x, point << sixteen)
            for bit, direction in enumerate(_AXES[axis]):
                value = value ^ np.where(number >> np.uint32(bit) & np.uint32(1), np.uint32(direction), np.uint32(0))
            axis_seed = hash_array(np.array([seed + np.uint32(axis + 1)], np.uint32))
            columns.append(_reversed(_scramble_array(_reversed(value), axis_seed)))
    return np.stack([(column >> np.uint32(8)) * 2.0**-24 for column in columns], axis=1)


def _morton(x: UInt32Array, y: UInt32Array) -> UInt32Array:
    """Bits of both in turns, in the upper bits of the answer."""
    code = np.zeros_like(x)
    for bit in range(_PIXEL_BITS):
        one, place = np.uint32(1), np.uint32(bit)
        pair = (x >> place & one) | (y >> place & one) << one
        code = code | pair << np.uint32(2 * bit + 32 - 2 * _PIXEL_BITS)
    return code


def hash_array(x: UInt32Array) -> UInt32Array:
    x = x ^ x >> np.uint32(16)
    x = x * np.uint32(0x7FEB352D)
    x = x ^ x >> np.uint32(15)
    x = x * np.uint32(0x846CA68B)
    return x ^ x >> np.uint32(16)


def _scramble_array(x: UInt32Array, seed: UInt32Array | np.uint32) -> UInt32Array:
    x = x ^ x * np.uint32(0x3D20ADEA)
    x = x + seed
    x = x * (seed >> np.uint32(16) | np.uint32(1))
    x = x ^ x * np.uint32(0x05526C56)
    return x ^ x * np.uint32(0x53A22864)


def _reversed(x: UInt32Array) -> UInt32Array:
    for mask, shift in ((0x55555555, 1), (0x33333333, 2), (0x0F0F0F0F, 4), (0x00FF00FF, 8), (0x0000FFFF, 16)):
        m, s = np.uint32(mask), np.uint32(shift)
        x = (x >> s & m) | (x & m) << s
    return x
