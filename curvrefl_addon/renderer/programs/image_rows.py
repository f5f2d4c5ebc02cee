# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Array textures of images, and which rows of them images have."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ...scene.arrays import ImageSource
from ..device.textures import empty_layers

PAGE_BITS = 11
"""Known to shaders: of the width of all pages, and of their height where there are more rows"""
PAGE_WIDTH = 1 << PAGE_BITS
LARGEST_ARRAY = 1 << 30
"""Bytes: software renderers have no larger textures"""
_PIXEL_BYTES = {True: 4, False: 8}


def _most_rows(is_bytes: bool) -> int:
    return LARGEST_ARRAY // (PAGE_WIDTH * _PIXEL_BYTES[is_bytes])


class ImageArray:
    """One array texture, of bytes or of half floats."""

    def __init__(self, rows: int, is_bytes: bool) -> None:
        self.is_bytes = is_bytes
        self.bits = min((rows - 1).bit_length(), PAGE_BITS)
        """Of the rows in a layer"""
        layers = -(-rows >> self.bits)
        self.rows = layers << self.bits
        self.texture: Any = empty_layers(PAGE_WIDTH, 1 << self.bits, layers, "RGBA8" if is_bytes else "RGBA16F")
        self._taken: dict[int, int] = {}
        """First rows and how many, in order"""

    @property
    def bytes(self) -> int:
        """Of the GPU's memory."""
        return self.rows * PAGE_WIDTH * _PIXEL_BYTES[self.is_bytes]

    @property
    def is_used(self) -> bool:
        """Any image is in it."""
        return bool(self._taken)

    def take(self, rows: int) -> int | None:
        """The first of so many rows that were free; None where there are none."""
        start = 0
        for first, count in [*self._taken.items(), (self.rows, 0)]:
            if first - start >= rows:
                self._taken = dict(sorted([*self._taken.items(), (start, rows)]))
                return start
            start = first + count
        return None

    def give_back(self, first: int) -> None:
        """The rows that were taken from `first` on are free."""
        del self._taken[first]


class Place:
    """Where an image is, or is to be."""

    def __init__(self, source: ImageSource) -> None:
        self.source = source
        self.halvings = 0
        self.array: ImageArray | None = None
        self.first_row = 0
        self.factor = 1.0
        """On the values in the texture"""
        self.is_filled = False
        self.is_missing = source.width == 0

    @property
    def width(self) -> int:
        return _half(self.source.width, self.halvings)

    @property
    def height(self) -> int:
        return _half(self.source.height, self.halvings)

    @property
    def rows(self) -> int:
        """Of a page."""
        return -(-self.width * self.height // PAGE_WIDTH)

    @property
    def bytes(self) -> int:
        return self.rows * PAGE_WIDTH * _PIXEL_BYTES[self.source.is_bytes]

    def enter(self, array: ImageArray) -> bool:
        """Take rows of an array, if it has any."""
        row = array.take(self.rows)
        if row is None:
            return False
        self.array, self.first_row = array, row
        return True

    def leave(self) -> None:
        """Give them back."""
        if self.array is not None:
            self.array.give_back(self.first_row)
        self.array, self.is_filled = None, False


def within(images: Iterable[ImageSource], cap: int) -> list[Place]:
    """A place for each of these, the largest halved until all together have at most `cap` bytes."""
    places = [Place(source) for source in images]
    total = sum(place.bytes for place in places)
    while places:
        largest = max(places, key=lambda place: place.bytes)
        if (total <= cap and largest.bytes <= LARGEST_ARRAY) or largest.rows <= 1:
            break
        total -= largest.bytes
        largest.halvings += 1
        total += largest.bytes
    return places


def bins(places: Iterable[Place]) -> list[int]:
    """Rows of the arrays that these fit into, all of one kind, if the largest enter the first that will do first."""
    result: list[int] = []
    for place in sorted(places, key=lambda place: -place.rows):
        most = _most_rows(place.source.is_bytes)
        for number, rows in enumerate(result):
            if rows + place.rows <= most:
                result[number] += place.rows
                break
        else:
            result.append(place.rows)
    return result


def _half(side: int, halvings: int) -> int:
    return max(side >> halvings, min(side, 1))
