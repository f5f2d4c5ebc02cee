# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells of a lattice of places whose corners are mapped to one piece of a surface. Pure numpy."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...optics.meshes.components import components
from ...scene.arrays import Float64Array

JUMP = 8.0
"""A step so many times as long as those beside it is none of one surface: something is before it in between"""

LEAST = 3
"""Places that are a part of a surface"""


@dataclass(frozen=True, slots=True)
class Cells:
    """Triangles, two for each cell, the largest first: what is drawn last is what the mirror shows largest."""

    corners: Float64Array
    """(t, 3, 2 or 3) where they are mapped to"""
    values: Float64Array
    """(t, 3, 2) their places"""
    first: NDArray[np.int64]
    """(t,) a place of the lattice, by its number, that is on their piece"""
    is_whole: NDArray[np.bool_]
    """(t,) all of their corners are"""

    def some(self, chosen: NDArray[np.bool_]) -> Cells:
        """These of them (t,)."""
        return Cells(self.corners[chosen], self.values[chosen], self.first[chosen], self.is_whole[chosen])

    @property
    def longest(self) -> Float64Array:
        """(t,) the longest of their sides."""
        sides = np.linalg.norm(self.corners - np.roll(self.corners, 1, axis=1), axis=2)
        return np.asarray(sides.max(axis=1), np.float64)

    def ordered(self) -> Cells:
        """The largest first."""
        edges = self.corners[:, 1:] - self.corners[:, :1]
        gram = np.einsum("nik,njk->nij", edges, edges)
        order = np.argsort(-(gram[:, 0, 0] * gram[:, 1, 1] - gram[:, 0, 1] ** 2), kind="stable")
        return Cells(self.corners[order], self.values[order], self.first[order], self.is_whole[order])


def joined(parts: Sequence[Cells]) -> Cells:
    """All of these, the largest first."""
    names = ("corners", "values", "first", "is_whole")
    return Cells(*(np.concatenate([getattr(part, name) for part in parts]) for name in names)).ordered()


def cells_of(mapped: Float64Array, piece: NDArray[np.int64], places: Float64Array) -> Cells:
    """Of a lattice (rows, columns): where it is `mapped` to (rows, columns, k), on which `piece` (rows, columns) of the
    surface, -1 for none, and its `places` (rows * columns, 2).

    A piece goes on past its last places by a cell, as it would if it went on straight: where it ends is not known to
    less.
    """
    rows, columns = piece.shape
    number = np.arange(rows * columns).reshape(rows, columns)
    corners, values = [np.empty((0, 3, mapped.shape[2]))], [np.empty((0, 3, 2))]
    first, whole = [np.empty(0, np.int64)], [np.empty(0, bool)]
    along, across = _continues(mapped, piece)
    for label, window in _windows(_parts(piece, along, across)):
        here: NDArray[np.bool_] = window.labels == np.int64(label)
        spread, filled = _spread(np.where(here[..., None], mapped[window.where], 0.0), here)
        good = filled[:-1, :-1] & filled[:-1, 1:] & filled[1:, :-1] & filled[1:, 1:]
        good &= here[:-1, :-1] | here[:-1, 1:] | here[1:, :-1] | here[1:, 1:]
        # (A part may go on around a gap.)
        steps = here[:, :-1] & here[:, 1:] & ~along[window.steps(1)]
        rises = here[:-1] & here[1:] & ~across[window.steps(0)]
        good &= ~(steps[:-1] | steps[1:] | rises[:, :-1] | rises[:, 1:])
        row, column = np.nonzero(good)
        own = number[window.where]
        around = [(0, 0), (0, 1), (1, 1), (1, 0)]
        quad = np.stack([spread[row + y, column + x] for y, x in around], axis=1)
        place = np.stack([places[own[row + y, column + x]] for y, x in around], axis=1)
        known = np.stack([here[row + y, column + x] for y, x in around], axis=1)
        some = np.where(known, np.stack([own[row + y, column + x] for y, x in around], axis=1), -1).max(axis=1)
        for chosen in ([0, 1, 2], [0, 2, 3]):
            corners.append(quad[:, chosen])
            values.append(place[:, chosen])
            first.append(some)
            whole.append(known[:, chosen].all(axis=1))
    return Cells(*(np.concatenate(item) for item in (corners, values, first, whole))).ordered()


