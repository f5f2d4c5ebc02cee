# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points spread over the scene's surfaces, a few for each cell: where light that arrives is found. Pure numpy."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float32Array, Float64Array, InstanceArrays, MeshArrays
from .cells import MOST_LEVELS, CellGrid, levels_of, spread_to_neighbors

POINTS = 4
"""Of each cell"""
MOST_TRIANGLES = 20_000
"""Of a mesh that are looked at: some stand for all of a finer one"""
LEAST_PATCHES, WANTED_PATCHES, MOST_PATCHES = 6_000, 12_000, 24_000
LEAST_POINTS = 4
"""Of each instance, where there are not too many"""
MANY_INSTANCES = 2000
MOST_TRIES = 8
MORE = 1.3
"""Smaller cells have to bring so many times more patches"""
TRIANGLES_AT_ONCE, TRIANGLES_OF_INSTANCE = 100_000, 1000
"""Looked at in one step; what an instance takes beside its own"""
POINTS_IN_CELL = 6.0
"""Candidates for each square of a cell's side"""
LIFT = 2e-3
"""How far off the surface points are, in cells"""


@dataclass(frozen=True, slots=True)
class Patches:
    """Cells that hold some surface."""

    grid: CellGrid
    table: NDArray[np.int32]
    """(grid.count,) number of the patch of each cell; -1 where there is none"""
    positions: Float32Array
    """(patches, POINTS, 3) a little above the surface, world space"""
    normals: Float32Array
    """(patches, POINTS, 3) of the triangles"""
    light_sets: NDArray[np.int32]
    """(patches, POINTS) of what they are on"""

    @property
    def count(self) -> int:
        return len(self.positions)

    def without(self, gone: NDArray[np.bool_]) -> Patches:
        """Where patches that are `gone` (patches,) have no cell: those beside them take it."""
        table = np.where((self.table >= 0) & gone[self.table], -1, self.table).astype(np.int32)
        return replace(self, table=spread_to_neighbors(table, self.grid.levels))

    def parted(self, normals: Float32Array, distances: Float32Array) -> Patches:
        """Without the points that are behind one of the walls of their patch, planes (patches, n, 3), (patches, n): the
        first one, which is before all of them, stands in."""
        heights = np.einsum("pwk,pnk->pwn", normals, self.positions)
        behind = (heights < distances[:, :, None]).any(axis=1)
        places = np.where(behind, 0, np.arange(POINTS)[None])
        rows = np.arange(self.count)[:, None]
        return replace(
            self,
            positions=self.positions[rows, places],
            normals=self.normals[rows, places],
            light_sets=self.light_sets[rows, places],
        )


@dataclass(frozen=True, slots=True)
class Surface:
    """What of an instance points lie on."""

    mesh: MeshArrays
    instance: InstanceArrays
    is_solid: bool
    """Nothing looks at it from within"""
    light_set: int = 0


def place_patches(surfaces: Sequence[Surface], focus: Float64Array, half: float) -> Iterator[Patches | None]:
    """Points on all surfaces about a place (3,), finest within `half` of it: the last that this yields, None where
    there is no surface; before that None each time that some work is done.

    Where that makes too few or too many patches all are smaller or larger.
    """
    if not surfaces:
        return
    farthest = max(_reach(surface, focus) for surface in surfaces)
    half = max(half, farthest / 2.0 ** (MOST_LEVELS - 1))
    last = 0
    for _ in range(MOST_TRIES):
        levels = min(max(int(np.ceil(np.log2(max(farthest / half, 1.0)))) + 1, 1), MOST_LEVELS)
        # (An odd share of a cell off: floors and walls like to lie at round places.)
        shifted = focus + half / 16.0 * np.array([0.317, 0.431, 0.283])
        grid = CellGrid((float(shifted[0]), float(shifted[1]), float(shifted[2])), half, levels)
        found: list[tuple[Float64Array, Float64Array]] = []
        done = 0
        for surface in surfaces:
            found.append(_candidates(surface, grid, len(surfaces) < MANY_INSTANCES))
            done += len(surface.mesh.triangles) + TRIANGLES_OF_INSTANCE
            if done > TRIANGLES_AT_ONCE:
                done = 0
                yield None
        positions, normals = (np.concatenate(part) for part in zip(*found, strict=True))
        light_sets = np.repeat([surface.light_set for surface in surfaces], [len(places) for places, _ in found])
        cells = grid.numbers(positions, normals)
        kept = np.flatnonzero(cells >= 0)
        if len(kept) == 0:
            yield None
            return
        numbers = np.unique(cells[kept])
        if LEAST_PATCHES <= len(numbers) <= MOST_PATCHES:
            break
        if len(numbers) < LEAST_PATCHES and len(numbers) < MORE * last:
            # (There is no more to find.)
            break
        last = len(numbers)
        factor = float(np.clip((len(numbers) / WANTED_PATCHES) ** 0.5, 0.25, 4.0))
        half = max(half * factor, farthest / 2.0 ** (MOST_LEVELS - 1))
        yield None
    yield _chosen(grid, positions[kept], normals[kept], light_sets[kept], cells[kept], numbers)


