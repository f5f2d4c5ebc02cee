# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits edges of solved triangles where the edge's solved midpoint leaves the chord that would be drawn.

`split` halves edges by a bound that knows no eye and no bumps. What it leaves is done here, in one view, for a picture
that is worth it: midpoints of edges are solved too, and an edge is halved where its midpoint is seen more than the
tolerance away from where the rasterizer would draw it. The halves are asked again. Triangles that are cut so are taken
out of their chunk's batches; their parts are drawn from records of their own: those that the chunk's solution has for
the old vertices, and those of the solved midpoints. So the scene's geometry stays as it is, and no vertex is solved
twice.

Whether an edge is halved depends on its ends and its midpoint alone, and they are the same for all triangles that have
the edge: no crack opens. Edges across the horizon, with an end that the mirror hides, are left as they are: the hidden
end is placed to go on smoothly, and cut they showed more wrong pixels (`docs/methods.md`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...optics import status
from ...scene.arrays import Float32Array, Int32Array
from ...scene.camera.view import View
from ..device.batches import by_material
from ..device.records import read_records, record_texture
from ..geometry.chunk import Chunk
from ..geometry.split import number_pairs, subdivide
from .solution import Pieces, SolvedChunk, VertexSolution

MOST_ROUNDS = 6
"""Halvings of one edge: what leaves its chord then lies between vertices that show different images"""
MOST_TRIANGLES = 1_000_000
"""More parts than these are not cut again"""
SHORTEST = 8.0
"""Tolerances: an edge that is drawn shorter is not asked. An arc with so short a chord that it leaves by the tolerance
turns by 56 degrees."""

type Solve = Callable[[Any, int, VertexSolution], VertexSolution]
"""Of a record texture of world positions, their number, and points to start from as a solution"""


@dataclass(frozen=True)
class _Vertices:
    """Records (n, 4) of positions as in `Chunk` and `VertexSolution`."""

    positions: Float32Array
    points: Float32Array
    virtual: Float32Array
    pixels: NDArray[np.complex64]
    """(n,) x + iy where they are seen; NaN where they are not"""

    @classmethod
    def read(cls, positions: Any, solution: VertexSolution, view: View) -> _Vertices:
        """From the GPU."""
        points = read_records(solution.reflection_points, solution.count)
        virtual = read_records(solution.virtual_positions, solution.count)
        seen = np.flatnonzero(np.rint(points[:, 3]).astype(np.int32) & 3 == status.REFLECTED)
        # Not what lies behind the eye's plane, next to a large mirror: it would be projected through infinity.
        row = view.world_to_clip[3]
        seen = seen[virtual[seen, :3] @ row[:3] + row[3] > 0.0]
        pixels = np.full(solution.count, np.nan, np.complex64)
        pixels[seen] = _project(view, virtual[seen, :3])
        return cls(read_records(positions, solution.count), points, virtual, pixels)

    def joined(self, other: _Vertices) -> _Vertices:
        """The other's after these."""
        return _Vertices(*(np.concatenate(pair) for pair in zip(self._arrays, other._arrays, strict=True)))

    def of(self, rows: NDArray[np.integer]) -> _Vertices:
        """Those of some rows."""
        return _Vertices(*(array[rows] for array in self._arrays))

    @property
    def _arrays(self) -> tuple[Any, ...]:
        return self.positions, self.points, self.virtual, self.pixels


class _Cutting:
    """Triangles of a chunk that are cut into parts, and their vertices."""

    def __init__(self, chunk: Chunk, solution: VertexSolution, view: View, tolerance: float, solve: Solve) -> None:
        self.vertices = _Vertices.read(chunk.positions, solution, view)
        self.corner_position = chunk.corner_position
        self.corner_records = np.zeros((0, 8), np.float32)
        """(corners, 8) two records of each; read when something is cut"""
        self.halved: list[Int32Array] = []
        """Pairs (n, 2) of corners between which the next corners are"""
        self.chunk, self._view, self._tolerance, self._solve = chunk, view, tolerance, solve
        self._straight = np.zeros(0, np.int64)
        """Keys of edges that have been asked, or need not be"""

    def cut(self, corners: Int32Array) -> tuple[Int32Array, NDArray[np.integer], NDArray[np.bool_]]:
        """Parts (m, 3) of those of the triangles (n, 3) with an edge that leaves its chord, the triangle (m,) that each
        is of, and whether (n,) a triangle is cut."""
        places = self.corner_position[corners]
        asked = self._may_leave(places)
        edge, pairs = number_pairs(places[asked], places[:, [1, 2, 0]][asked], 0)
        keys = pairs[:, 0].astype(np.int64) << 32 | pairs[:, 1]
        new = ~np.isin(keys, self._straight, assume_unique=True)
        middles = self._middles(pairs[new])
        leaves = self._leaves(pairs[new], middles)
        is_split = np.zeros(len(pairs), bool)
        is_split[new] = leaves
        self._straight = np.union1d(self._straight, keys[~is_split])

        place = np.full(len(pairs), -1, np.int32)
        place[is_split] = len(self.vertices.positions) + np.arange(np.count_nonzero(leaves))
        middle_place = np.full(corners.shape, -1, np.int32)
        middle_place[asked] = place[edge]
        is_cut = (middle_place >= 0).any(axis=1)
        rows = np.flatnonzero(is_cut)
        if len(rows) == 0:
            return corners[:0], rows, is_cut
        self.vertices = self.vertices.joined(middles.of(np.flatnonzero(leaves)))
        parts, parents = subdivide(corners[rows], self._middle_corners(corners[rows], middle_place[rows]))
        return parts, rows[parents], is_cut

    def _may_leave(self, places: Int32Array) -> NDArray[np.bool_]:
        """(n, 3) whether edges of triangles of positions (n, 3) are seen at both ends, long, and near the picture."""
        seen = self.vertices.pixels
        corners = [seen[places[:, k]] for k in range(3)]
        found = np.empty(places.shape, bool)
        for k in range(3):
            along = corners[(k + 1) % 3] - corners[k]
            # Comparisons with NaN are false.
            found[:, k] = along.real**2 + along.imag**2 > (SHORTEST * self._tolerance) ** 2
        rows, edges = np.nonzero(found)
        start, end = seen[places[rows, edges]], seen[places[rows, (edges + 1) % 3]]
        reach = np.abs(end - start)
        for a, b, size in (
            (start.real, end.real, self._view.width),
            (start.imag, end.imag, self._view.height),
        ):
            found[rows, edges] &= (np.maximum(a, b) + reach > 0.0) & (np.minimum(a, b) - reach < size)
        return found

    def _middles(self, pairs: Int32Array) -> _Vertices:
        """Solved midpoints of edges (n, 2)."""
        if len(pairs) == 0:
            return self.vertices.of(np.zeros(0, np.int64))
        middles = self.vertices.positions[pairs].mean(axis=1)
        # From between the ends' points, as if reflected there: near, and the same image where there are several. (For
        # methods that start from the last frame's points; others search afresh.)
        between = self.vertices.points[pairs].mean(axis=1)
        between[:, 3] = status.REFLECTED
        positions, start = record_texture(middles), record_texture(between)
        solution = self._solve(positions, len(pairs), VertexSolution(start, start, len(pairs)))
        return _Vertices.read(positions, solution, self._view)

    def _leaves(self, pairs: Int32Array, middles: _Vertices) -> NDArray[np.bool_]:
        """(n,) whether midpoints are drawn more than the tolerance from where they are seen."""
        drawn = _project(self._view, self.vertices.virtual[pairs, :3].astype(np.float64).mean(axis=1))
        # Not of those that are not seen: their place is NaN.
        return np.asarray(np.abs(middles.pixels - drawn) > self._tolerance)

    def _middle_corners(self, corners: Int32Array, middle_place: Int32Array) -> Int32Array:
        """New corners half way on the edges of triangles (n, 3), -1 where `middle_place` has no position for one."""
        count = len(self.corner_position)
        if len(self.corner_records) == 0:
            self.corner_records = read_records(self.chunk.corners, 2 * count).reshape(-1, 8)
        halved = middle_place >= 0
        middle, pairs = number_pairs(corners[halved], corners[:, [1, 2, 0]][halved], count)
        place = np.empty(len(pairs), np.int32)
        place[middle - count] = middle_place[halved]
        self.corner_position = np.concatenate([self.corner_position, place])
        self.halved.append(pairs)
        self.corner_records = np.concatenate([self.corner_records, self.corner_records[pairs].mean(axis=1)])
        result = np.full(corners.shape, -1, np.int32)
        result[halved] = middle
        return result


def with_curved_edges(part: SolvedChunk, view: View, tolerance: float, solve: Solve) -> tuple[SolvedChunk, ...]:
    """The part with edges halved until they are drawn within `tolerance` pixels: itself, or what is left and the rest.

    `part` is of a whole chunk; `solve` finds reflection points as its own were found.
    """
    chunk = part.chunk
    assert isinstance(chunk, Chunk), "edges are split once"
    cutting = _Cutting(chunk, part.solution, view, tolerance, solve)
    corners, rows, is_cut = cutting.cut(chunk.triangles)
    if not is_cut.any():
        return (part,)
    whole = ~is_cut
    done: list[tuple[Int32Array, NDArray[np.integer]]] = []
    for _ in range(1, MOST_ROUNDS):
        if len(corners) == 0 or len(corners) > MOST_TRIANGLES:
            break
        parts, parents, is_cut = cutting.cut(corners)
        done.append((corners[~is_cut], rows[~is_cut]))
        corners, rows = parts, rows[parents]
    done.append((corners, rows))
    material = chunk.triangle_material
    pieces = _pieces(
        cutting,
        np.concatenate([triangles for triangles, _ in done]),
        material[np.concatenate([of_chunk for _, of_chunk in done])],
        part.image,
    )
    return replace(part, batches=by_material(chunk.triangles[whole], material[whole]), whole=whole), pieces


def _project(view: View, points: NDArray[np.floating]) -> NDArray[np.complex128]:
    """(n,) x + iy in pixels of points (n, 3)."""
    return np.asarray(view.project(points.astype(np.float64)).view(np.complex128)[:, 0])


def _pieces(cutting: _Cutting, triangles: Int32Array, material: Int32Array, image: int) -> SolvedChunk:
    """What was cut, with no more records than it needs."""
    used, renumbered = np.unique(triangles, return_inverse=True)
    records = cutting.corner_records[used]
    places, of_corner = np.unique(cutting.corner_position[used], return_inverse=True)
    records[:, 3] = of_corner
    vertices = cutting.vertices.of(places)
    solution = VertexSolution(record_texture(vertices.points), record_texture(vertices.virtual), len(places))
    triangles = renumbered.reshape(-1, 3).astype(np.int32)
    # (Of the cutting no more is kept than this.)
    chunk, halved = cutting.chunk, cutting.halved
    pieces = Pieces(
        record_texture(vertices.positions),
        record_texture(records.reshape(-1, 4)),
        triangles,
        of_corner.astype(np.int32),
        chunk,
        lambda: chunk.attributes.of_pieces(halved, used),
    )
    return SolvedChunk(pieces, by_material(triangles, material), solution, image)
