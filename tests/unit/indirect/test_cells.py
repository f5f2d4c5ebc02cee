# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells of space hold the places that they say, and a table of them is spread as a search by hand would."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.cells.lookup import SIDE
from curvrefl.curvrefl_addon.renderer.indirect.cells import (
    CELLS_OF_LEVEL,
    SIDES,
    CellGrid,
    levels_of,
    spread_to_neighbors,
)
from hypothesis import given, settings
from hypothesis import strategies as st

AXES = np.concatenate([np.eye(3), -np.eye(3)])[[0, 3, 1, 4, 2, 5]]
"""+x -x +y -y +z -z"""
scales = st.floats(-4.0, 4.0).map(lambda power: 10.0**power)


def unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def around(grid: CellGrid, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Places at all distances from the focus, some outside of all levels, and normals."""
    random = np.random.default_rng(seed)
    reach = grid.half * 2.0 ** random.uniform(-6.0, grid.levels, (count, 1))
    return grid.focus + reach * random.uniform(-1.0, 1.0, (count, 3)), unit(random.normal(size=(count, 3)))


def parts(number: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Level, side and (n, 3) cell of entries of a table."""
    level, rest = np.divmod(number, CELLS_OF_LEVEL)
    side, rest = np.divmod(rest, SIDE**3)
    return level, side, np.stack([rest % SIDE, rest // SIDE % SIDE, rest // SIDE**2], axis=1)


@given(half=scales, levels=st.integers(1, 10), seed=st.integers(0, 10_000), far=st.floats(-10.0, 10.0))
@settings(max_examples=50)
def test_cells_hold_the_places_that_they_are_given_for(half: float, levels: int, seed: int, far: float) -> None:
    grid = CellGrid((far * half, -far * half, 0.5 * half), half, levels)
    positions, normals = around(grid, 300, seed)
    numbers = grid.numbers(positions, normals)
    away = np.abs(positions - np.array(grid.focus)).max(axis=1)
    # (A place on the border is of either.)
    clear = np.abs(away / (half * 2.0 ** (levels - 1)) - 1.0) > 1e-6
    assert np.array_equal(numbers[clear] >= 0, (away <= half * 2.0 ** (levels - 1))[clear])
    assert numbers.max() < grid.count
    inside = numbers >= 0
    level, side, cell = parts(numbers[inside])
    size = grid.sizes(level)[:, None]
    low = np.array(grid.focus) + (cell - 0.5 * SIDE) * size
    slack = 1e-6 * size
    assert (positions[inside] >= low - slack).all()
    assert (positions[inside] <= low + size + slack).all()
    facing = (AXES[:, None] * normals[inside][None]).sum(axis=2)
    assert np.array_equal(side, facing.argmax(axis=0))


@given(half=scales, levels=st.integers(1, 10), seed=st.integers(0, 10_000))
@settings(max_examples=30)
def test_each_place_has_the_smallest_cells_around_it(half: float, levels: int, seed: int) -> None:
    grid = CellGrid((0.0, 0.0, 0.0), half, levels)
    positions, _ = around(grid, 200, seed)
    level = grid.levels_at(positions)
    away = np.abs(positions).max(axis=1)
    reach = half * 2.0 ** level.astype(float)
    inside = level < levels
    assert (away[inside] <= reach[inside] * (1.0 + 1e-6)).all()
    # The cube inside of it is too small for it.
    outer = inside & (level > 0)
    assert (away[outer] > 0.5 * reach[outer] * (1.0 - 1e-6)).all()


def test_sides_of_cells_double() -> None:
    grid = CellGrid((1.0, 2.0, 3.0), 8.0, 4)
    assert grid.sizes(np.arange(4)).tolist() == [16.0 / SIDE, 32.0 / SIDE, 64.0 / SIDE, 128.0 / SIDE]
    assert grid.count == 4 * CELLS_OF_LEVEL


def test_the_focus_and_the_borders_have_a_level() -> None:
    away = np.array([0.0, 1.0, 1.0000001, 2.0, 4.0, 8.0, 9.0, 1e30, np.finfo(float).max])
    assert levels_of(away, 1.0, 3).tolist() == [0, 0, 1, 1, 2, 3, 3, 3, 3]


@pytest.mark.parametrize("axis", range(3))
def test_two_sides_of_a_wall_share_no_cell(axis: int) -> None:
    """Nor a floor and the wall that stands on it."""
    grid = CellGrid((0.0, 0.0, 0.0), 1.0, 2)
    normals = np.concatenate([np.eye(3), -np.eye(3)])
    numbers = grid.numbers(np.full((6, 3), 0.3), np.roll(normals, axis, axis=1))
    assert len(set(numbers.tolist())) == SIDES


def by_hand(table: np.ndarray, level: int, side: int, cell: tuple[int, int, int]) -> set[int]:
    """Numbers that an empty cell may take: of those nearest along axes, of the same side; else of another side in the
    same place."""
    grid = table.reshape(-1, SIDES, SIDE, SIDE, SIDE)
    z, y, x = cell
    if grid[level, side, z, y, x] >= 0:
        return {int(grid[level, side, z, y, x])}
    steps = np.abs(np.stack(np.meshgrid(*[np.arange(SIDE)] * 3, indexing="ij"), axis=-1) - cell).sum(axis=-1)
    for reach in (1, 2):
        found = {int(number) for number in grid[level, side][steps == reach] if number >= 0}
        if found:
            return found
    return set()


@given(seed=st.integers(0, 10_000), share=st.sampled_from([0.0, 1e-4, 1e-3, 0.02]))
@settings(max_examples=8)
def test_empty_cells_take_what_is_nearest(seed: int, share: float) -> None:
    random = np.random.default_rng(seed)
    levels = 2
    table = np.full(levels * CELLS_OF_LEVEL, -1, np.int32)
    taken = np.flatnonzero(random.uniform(size=len(table)) < share)
    table[taken] = np.arange(len(taken))
    before = table.copy()
    spread = spread_to_neighbors(table, levels)
    assert np.array_equal(table, before)
    assert np.array_equal(spread[taken], table[taken])
    grid = spread.reshape(levels, SIDES, SIDE, SIDE, SIDE)
    # Where there is something, and about it; and anywhere.
    about = taken[:10]
    asked = np.concatenate([random.integers(0, len(table), 20), about, (about + 1) % len(table)])
    for number in asked:
        (level,), (side,), cells = parts(np.array([number]))
        cell = (int(cells[0, 2]), int(cells[0, 1]), int(cells[0, 0]))
        found = int(grid[level, side][cell])
        own = by_hand(before, level, side, cell)
        if own:
            assert found in own
            continue
        others = [by_hand(before, level, other, cell) for other in range(SIDES) if other != side]
        opposite = side ^ 1
        beside = set().union(*(by_hand(before, level, k, cell) for k in range(SIDES) if k not in (side, opposite)))
        if beside:
            # The other side of a wall comes last.
            assert found in beside
        elif set().union(*others):
            assert found in by_hand(before, level, opposite, cell)
        else:
            assert found == -1
