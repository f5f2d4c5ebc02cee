# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits edges of solved triangles where the edge's solved midpoint leaves the chord that would be drawn.

`split` halves edges by a bound that holds for every eye on a mirror that bends one way all over. This is what is left
after it: in one view, for a picture that is worth it, the midpoints of edges are solved too, and an edge is halved
where its midpoint is more than the tolerance away from where the rasteriser would draw it. The halves are asked again.
The triangles that an edge was halved of are taken out of their chunk's batches; their parts, with the records that the
chunk's solution has for the old vertices and those of the solved midpoints, are drawn from textures of their own. So
the scene's geometry stays as it is, and no vertex is solved twice.

Whether an edge is halved depends on its ends and its midpoint alone, and both are what they are for every triangle that
has the edge: no crack opens.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..optics import status
from ..optics.screen import Screen
from ..scene.arrays import Float32Array, Float64Array, Int32Array
from ..scene.view import View
from .chunk import Chunk, by_material, pack_color, unpack_color
from .gpu_objects import read_records, record_texture
from .solve import Pieces, SolvedChunk, VertexSolution
from .split import number_pairs, subdivide, with_middles

MOST_ROUNDS = 6
"""Halvings of one edge: what is still off then is where neighbours show different images, and has no midpoint"""
MOST_TRIANGLES = 1_000_000
SHORTEST = 10.0
"""Tolerances: an edge that is drawn shorter is not asked. An arc with so short a chord that it leaves by the tolerance
turns by 45 degrees."""

type Solve = Callable[[Any, int, VertexSolution], VertexSolution]
"""Of a record texture of world positions, their number, and points to start from as a solution"""


@dataclass
class _Vertices:
    """Records (n, 4) of positions as in `Chunk` and `VertexSolution`, float32."""

    positions: Float32Array
    points: Float32Array
    virtual: Float32Array

    @property
    def status(self) -> Int32Array:
        return np.rint(self.points[:, 3]).astype(np.int32) & 3

    def joined(self, other: _Vertices) -> _Vertices:
        return _Vertices(
            np.concatenate([self.positions, other.positions]),
            np.concatenate([self.points, other.points]),
            np.concatenate([self.virtual, other.virtual]),
        )

    def of(self, rows: NDArray[np.integer]) -> _Vertices:
        return _Vertices(self.positions[rows], self.points[rows], self.virtual[rows])


def with_curved_edges(part: SolvedChunk, view: View, tolerance: float, solve: Solve) -> tuple[SolvedChunk, ...]:
    """The part with edges halved until they are drawn within `tolerance` pixels: itself, or what is left and the rest.

    `solve` finds reflection points as those of the part were found.
    """
    chunk = part.chunk
    assert isinstance(chunk, Chunk), "edges are split once"
    screen = Screen(view.eye, view.focal_pixels)
    corner_position = chunk.corner_position
    vertices = _Vertices(
        read_records(chunk.positions, part.solution.count),
        read_records(part.solution.reflection_points, part.solution.count),
        read_records(part.solution.virtual_positions, part.solution.count),
    )
    rows = np.flatnonzero(_may_be_off(screen, vertices, corner_position[chunk.triangles], tolerance))
    corners = chunk.triangles[rows]
    corner_records: Float32Array | None = None
    done: list[tuple[Int32Array, NDArray[np.integer]]] = []
    straight = np.zeros(0, np.int64)
    halved = np.zeros(len(chunk.triangles), bool)
    count = 0
    for _ in range(MOST_ROUNDS):
        places = corner_position[corners]
        middle_place, pairs = number_pairs(places.ravel(), places[:, [1, 2, 0]].ravel(), 0)
        asked, middles = _asked(screen, vertices, pairs, straight, tolerance, solve)
        off = _off(screen, vertices, pairs[asked], middles, tolerance)
        split = np.zeros(len(pairs), bool)
        split[asked] = off
        straight = np.union1d(straight, _keys(pairs[~split]))
        edge_is_split = split[middle_place].reshape(-1, 3)
        touched = edge_is_split.any(axis=1)
        if corner_records is not None:
            # Parts that nothing more is cut off of; of the first round's triangles these stay in the chunk.
            done.append((corners[~touched], rows[~touched]))
        if not touched.any() or count + 4 * int(touched.sum()) > MOST_TRIANGLES:
            if corner_records is not None:
                done.append((corners[touched], rows[touched]))
            break
        if corner_records is None:
            halved[rows[touched]] = True
            corner_records = read_records(chunk.corners, 2 * len(corner_position)).reshape(-1, 8)
        corners, rows, edge_is_split = corners[touched], rows[touched], edge_is_split[touched]
        # New positions in the order of the pairs that are split, one for all corners there.
        new_place = np.full(len(pairs), -1, np.int64)
        new_place[split] = len(vertices.positions) + np.arange(split.sum())
        vertices = vertices.joined(middles.of(np.flatnonzero(off)))
        place_of_edge = new_place[middle_place].reshape(-1, 3)[touched][edge_is_split]
        start, end = corners[edge_is_split], corners[:, [1, 2, 0]][edge_is_split]
        middle, corner_pairs = number_pairs(start, end, len(corner_position))
        corner_records = _with_middle_corners(corner_records, corner_pairs)
        joined = np.empty(len(corner_pairs), np.int32)
        joined[middle - len(corner_position)] = place_of_edge
        corner_position = np.concatenate([corner_position, joined])
        middle_of_edge = np.full(corners.shape, -1, np.int32)
        middle_of_edge[edge_is_split] = middle
        corners, parents = subdivide(corners, middle_of_edge)
        rows = rows[parents]
        count = sum(len(item[0]) for item in done) + len(corners)
    else:
        done.append((corners, rows))
    if corner_records is None:
        return (part,)
    triangles = np.concatenate([item[0] for item in done])
    material = chunk.triangle_material[np.concatenate([item[1] for item in done])]
    rest = by_material(chunk.triangles[~halved], chunk.triangle_material[~halved])
    return (
        replace(part, batches=rest),
        _pieces(part, vertices, corner_records, corner_position, triangles, material),
    )


