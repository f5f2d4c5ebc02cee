# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One record texture for the records of many, which come and go: a new one leaves the others where they are."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...errors import InputError
from ...scene.arrays import Float32Array
from .context import gpu_cache, most_texels
from .records import TEXTURE_WIDTH, empty_record_texture, padded_count, record_texture
from .shaders import Image, Piece
from .ways.features import Features, features
from .ways.record_pass import RecordPass, build_record_pass

UNIT = 16
"""Regions begin at multiples of so many records: a float holds the quotient exactly"""
SPARE = 1.25
"""Room for more when the texture has to grow"""


class RecordRegions:
    """Regions of a record texture (see `record_texture`)."""

    def __init__(self) -> None:
        self.texture = empty_record_texture(1)
        self._capacity = TEXTURE_WIDTH
        self._free = [(0, TEXTURE_WIDTH)]
        """(first record, records), ascending, never touching"""

    def put(self, parts: list[Float32Array]) -> list[int]:
        """Store arrays (n, 4), each in a region of its own; returns their first records.

        Raises InputError where the graphics driver has no texture of that size.
        """
        sizes = [_rounded(len(part)) for part in parts]
        # (of whole rows, or they would be copied once more)
        joined = np.empty((padded_count(sum(sizes)), 4), np.float32)
        source = 0
        for part, size in zip(parts, sizes, strict=True):
            joined[source : source + len(part)] = part
            joined[source + len(part) : source + size] = 0.0
            source += size
        joined[source:] = 0.0
        starts = self.reserve(sizes)
        if sizes:
            staged = record_texture(joined)
            source = 0
            # What lies side by side is copied at once.
            first, length = starts[0], 0
            for start, size in [*zip(starts, sizes, strict=True), (-1, 0)]:
                if start != first + length:
                    _copy(staged, source, self.texture, first, length)
                    source += length
                    first, length = start, 0
                length += size
        return starts

    def reserve(self, sizes: list[int]) -> list[int]:
        """Regions for so many records each, unfilled; returns their first records. Raises as `put`."""
        sizes = [_rounded(size) for size in sizes]
        # (Once for all that find no room: a texture that grows is copied.)
        free = self._free.copy()
        lacking = sum(size for size in sizes if _take(free, size) is None)
        if lacking:
            self._grow(lacking)
        starts = []
        for size in sizes:
            start = _take(self._free, size)
            assert start is not None, "it has grown by what lacked room"
            starts.append(start)
        return starts

    def replace(self, start: int, records: Float32Array) -> None:
        """Store other records (n, 4), as many or fewer, in a region."""
        _copy(record_texture(records), 0, self.texture, start, len(records))

    def drop(self, start: int, count: int) -> None:
        """Free the region of `count` records that begins at `start`."""
        merged: list[tuple[int, int]] = []
        for begin, size in sorted([*self._free, (start, _rounded(count))]):
            if merged and sum(merged[-1]) == begin:
                merged[-1] = (merged[-1][0], merged[-1][1] + size)
            else:
                merged.append((begin, size))
        self._free = merged

    def put_again(self, region: tuple[int, int], records: Float32Array) -> tuple[int, int]:
        """Put records in the place of a `region`'s (first record, count; count 0: none yet), or where there is room for
        them; returns the region."""
        start, size = region
        if 0 < len(records) <= size:
            self.replace(start, records)
            return region
        if size:
            self.drop(start, size)
        return self.put([records])[0], len(records)

    def _grow(self, size: int) -> None:
        wanted = int((self._capacity + size) * SPARE)
        rows = -(-wanted // TEXTURE_WIDTH)
        most = most_texels()
        if rows > most:
            rows = -(-(self._capacity + size) // TEXTURE_WIDTH)
        if rows > most:
            raise InputError(
                f"The scene's triangles need {rows * TEXTURE_WIDTH >> 20} million records and this graphics driver "
                f"holds {most * TEXTURE_WIDTH >> 20} million: hide objects, or choose a method that solves vertices."
            )
        before, held = self.texture, self._capacity
        self.texture = empty_record_texture(rows * TEXTURE_WIDTH)
        self._capacity = rows * TEXTURE_WIDTH
        _copy(before, 0, self.texture, 0, held)
        self.drop(held, self._capacity - held)


def _take(free: list[tuple[int, int]], size: int) -> int | None:
    """The first record of so many that are free, which they are no more; None where there is no such room."""
    for index, (start, room) in enumerate(free):
        if room >= size:
            free[index : index + 1] = [(start + size, room - size)] if room > size else []
            return start
    return None


def _rounded(count: int) -> int:
    return -(-count // UNIT) * UNIT


def _copy(source: Any, first: int, target: Any, start: int, count: int) -> None:
    copying = _copy_pass(features())
    shader = copying.shader
    shader.bind()
    shader.uniform_int("range", (first, start, count, 0))
    shader.uniform_sampler("source", source)
    copying.run({"target": target}, count, start)


@gpu_cache
def _copy_pass(device: Features) -> RecordPass:
    return build_record_pass(
        "copy records",
        device,
        Piece(
            constants={"range": "IVEC4"},
            samplers={"source": "FLOAT_2D"},
            images={"target": Image()},
            compute="common/copy_records.comp.glsl",
        ),
    )
