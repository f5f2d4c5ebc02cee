# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh cut open along edges: each side of an edge is seen without the other."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .components import components
from .curvature import Float64Array
from .jets import Jet, fit_jet

ENOUGH = 18
"""Neighbors that a fit is made from where a side has so many"""
MOST_RINGS = 5
"""Of triangles around a vertex"""

type Edges = NDArray[np.integer]
"""(k, 2) vertices"""


def border_edges(triangles: NDArray[np.integer]) -> Edges:
    """Edges that one triangle has alone."""
    edges, counts = np.unique(_edges_of(triangles), axis=0, return_counts=True)
    return edges[counts == 1]


class CutMesh:
    """The triangles near some edges, and the surface on each side of these.

    A *side vertex* is a vertex as the triangles see it that meet there without an edge of the cut between them.
    """

    def __init__(self, positions: Float64Array, triangles: NDArray[np.integer], cut: Edges) -> None:
        """Vertices (n, 3), triangles (m, 3), cut along edges (k, 2) of them."""
        self.positions = positions
        self.cut = np.unique(np.sort(cut.reshape(-1, 2), axis=1), axis=0)
        """(k, 2) each once, ascending"""
        self.triangles = _near(triangles, self.cut, len(positions))
        self._side_of_corner = self._joined_corners()
        self.vertex_of_side = np.empty(int(self._side_of_corner.max(initial=-1)) + 1, np.int64)
        """(sides,) vertex of each side vertex"""
        self.vertex_of_side[self._side_of_corner.ravel()] = self.triangles.ravel()
        self._jets: dict[int, Jet | None] = {}

    @cached_property
    def sides_of_edges(self) -> list[list[tuple[int, int]]]:
        """For each edge of the cut, of each triangle that has it: the side vertices at the edge's first and second end.

        Of triangles that go along it the other way round come second.
        """
        found: list[list[tuple[int, int]]] = [[] for _ in self.cut]
        number = {edge: index for index, edge in enumerate(map(tuple, self.cut.tolist()))}
        reversed_ones: list[list[tuple[int, int]]] = [[] for _ in self.cut]
        in_cut = np.isin(self.triangles, self.cut).sum(axis=1) >= 2
        for corners, sides in zip(self.triangles[in_cut].tolist(), self._side_of_corner[in_cut].tolist(), strict=True):
            for one, other in ((0, 1), (1, 2), (2, 0)):
                a, b = corners[one], corners[other]
                index = number.get((min(a, b), max(a, b)))
                if index is not None and a < b:
                    found[index].append((sides[one], sides[other]))
                elif index is not None:
                    reversed_ones[index].append((sides[other], sides[one]))
        return [forwards + backwards for forwards, backwards in zip(found, reversed_ones, strict=True)]

    def jet(self, side: int) -> Jet | None:
        """The surface at a side vertex, from its own side alone; None where too little of it is there."""
        if side not in self._jets:
            self._jets[side] = self._fitted(side)
        return self._jets[side]

    def _fitted(self, side: int) -> Jet | None:
        members, start = self._members, self._member_starts
        reached, ring, faces = {side}, {side}, set[int]()
        for _ in range(MOST_RINGS):
            touched = {face for one in ring for face in members[start[one] : start[one + 1]].tolist()} - faces
            if not faces:
                normal = self._mean_normal(sorted(touched))
            faces |= touched
            ring = set(self._side_of_corner[sorted(touched)].ravel().tolist()) - reached
            reached |= ring
            if len(reached) > ENOUGH or not ring:
                break
        if normal is None:
            return None
        around = sorted(reached - {side})
        place = self.positions[self.vertex_of_side[side]]
        return fit_jet(place, self.positions[self.vertex_of_side[around]], normal)

    def _mean_normal(self, faces: list[int]) -> Float64Array | None:
        a, b, c = self.positions[self.triangles[faces]].transpose(1, 0, 2)
        total = np.cross(b - a, c - a).sum(axis=0)
        length = float(np.linalg.norm(total))
        return total / length if length > 0.0 else None

    @cached_property
    def _member_starts(self) -> NDArray[np.int64]:
        counts = np.bincount(self._side_of_corner.ravel(), minlength=len(self.vertex_of_side))
        return np.concatenate([[0], np.cumsum(counts)])

    @cached_property
    def _members(self) -> NDArray[np.int64]:
        """Triangles of each side vertex, one after the other."""
        return np.argsort(self._side_of_corner.ravel(), kind="stable") // 3

    def _joined_corners(self) -> NDArray[np.int64]:
        """(m, 3) side vertex of each corner: corners are joined across edges that are not in the cut."""
        count = len(self.triangles)
        labels = np.arange(3 * count)
        edges = _edges_of(self.triangles)
        if count:
            kept = ~_is_in(edges, self.cut)
            # Corners at the lower and at the higher end of each edge of each triangle.
            corners = np.arange(3 * count).reshape(count, 3)[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
            ends = self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
            corners = np.where((ends[:, 0] > ends[:, 1])[:, None], corners[:, ::-1], corners)
            edges, corners = edges[kept], corners[kept]
            order = np.lexsort((edges[:, 1], edges[:, 0]))
            edges, corners = edges[order], corners[order]
            same = (edges[1:] == edges[:-1]).all(axis=1)
            pairs = np.column_stack([corners[:-1][same].ravel(), corners[1:][same].ravel()])
            labels = components(3 * count, pairs)
        _, numbers = np.unique(labels, return_inverse=True)
        return numbers.reshape(count, 3)


def _edges_of(triangles: NDArray[np.integer]) -> Edges:
    """(3 m, 2) of triangles, ascending."""
    return np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)


def _is_in(edges: Edges, others: Edges) -> NDArray[np.bool_]:
    """(n,) whether ascending edges (n, 2) are among others."""
    base = int(max(edges.max(initial=0), others.max(initial=0))) + 1
    return np.isin(
        edges[:, 0].astype(np.int64) * base + edges[:, 1], others[:, 0].astype(np.int64) * base + others[:, 1]
    )


def _near(triangles: NDArray[np.integer], cut: Edges, count: int) -> NDArray[np.integer]:
    """Those that fits at the ends of edges may look at."""
    reached = np.zeros(count, bool)
    reached[cut] = True
    for _ in range(MOST_RINGS + 1):
        touched = reached[triangles].any(axis=1)
        reached[triangles[touched]] = True
    return triangles[touched]
