# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of programs on the GPU: their pixels one after the other, row by row, in a few array textures.

An image begins at a new row of PAGE_WIDTH pixels and goes on as long as it is, whatever its own width is; so nothing is
lost to packing, and an image may be of any size. Bytes are kept as bytes, floats in half precision. Pixels are fetched
one by one (`gpu_shaders/programs/images.glsl`), as Cycles has its own ways of interpolating.
"""

from __future__ import annotations

import time
from collections.abc import Container, Sequence
from typing import Any

import numpy as np

from ...scene.arrays import ImageSource
from ...scene.names import listed
from ...scene.programs.program import IMAGE_RECORDS
from ..device.context import gpu_cache
from ..device.shaders import Piece, named
from ..device.textures import empty_layers
from .image_filling import Filling
from .image_rows import MOST_ARRAYS, PAGE_BITS, ImageArray, Place, bins, within

DEFAULT_CAP = 1 << 30
"""Bytes"""
_BYTES, _HALVES = "image_bytes_", "image_halves_"


_UNUSED = ImageSource("", 0, 0, True, False, True, (0.0, 1.0), lambda: np.zeros((0, 0, 4), np.uint8))


@gpu_cache
def nothing() -> Any:
    """Stands for an array that is not made yet."""
    return empty_layers(1, 1, 1, "RGBA8")


class ImagePages:
    """All images of a scene's programs. Those that stay the same objects stay where they are."""

    def __init__(self, cap: int = DEFAULT_CAP) -> None:
        """`cap`: bytes that images may take on the GPU; the largest are halved until they do."""
        self._cap = cap
        self._images: tuple[ImageSource, ...] = ()
        self._places: dict[ImageSource, Place] = {}
        self._arrays: list[ImageArray] = []
        self._pending: list[Place] = []
        self._work: Filling | None = None

    @property
    def bytes_used(self) -> int:
        """Of the GPU's memory."""
        return sum(array.bytes for array in self._arrays)

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each for what is not shown as it is."""
        places = self._places.values()
        halved = [place.source.name for place in places if place.halvings]
        lost = [place.source.name for place in places if place.is_missing and place.source.width]
        found = []
        if halved:
            found.append(
                f"The largest images ({listed(halved)}) are shown at half their size or less: together all would take "
                f"more than the {self._cap >> 20} MB that the preferences allow for images."
            )
        if lost:
            found.append(f"Images that can no longer be read are drawn magenta: {listed(lost)}.")
        return tuple(found)

    @property
    def is_complete(self) -> bool:
        """Nothing is left to `fill`."""
        return not self._pending

    @property
    def piece(self) -> Piece:
        """What `programs/images.glsl` needs. It differs with the number of array textures alone."""
        counts = [sum(array.is_bytes is is_bytes for array in self._arrays) for is_bytes in (True, False)]
        names = [f"{prefix}{k}" for prefix, count in zip((_BYTES, _HALVES), counts, strict=True) for k in range(count)]
        return Piece(
            samplers=named("FLOAT_2D_ARRAY", *names),
            defines={"IMAGE_BYTES": counts[0], "IMAGE_HALVES": counts[1], "PAGE_BITS": PAGE_BITS},
        )

    def bind(self, shader: Any) -> None:
        """Set the piece's samplers of a shader that is bound."""
        for array, name in zip(self._ordered(), self.piece.samplers, strict=True):
            shader.uniform_sampler(name, array.texture if array.is_made else nothing())

    def is_there(self, image: int) -> bool:
        """Whether the image at this index is shown: it has been filled in, or is missing for good."""
        place = self._places[self._images[image]]
        return place.is_missing or (place.array is not None and place.is_filled)

    def records(self, image: int) -> list[tuple[float, float, float, float]]:
        """The IMAGE_RECORDS of the image at this index, all fields of which are set here: how an image is used
        (extension, interpolation, projection) is part of a program's shape.

        (first row, width, height, number of the array); (bits of the rows in a layer, factor on values, 1 where they
        are encoded as sRGB, 0). Width 0: missing, magenta. Width -1: not there yet, gray.
        """
        place = self._places[self._images[image]]
        if place.is_missing or place.array is None or not place.is_filled:
            records = [(0.0, 0.0 if place.is_missing else -1.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)]
        else:
            number = self._ordered().index(place.array)
            records = [
                (float(place.first_row), float(place.width), float(place.height), float(number)),
                (float(place.array.bits), place.factor, float(place.source.is_srgb), 0.0),
            ]
        assert len(records) == IMAGE_RECORDS
        return records

    def follow(self, images: Sequence[ImageSource], used: Container[int] | None = None) -> bool:
        """These are to be there, in the order of their indices, or those of the indices `used` alone. What is new is
        there only after `fill`. Says whether `piece` changed: shaders with it are to be built anew."""
        if used is not None:
            images = [image if number in used else _UNUSED for number, image in enumerate(images)]
        if len(images) == len(self._images) and all(map(lambda a, b: a is b, images, self._images)):
            return False
        before = self.piece
        self._images = tuple(images)
        known, self._places = self._places, {}
        for place in within(dict.fromkeys(images), self._cap):
            old = known.get(place.source)
            is_kept = old is not None and old.halvings == place.halvings
            self._places[place.source] = old if old is not None and is_kept else place
        for old in known.values():
            if self._places.get(old.source) is not old:
                old.leave()
        for is_bytes in (True, False):
            self._place_all(is_bytes)
        self._arrays = [array for array in self._arrays if array.is_used]
        self._pending = [place for place in self._places.values() if not place.is_filled and not place.is_missing]
        if self._work is not None and self._work.place not in self._pending:
            self._work = None
        return self.piece != before

    def fill(self, budget: float | None = None) -> bool:
        """Read and copy what is not there yet, for about so many seconds (None: until all is there); says whether all
        is there now. An image is read in one go. `records` change as images get there."""
        start = time.perf_counter()
        while not self.is_complete:
            self._step()
            if budget is not None and time.perf_counter() - start > budget:
                break
        return self.is_complete

    def _ordered(self) -> list[ImageArray]:
        """In the order of the piece's samplers."""
        return sorted(self._arrays, key=lambda array: not array.is_bytes)

    def _place_all(self, is_bytes: bool) -> None:
        """Give rows to the images of one kind that have none: in arrays that are there, else in new ones; in new ones
        all of them, where there would be too many arrays."""
        arrays = [array for array in self._arrays if array.is_bytes is is_bytes]
        of_kind = [place for place in self._places.values() if place.source.is_bytes is is_bytes and place.rows]
        left = [place for place in of_kind if place.array is None and not any(map(place.enter, arrays))]
        sizes = bins(left, self._cap)
        if arrays and len(arrays) + len(sizes) > MOST_ARRAYS:
            for place in of_kind:
                place.leave()
            self._arrays = [array for array in self._arrays if array not in arrays]
            left, sizes = of_kind, bins(of_kind, self._cap)
        made = [ImageArray(rows, is_bytes) for rows in sizes]
        self._arrays += made
        for place in sorted(left, key=lambda place: -place.rows):
            # (As `bins` has counted.)
            if not any(map(place.enter, made)):
                raise AssertionError("an image has no place")

    def _step(self) -> None:
        """Read one image, or copy some rows of the one that was read, or make a texture for it."""
        place = self._pending[0]
        if place.array is not None and not place.array.is_made:
            _ = place.array.texture
        elif self._work is None:
            try:
                self._work = Filling(place)
            except OSError:
                place.is_missing = True
                self._pending.pop(0)
        elif self._work.copy_strip():
            self._work.place.is_filled = True
            self._pending.pop(0)
            self._work = None
