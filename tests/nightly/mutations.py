# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged copies of a file, each made from its number alone."""

from __future__ import annotations

import random
import struct

WILD_NUMBERS = (0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x10000, 0x00FFFFFF)


def mutated(content: bytes, number: int) -> bytes:
    """The content with the damage of that number: bits, bytes, numbers, pieces that are lost, doubled or moved."""
    chance = random.Random(number)
    data = bytearray(content)
    for _ in range(chance.choice((1, 1, 2, 4, 16, 64))):
        chance.choice(_DAMAGES)(data, chance)
    return bytes(data)


def _flip_bit(data: bytearray, chance: random.Random) -> None:
    data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)


def _set_byte(data: bytearray, chance: random.Random) -> None:
    data[chance.randrange(len(data))] = chance.randrange(256)


def _set_number(data: bytearray, chance: random.Random) -> None:
    """A count, a length or a pointer of the file's blocks, as like as not."""
    at = chance.randrange(0, len(data) - 4, 4)
    data[at : at + 4] = struct.pack("<I", chance.choice(WILD_NUMBERS))


def _scramble(data: bytearray, chance: random.Random) -> None:
    start, length = _piece(data, chance)
    data[start : start + length] = chance.randbytes(length)


def _copy(data: bytearray, chance: random.Random) -> None:
    start, length = _piece(data, chance)
    to = chance.randrange(len(data) - length)
    data[to : to + length] = data[start : start + length]


def _drop(data: bytearray, chance: random.Random) -> None:
    start, length = _piece(data, chance)
    del data[start : start + length]


def _double(data: bytearray, chance: random.Random) -> None:
    start, length = _piece(data, chance)
    data[start:start] = data[start : start + length]


def _break_off(data: bytearray, chance: random.Random) -> None:
    del data[chance.randrange(len(data) // 2, len(data)) :]


def _piece(data: bytearray, chance: random.Random) -> tuple[int, int]:
    """Start and length, which is mostly small and a multiple of 4."""
    length = min(4 * chance.choice((1, 2, 8, 64, 512)), len(data) // 4)
    return chance.randrange(len(data) - length), length


_DAMAGES = (_flip_bit, _set_byte, _set_number, _set_number, _set_number, _scramble, _copy, _drop, _double, _break_off)