def _reach(surface: Surface, focus: Float64Array) -> float:
    low, high = surface.mesh.positions.min(axis=0), surface.mesh.positions.max(axis=0)
    matrix = surface.instance.matrix
    middle = matrix[:3, :3] @ (0.5 * (low + high)) + matrix[:3, 3]
    extent = np.abs(matrix[:3, :3]) @ (0.5 * (high - low))
    return float((np.abs(middle - focus) + extent).max())


def _candidates(surface: Surface, grid: CellGrid, with_least: bool) -> tuple[Float64Array, Float64Array]:
    """Places and normals (n, 3) on an instance."""
    mesh, matrix = surface.mesh, surface.instance.matrix
    stride = -(-len(mesh.triangles) // MOST_TRIANGLES)
    triangles = mesh.triangles[::stride]
    vertices = mesh.corner_vertex[triangles]
    world = mesh.positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    corners = world[vertices]
    corners = _split(corners, grid)
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    facing = np.cross(b - a, c - a)
    if np.linalg.det(matrix[:3, :3]) < 0.0:
        facing = -facing
    double_area = np.linalg.norm(facing, axis=1)
    normals = facing / np.maximum(double_area, 1e-300)[:, None]
    levels = grid.levels_at(corners.mean(axis=1))
    size = grid.sizes(levels)
    # (What is outside of all levels is asked by nobody.)
    inside = levels < grid.levels
    wanted = np.where(inside & (double_area > 0.0), POINTS_IN_CELL * stride * 0.5 * double_area / size**2, 0.0)
    total = float(wanted.sum())
    if total <= 0.0:
        return np.empty((0, 3)), np.empty((0, 3))
    if with_least and total < LEAST_POINTS:
        wanted *= LEAST_POINTS / total
    # Systematic: as many in a row of triangles as their areas want together.
    ends = np.cumsum(wanted)
    counts = np.diff(np.floor(ends + 0.5), prepend=0.0).astype(np.int64)
    chosen = np.repeat(np.arange(len(corners)), counts)
    # (Places by a sequence that spreads evenly; Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences".)
    order = np.arange(len(chosen), dtype=np.float64)
    u, v = (0.5 + order * 0.7548776662466927) % 1.0, (0.5 + order * 0.5698402909980532) % 1.0
    folded = u + v > 1.0
    u, v = np.where(folded, 1.0 - u, u), np.where(folded, 1.0 - v, v)
    places = a[chosen] + u[:, None] * (b - a)[chosen] + v[:, None] * (c - a)[chosen]
    normals = normals[chosen]
    lift = LIFT * size[chosen, None] * normals
    if surface.is_solid:
        return places + lift, normals
    return np.concatenate([places + lift, places - lift]), np.concatenate([normals, -normals])


def _split(corners: Float64Array, grid: CellGrid) -> Float64Array:
    """Triangles (n, 3, 3) quartered until none is larger than the cells near it."""
    done: list[Float64Array] = []
    focus = np.array(grid.focus)
    while len(corners):
        edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        middle = corners.mean(axis=1)
        nearest = np.maximum(np.abs(middle - focus).max(axis=1) - edges, 0.0)
        size = grid.sizes(levels_of(nearest, grid.half, grid.levels))
        # (What is outside of all levels is not asked for.)
        outside = nearest > grid.half * 2.0 ** (grid.levels - 1)
        large = (edges > 1.5 * size) & ~outside
        done.append(corners[~large])
        a, b, c = (corners[large, k] for k in range(3))
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        quarters = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (bc, ca, ab)]
        corners = np.concatenate([np.stack(quarter, axis=1) for quarter in quarters]) if large.any() else corners[:0]
    return np.concatenate(done)


def _chosen(
    grid: CellGrid,
    positions: Float64Array,
    normals: Float64Array,
    light_sets: NDArray[np.int64],
    cells: NDArray[np.int64],
    numbers: NDArray[np.int64],
) -> Patches:
    """POINTS of each cell, well apart in the order of candidates."""
    order = np.argsort(cells, kind="stable")
    starts = np.searchsorted(cells[order], numbers)
    counts = np.diff(starts, append=len(order))
    steps = (np.arange(POINTS)[None] + 0.5) / POINTS
    picks = order[starts[:, None] + np.floor(steps * counts[:, None]).astype(np.int64)]
    table = np.full(grid.count, -1, np.int32)
    table[numbers] = np.arange(len(numbers))
    table = spread_to_neighbors(table, grid.levels)
    places, facing = (part[picks].astype(np.float32) for part in (positions, normals))
    return Patches(grid, table, places, facing, light_sets[picks].astype(np.int32))