def _may_be_off(screen: Screen, vertices: _Vertices, places: Int32Array, tolerance: float) -> NDArray[np.bool_]:
    """(triangles,) which have an edge that may be asked, by their longest reach on screen."""
    code = vertices.status
    is_reflected = (code == status.REFLECTED)[places]
    found = np.zeros(len(places), bool)
    for first, second in ((0, 1), (1, 2), (2, 0)):
        rows = np.flatnonzero(is_reflected[:, first] & is_reflected[:, second] & ~found)
        found[rows] = _lengths(screen, vertices.virtual, places[rows][:, [first, second]]) > SHORTEST * tolerance
    return found


def _lengths(screen: Screen, virtual: Float32Array, pairs: Int32Array) -> Float64Array:
    """(n,) pixels between the ends of edges, where they seem to be, about."""
    a, b = (virtual[pairs[:, k], :3].astype(np.float64) for k in range(2))
    return np.asarray(np.linalg.norm(screen.pixels(0.5 * (a + b), b - a), axis=1))


def _asked(
    screen: Screen,
    vertices: _Vertices,
    pairs: Int32Array,
    straight: NDArray[np.int64],
    tolerance: float,
    solve: Solve,
) -> tuple[NDArray[np.int64], _Vertices]:
    """Which of the edges are to be asked, and their midpoints."""
    code = vertices.status[pairs]
    chosen = (code == status.REFLECTED).all(axis=1)
    chosen &= ~np.isin(_keys(pairs), straight, assume_unique=True)
    rows = np.flatnonzero(chosen)
    rows = rows[_lengths(screen, vertices.virtual, pairs[rows]) > SHORTEST * tolerance]
    if len(rows) == 0:
        empty = np.zeros((0, 4), np.float32)
        return rows, _Vertices(empty, empty, empty)
    first, second = (vertices.positions[pairs[rows, k]] for k in range(2))
    middles = np.float32(0.5) * (first + second)
    middles[:, 3] = first[:, 3]
    # From between the ends' points, as if reflected there: near, and the same image on a mirror that shows several.
    between = np.float32(0.5) * (vertices.points[pairs[rows, 0]] + vertices.points[pairs[rows, 1]])
    between[:, 3] = status.REFLECTED
    start = record_texture(between)
    solution = solve(record_texture(middles), len(middles), VertexSolution(start, start, len(middles)))
    return rows, _Vertices(
        middles,
        read_records(solution.reflection_points, len(middles)),
        read_records(solution.virtual_positions, len(middles)),
    )


def _off(
    screen: Screen, vertices: _Vertices, pairs: Int32Array, middles: _Vertices, tolerance: float
) -> NDArray[np.bool_]:
    """(n,) whether the midpoint of an edge is drawn more than `tolerance` pixels from where it is seen."""
    drawn = 0.5 * (vertices.virtual[pairs[:, 0], :3].astype(np.float64) + vertices.virtual[pairs[:, 1], :3])
    solved = middles.virtual[:, :3].astype(np.float64)
    off = np.linalg.norm(screen.pixels(solved, drawn - solved), axis=1)
    return (off > tolerance) & (middles.status == status.REFLECTED)


def _keys(pairs: Int32Array) -> NDArray[np.int64]:
    return np.asarray(pairs[:, 0].astype(np.int64) << 32 | pairs[:, 1])


def _with_middle_corners(records: Float32Array, pairs: Int32Array) -> Float32Array:
    """Corner records (n, 8) with those half way between pairs of them added; indices of positions are still to come."""
    middles = np.float32(0.5) * (records[pairs[:, 0]] + records[pairs[:, 1]])
    colors = 0.5 * (unpack_color(records[pairs[:, 0], 6]) + unpack_color(records[pairs[:, 1], 6]))
    middles[:, 6] = pack_color(colors.astype(np.float32))
    return np.concatenate([records, middles])


def _pieces(
    part: SolvedChunk,
    vertices: _Vertices,
    corner_records: Float32Array,
    corner_position: Int32Array,
    triangles: Int32Array,
    material: Int32Array,
) -> SolvedChunk:
    """What was cut, with no more records than it needs."""
    used, renumbered = np.unique(triangles, return_inverse=True)
    records = corner_records[used]
    places, of_corner = np.unique(corner_position[used], return_inverse=True)
    records[:, 3] = of_corner
    kept = vertices.of(places)
    solution = VertexSolution(record_texture(kept.points), record_texture(kept.virtual), len(places))
    pieces = Pieces(record_texture(kept.positions), record_texture(records.reshape(-1, 4)))
    batches = by_material(renumbered.reshape(-1, 3).astype(np.int32), material)
    return SolvedChunk(pieces, batches, solution, part.image)
