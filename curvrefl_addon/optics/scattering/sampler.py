# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers of paths: four for each vertex, fixed for pixel, sub-frame and bounce.

The sub-frames of a pixel are points of a four-dimensional Sobol sequence (Joe and Kuo, "Constructing Sobol Sequences
with Better Two-Dimensional Projections", 2008), each axis scrambled as Owen by a hash of pixel and bounce (Burley,
"Practical Hash-based Owen Scrambling", JCGT 9(4), 2020; the hash is Vegdahl's). Scrambling leaves the sequence's
strata: of the first 2^k sub-frames each has one number in each of 2^k equal intervals of an axis, whatever the pixel.
Bounces take the points in another order, which keeps aligned blocks of 2^k together, so that pairs of bounces are
spread well and never alike.

Points have 16 bits, so that a vertex's fit into a push constant and no shader computes a sequence; after 65,536
sub-frames other scrambles begin.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["path_point", "path_random"]

type Float64Array = NDArray[np.float64]
type UInt32Array = NDArray[np.uint32]

_BITS = 16
_FULL = 0xFFFFFFFF


def _directions(primitive: int, degree: int, first: tuple[int, ...]) -> list[int]:
    """Direction numbers of `_BITS` bits of the axis whose polynomial's inner coefficients are `primitive`."""
    m = list(first)
    for index in range(degree, _BITS):
        value = m[index - degree] ^ (m[index - degree] << degree)
        for k in range(1, degree):
            if primitive >> (degree - 1 - k) & 1:
                value ^= m[index - k] << k
        m.append(value)
    return [value << (_BITS - 1 - index) for index, value in enumerate(m[:_BITS])]


_AXES = (
    [1 << (_BITS - 1 - index) for index in range(_BITS)],
    _directions(0, 1, (1,)),
    _directions(1, 2, (1, 3)),
    _directions(1, 3, (1, 3, 1)),
)


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


def path_point(sub_frame: int, bounce: int) -> tuple[int, int, int, int]:
    """The push constant `path_point` of `random.glsl` for the vertices after `bounce` others, in one sub-frame.

    Four axes of 16 bits in reverse order in the first two numbers, the seed of the scrambles, and the sub-frame; all
    as signed 32-bit integers.
    """
    seed = _hashed(_hashed(bounce + 1) ^ (sub_frame >> _BITS))
    # The order of a bounce's points: blocks of 2^k that begin at multiples of it stay together.
    index = sub_frame & (1 << _BITS) - 1
    if bounce > 0:
        index = _turned(_scrambled(_turned(index), _hashed(seed)) & (1 << _BITS) - 1)
    point = [0] * 4
    for axis, directions in enumerate(_AXES):
        for bit in range(_BITS):
            if index >> bit & 1:
                point[axis] ^= directions[bit]
    a, b, c, d = (_turned(value) for value in point)
    return tuple(_signed(value) for value in (a | b << 16, c | d << 16, seed, sub_frame & _FULL))  # type: ignore[return-value]


def _turned(value: int) -> int:
    """`_BITS` bits in reverse order."""
    return int(f"{value:0{_BITS}b}"[::-1], 2)


def _signed(value: int) -> int:
    return value - (1 << 32) if value >> 31 else value


def path_random(pixels: NDArray[np.integer], sub_frame: int, bounce: int) -> Float64Array:
    """(n, 4) numbers in 0..1, 1 excluded, of (n, 2) pixels: what `path_random` of `random.glsl` answers."""
    first, second, seed, _ = (np.uint32(value & _FULL) for value in path_point(sub_frame, bounce))
    x, y = (np.asarray(pixels)[:, axis].astype(np.uint32) for axis in (0, 1))
    with np.errstate(over="ignore"):
        seeds = _hash_array(seed ^ _hash_array(x ^ _hash_array(y)))
        point = (first & np.uint32(0xFFFF), first >> np.uint32(16), second & np.uint32(0xFFFF), second >> np.uint32(16))
        columns = [
            _reversed(_scramble_array(np.full_like(x, bits), _hash_array(seeds + np.uint32(axis))))
            for axis, bits in enumerate(point)
        ]
    return np.stack([(column >> np.uint32(8)) * 2.0**-24 for column in columns], axis=1)


def _hash_array(x: UInt32Array) -> UInt32Array:
    x = x ^ x >> np.uint32(16)
    x = x * np.uint32(0x7FEB352D)
    x = x ^ x >> np.uint32(15)
    x = x * np.uint32(0x846CA68B)
    return x ^ x >> np.uint32(16)


def _scramble_array(x: UInt32Array, seed: UInt32Array) -> UInt32Array:
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