@dataclass(frozen=True, slots=True)
class _Window:
    """Rows and columns that hold a part, and one more on each side as far as there are some."""

    where: tuple[slice, slice]
    labels: NDArray[np.int64]
    """Of the parts in it"""

    def steps(self, axis: int) -> tuple[slice, slice]:
        """Of an array of the steps along this axis."""
        row, column = self.where
        height, width = self.labels.shape
        ends = [(row.start, height), (column.start, width)]
        sizes = [slice(start, start + size - (k == axis)) for k, (start, size) in enumerate(ends)]
        return sizes[0], sizes[1]


def _windows(part: NDArray[np.int64]) -> Iterator[tuple[int, _Window]]:
    """Each part with its window."""
    row, column = np.nonzero(part >= 0)
    labels, which = np.unique(part[row, column], return_inverse=True)
    low, high = np.full((len(labels), 2), np.iinfo(np.int64).max), np.full((len(labels), 2), -1)
    for axis, value in enumerate((row, column)):
        np.minimum.at(low[:, axis], which, value)
        np.maximum.at(high[:, axis], which, value)
    for label, (top, left), (bottom, right) in zip(labels.tolist(), low.tolist(), high.tolist(), strict=True):
        where = slice(max(top - 1, 0), bottom + 2), slice(max(left - 1, 0), right + 2)
        yield label, _Window(where, part[where])


def _parts(piece: NDArray[np.int64], along: NDArray[np.bool_], across: NDArray[np.bool_]) -> NDArray[np.int64]:
    """(rows, columns) a number for what hangs together by steps that go on; -1 for none, and for the few places of
    rays that have slipped between two triangles of a mirror."""
    number = np.arange(piece.size).reshape(piece.shape)
    pairs = [
        np.column_stack([number[:, :-1][along], number[:, 1:][along]]),
        np.column_stack([number[:-1][across], number[1:][across]]),
    ]
    label = components(piece.size, np.concatenate(pairs))
    sizes = np.bincount(label, minlength=piece.size)
    return np.where((piece >= 0) & (sizes[label] >= LEAST).reshape(piece.shape), label.reshape(piece.shape), -1)


def _spread(mapped: Float64Array, here: NDArray[np.bool_]) -> tuple[Float64Array, NDArray[np.bool_]]:
    """The same with the places beside those that are `here` filled, on straight from two of these in a row."""
    rows, columns = here.shape
    known = np.pad(here, 2)
    value = np.pad(mapped, ((2, 2), (2, 2), (0, 0)))
    total, count = np.zeros_like(mapped), np.zeros(here.shape)
    for y in (-1, 0, 1):
        for x in (-1, 0, 1):
            if y == x == 0:
                continue
            near = slice(2 + y, 2 + y + rows), slice(2 + x, 2 + x + columns)
            next_one = slice(2 + 2 * y, 2 + 2 * y + rows), slice(2 + 2 * x, 2 + 2 * x + columns)
            both = known[near] & known[next_one] & ~here
            total += np.where(both[..., None], 2.0 * value[near] - value[next_one], 0.0)
            count += both
    result = np.where(here[..., None], mapped, total / np.maximum(count, 1.0)[..., None])
    return result, here | (count > 0.0)


def _continues(mapped: Float64Array, piece: NDArray[np.int64]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Whether steps along rows (rows, columns - 1) and along columns (rows - 1, columns) stay on one piece, and are
    not much longer than those around them."""
    found = []
    for axis in (1, 0):
        lines, labels = (np.moveaxis(item, axis, 0) for item in (mapped, piece))
        both = (labels[:-1] == labels[1:]) & (labels[1:] >= 0)
        with np.errstate(invalid="ignore"):
            length = np.where(both, np.linalg.norm(lines[1:] - lines[:-1], axis=-1), 0.0)
        padded = np.pad(length, ((2, 2), (0, 0)))
        # Of the two before and the two after the second longest: one of them may be the other step of a stray place.
        pairs = [(padded[:-4], padded[1:-3]), (padded[3:-1], padded[4:])]
        (low, high), (other_low, other_high) = ((np.minimum(*pair), np.maximum(*pair)) for pair in pairs)
        around = np.maximum(np.minimum(high, other_high), np.where(high > other_high, low, other_low))
        found.append(np.moveaxis(both & ~((around > 0.0) & (length > JUMP * around)), 0, axis))
    return found[0], found[1]
