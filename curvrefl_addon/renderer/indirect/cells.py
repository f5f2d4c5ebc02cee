# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells of space about a place of interest, nested cubes of cubes: those of each level are twice as large as of the
one inside of it. Pure numpy.

A surface's cell is told by where it is and by which axis it faces most: light on the two sides of a wall, or on the
floor and the wall above it, never shares a cell.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float64Array
from ..cells.lookup import SIDE

SIDES = 6
"""Directions: +x -x +y -y +z -z"""
MOST_LEVELS = 10
CELLS_OF_LEVEL = SIDES * SIDE**3
type Int64Array = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class CellGrid:
    """World space, meters."""

    focus: tuple[float, float, float]
    """Middle of all levels"""
    half: float
    """Of the side of level 0"""
    levels: int

    @property
    def count(self) -> int:
        """Entries of a table that has all cells"""
        return self.levels * CELLS_OF_LEVEL

    def levels_at(self, positions: Float64Array) -> Int64Array:
        """(n,) of places (n, 3); `levels` where a place is outside of all."""
        away = np.abs(positions - np.array(self.focus)).max(axis=1)
        return levels_of(away, self.half, self.levels)

    def sizes(self, levels: Int64Array) -> Float64Array:
        """Sides of the cells of levels (n,)"""
        return 2.0 * self.half / SIDE * np.exp2(levels)

    def numbers(self, positions: Float64Array, normals: Float64Array) -> Int64Array:
        """(n,) entries of places (n, 3) on surfaces with normals (n, 3); -1 outside."""
        level = self.levels_at(positions)
        inside = level < self.levels
        size = self.sizes(level)
        at = np.floor((positions - np.array(self.focus)) / size[:, None] + 0.5 * SIDE).astype(np.int64)
        at = np.clip(at, 0, SIDE - 1)
        axis = np.abs(normals).argmax(axis=1)
        side = 2 * axis + (np.take_along_axis(normals, axis[:, None], axis=1)[:, 0] < 0.0)
        number = (((level * SIDES + side) * SIDE + at[:, 2]) * SIDE + at[:, 1]) * SIDE + at[:, 0]
        return np.where(inside, number, -1)


def levels_of(away: Float64Array, half: float, levels: int) -> Int64Array:
    """(n,) levels at these largest coordinates (n,) from the focus."""
    ratio = np.maximum(away / half, 1e-30)
    return np.clip(np.ceil(np.log2(ratio) - 1e-9), 0, levels).astype(np.int64)


def spread_to_neighbors(table: NDArray[np.int32], levels: int, rounds: int = 2) -> NDArray[np.int32]:
    """A table of cells' numbers (levels * CELLS_OF_LEVEL,), -1 where there is none: each empty one takes the number of
    one beside it, the same side; then one in the same place takes that of another side."""
    grid = table.reshape(levels, SIDES, SIDE, SIDE, SIDE).copy()
    for _ in range(rounds):
        before = grid.copy()
        for axis in (2, 3, 4):
            for step in (1, -1):
                target, source = [slice(None)] * 5, [slice(None)] * 5
                target[axis] = slice(1, None) if step > 0 else slice(None, -1)
                source[axis] = slice(None, -1) if step > 0 else slice(1, None)
                there, here = before[tuple(source)], grid[tuple(target)]
                np.copyto(here, there, where=(here < 0) & (there >= 0))
    before = grid.copy()
    for side in range(SIDES):
        # (The opposite side comes last.)
        others = [other for other in range(SIDES) if other // 2 != side // 2]
        for other in (*others, side ^ 1):
            here = grid[:, side]
            np.copyto(here, before[:, other], where=(here < 0) & (before[:, other] >= 0))
    return grid.reshape(-1)
