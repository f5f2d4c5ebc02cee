# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounding grids of meshes: few points that are solved, and where between them each vertex lies.

Estalella et al. 2005, section 5: an axis-aligned grid of near-cubic cells around each mesh, of which only cells that
hold a vertex are kept. Reflections are searched for the grid's corners and interpolated trilinearly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import LARGEST_COORDINATE, Float32Array, Float64Array, Int32Array

SEARCH_STEPS = 12
"""Halvings of the interval of cell sizes; the number of corners is a step function of the size"""
MOST_CELLS = 1 << 10
"""Along an axis"""
CORNERS = np.array([[k & 1, (k >> 1) & 1, k >> 2] for k in range(8)])
"""(8, 3) x first: which end of a cell each of its corners has"""


@dataclass(frozen=True, slots=True)
class BoundingGrid:
    """Grid of one mesh, object space."""

    corners: Float32Array
    """(corners, 3) of the cells that hold vertices"""
    cell_corners: Int32Array
    """(cells, 8) index into `corners`, in the order of CORNERS"""
    vertex_cell: Int32Array
    """(vertices,)"""
    local: Float32Array
    """(vertices, 3) coordinates (u, v, w) in the cell, 0..1"""


def bounding_grid(positions: Float32Array, share: float) -> BoundingGrid:
    """The grid of vertices (n, 3) whose number of corners comes nearest to `share` of n; at least one cell.

    Vertices that are not finite, or too far away to compute with, lie in the first cell.
    """
    points = np.asarray(positions, np.float64)
    finite = (np.abs(points) < LARGEST_COORDINATE).all(axis=1)
    points = np.where(finite[:, None], points, points[finite][0] if finite.any() else 0.0)
    low = points.min(axis=0)
    extent = points.max(axis=0) - low
    longest = float(extent.max())
    if longest == 0.0:
        return _grid(points, low, np.ones(3), np.ones(3, np.int64))
    wanted = share * len(points)
    best, least = np.ones(3, np.int64), np.inf
    coarse, fine = 0.0, float(np.log2(MOST_CELLS))
    for _ in range(SEARCH_STEPS):
        middle = 0.5 * (coarse + fine)
        counts = _cells_per_axis(extent, longest / 2.0**middle)
        number = _corner_count(points, low, extent, counts)
        if abs(number - wanted) < least:
            best, least = counts, abs(number - wanted)
        if number < wanted:
            coarse = middle
        else:
            fine = middle
    return _grid(points, low, extent, best)


def _cells_per_axis(extent: Float64Array, size: float) -> NDArray[np.int64]:
    """As close to cubes as whole numbers of cells allow."""
    return np.clip(np.rint(extent / size), 1, MOST_CELLS).astype(np.int64)


def _cells(points: Float64Array, low: Float64Array, extent: Float64Array, counts: NDArray[np.int64]) -> Float64Array:
    """(n, 3) positions in units of cells."""
    return (points - low) / np.where(extent > 0.0, extent, 1.0) * counts


def _corner_keys(cells: NDArray[np.int64], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """(cells, 8) one number per corner of cells (cells, 3)."""
    at = cells[:, None, :] + CORNERS
    return (at[..., 2] * (counts[1] + 1) + at[..., 1]) * (counts[0] + 1) + at[..., 0]


def _used_cells(where: Float64Array, counts: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Cells (k, 3) that hold points, and the cell of each point (n,)."""
    cell = np.clip(where.astype(np.int64), 0, counts - 1)
    key = (cell[:, 2] * counts[1] + cell[:, 1]) * counts[0] + cell[:, 0]
    used, index = np.unique(key, return_inverse=True)
    z, rest = np.divmod(used, counts[0] * counts[1])
    y, x = np.divmod(rest, counts[0])
    return np.column_stack([x, y, z]), index


def _corner_count(points: Float64Array, low: Float64Array, extent: Float64Array, counts: NDArray[np.int64]) -> int:
    used, _ = _used_cells(_cells(points, low, extent, counts), counts)
    return len(np.unique(_corner_keys(used, counts)))


def _grid(points: Float64Array, low: Float64Array, extent: Float64Array, counts: NDArray[np.int64]) -> BoundingGrid:
    where = _cells(points, low, extent, counts)
    used, vertex_cell = _used_cells(where, counts)
    keys, cell_corners = np.unique(_corner_keys(used, counts), return_inverse=True)
    z, rest = np.divmod(keys, (counts[0] + 1) * (counts[1] + 1))
    y, x = np.divmod(rest, counts[0] + 1)
    corners = low + np.column_stack([x, y, z]) * (extent / counts)
    return BoundingGrid(
        corners.astype(np.float32),
        cell_corners.reshape(-1, 8).astype(np.int32),
        vertex_cell.astype(np.int32),
        (where - used[vertex_cell]).astype(np.float32),
    )
