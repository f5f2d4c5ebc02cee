# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which rays off a closed mirror do not meet it again, by where they set out and which way they go. Pure numpy.

A mesh is put into cubic cells. Each cell gets a cone of directions: a ray that sets out from the mesh in the cell, in
one of these, meets no front face of the mesh. It cannot meet what another cell holds where that lies outside of the
cone, seen from all of the first cell, and it meets only backs where all normals there turn the ray's way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float32Array, Float64Array, MeshArrays

CELLS = 32
"""Cells along the longest side"""
OVERLAP = 0.01
"""Share of a cell by which it takes in its surroundings, as rounding may put a point into the next one"""
MARGIN = 2e-3
"""Radians that cones are narrower than what is found"""
MOST_OVERLAPS = 2_000_000
"""Pairs of triangles and cells: a mesh of more, which has many large triangles, gets no cones"""
NO_CONE = (0.0, 0.0, 0.0, 2.0)
WIDEST = np.radians(78.0)
"""Half angle of a cone"""
ROWS_AT_ONCE = 256
"""Cells in a step"""


@dataclass(frozen=True, slots=True)
class EscapeCones:
    """Of a mesh, object space."""

    low: Float64Array
    """(3,) where the cells begin"""
    size: float
    """Of a cell"""
    cones: Float32Array
    """(CELLS^3, 4), x fastest: unit axis and the least cosine to it; NO_CONE where there is none"""


class EscapeBuild:
    """Finds the cones of a mesh in steps, so that it can go on between the frames of a viewport."""

    def __init__(self, mesh: MeshArrays) -> None:
        """A closed mesh, counter-clockwise from outside. Does the first step."""
        corners = mesh.positions[mesh.corner_vertex[mesh.triangles]].astype(np.float64)
        low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        self._size = max(float((high - low).max()) / (CELLS * (1.0 - 2.0 * OVERLAP)), 1e-30)
        self._low = 0.5 * (low + high) - 0.5 * self._size * CELLS
        self._cones = np.tile(np.array(NO_CONE, np.float32), (CELLS**3, 1))
        self._parts = _parts_of((corners - self._low) / self._size)
        self._done = 0

    def step(self) -> bool:
        """Go on; False when there was nothing left to do."""
        parts = self._parts
        if parts is None or self._done >= len(parts.cells):
            return False
        rows = slice(self._done, self._done + ROWS_AT_ONCE)
        angles = parts.free_angles(rows) - MARGIN
        cells, axes = parts.cells[rows][angles > 0.0], parts.axes[rows][angles > 0.0]
        self._cones[cells, :3] = axes
        self._cones[cells, 3] = np.cos(angles[angles > 0.0])
        self._done += ROWS_AT_ONCE
        return True

    def finished(self) -> EscapeCones:
        """All steps that are left, and the cones."""
        while self.step():
            pass
        return EscapeCones(self._low, self._size, self._cones)


def _parts_of(corners: Float64Array) -> _Parts | None:
    """Of triangles (n, 3, 3) in lengths of a cell; None where they are too large to be told apart."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1)
    # (What has no area is met by no ray.)
    corners, normals, length = corners[length > 0.0], normals[length > 0.0], length[length > 0.0]
    found = _overlaps(corners)
    return None if found is None else _Parts(corners, normals / length[:, None], length, *found)


def _overlaps(corners: Float64Array) -> tuple[NDArray[np.int64], NDArray[np.int64]] | None:
    """Pairs (triangle, cell) in which the box of one and the other, with its surroundings, overlap."""
    first = np.clip(np.floor(corners.min(axis=1) - OVERLAP).astype(np.int64), 0, CELLS - 1)
    last = np.clip(np.floor(corners.max(axis=1) + OVERLAP).astype(np.int64), 0, CELLS - 1)
    spans = last - first + 1
    counts = spans.prod(axis=1)
    if len(corners) == 0 or counts.sum() > MOST_OVERLAPS:
        return None
    triangle = np.repeat(np.arange(len(corners)), counts)
    rank = np.arange(len(triangle)) - np.repeat(np.cumsum(counts) - counts, counts)
    across, up = spans[triangle, 0], spans[triangle, 1]
    x, y, z = rank % across, rank // across % up, rank // (across * up)
    place = first[triangle] + np.stack([x, y, z], axis=1)
    return triangle, place[:, 0] + CELLS * (place[:, 1] + CELLS * place[:, 2])


class _Parts:
    """Of a mesh, one for each cell that holds some of it; in lengths of a cell."""

    def __init__(
        self,
        corners: Float64Array,
        normals: Float64Array,
        weights: Float64Array,
        triangle: NDArray[np.int64],
        cell: NDArray[np.int64],
    ) -> None:
        order = np.argsort(cell, kind="stable")
        triangle, cell = triangle[order], cell[order]
        self.cells, starts = np.unique(cell, return_index=True)
        part = np.repeat(np.arange(len(self.cells)), np.diff(np.append(starts, len(cell))))
        corner = np.stack([self.cells % CELLS, self.cells // CELLS % CELLS, self.cells // CELLS**2], axis=1)
        low = np.minimum.reduceat(corners.min(axis=1)[triangle], starts)
        high = np.maximum.reduceat(corners.max(axis=1)[triangle], starts)
        low, high = np.maximum(low, corner - OVERLAP), np.minimum(high, corner + 1.0 + OVERLAP)
        self._centers, self._radii = 0.5 * (low + high), 0.5 * np.linalg.norm(high - low, axis=1)
        axes = np.add.reduceat(normals[triangle] * weights[triangle, None], starts)
        self.axes = axes / np.maximum(np.linalg.norm(axes, axis=1), 1e-30)[:, None]
        cosines = np.einsum("ij,ij->i", normals[triangle], self.axes[part])
        self._spreads = np.arccos(np.clip(np.minimum.reduceat(cosines, starts), -1.0, 1.0))

    def free_angles(self, rows: slice) -> Float64Array:
        """(rows,) half angle of the cone about an axis in which rays from the part meet no front face; WIDEST at most.

        All others are looked at for each: angles are found only of those that are not far behind it.
        """
        axes, centers, radii = self.axes[rows], self._centers[rows], self._radii[rows]
        squares = (self._centers**2).sum(axis=1)
        distances = squares[rows, None] + squares - 2.0 * centers @ self._centers.T
        distances = np.sqrt(np.maximum(distances, 1e-12))
        towards = axes @ self._centers.T - np.einsum("ij,ij->i", axes, centers)[:, None]
        reach = (radii[:, None] + self._radii) / distances
        row, column = np.nonzero((towards > 0.0) | (reach > np.cos(WIDEST)))
        reach, towards = reach[row, column], (towards / distances)[row, column]
        turned = np.einsum("ij,ij->i", axes[row], self.axes[column])
        by_facing = 0.5 * np.pi - np.arccos(np.clip(turned, -1.0, 1.0)) - self._spreads[column]
        by_place = np.arccos(np.clip(towards, -1.0, 1.0)) - np.arcsin(np.minimum(reach, 1.0))
        by_place[reach >= 1.0] = -np.pi
        # (Each part is among its own candidates: no row is empty.)
        starts = np.searchsorted(row, np.arange(len(axes)))
        return np.minimum(np.minimum.reduceat(np.maximum(by_facing, by_place), starts), WIDEST)
