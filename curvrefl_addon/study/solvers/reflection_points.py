# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The reflection points of vertices, and which of them an image may show."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...optics.surfaces.radial_surfaces import Float64Array

MINIMUM, SADDLE, MAXIMUM = 0, 1, 2
"""Kinds of stationary points of the path length"""


@dataclass(frozen=True)
class ReflectionPoints:
    """The k reflection points of n vertices, sorted by vertex and then by path length."""

    vertex: NDArray[np.int64]
    """(k,) index of the vertex"""
    u: Float64Array
    """(k, 3) direction from the star center"""
    point: Float64Array
    """(k, 3) P"""
    length: Float64Array
    """(k,) |EP| + |PV|; for an eye at infinity |PV| minus the way towards the eye"""
    signature: NDArray[np.int64]
    """(k,) MINIMUM, SADDLE or MAXIMUM of the path length"""
    visible: NDArray[np.bool_]
    """(k,) whether no other part of the surface lies between P and eye or vertex"""

    def counts(self, vertices: int) -> NDArray[np.int64]:
        """(vertices,) how many visible ones each vertex has."""
        return np.bincount(self.vertex[self.visible], minlength=vertices)

    def nearest_to(self, points: Float64Array) -> Float64Array:
        """(n, 3) per vertex the visible reflection point nearest to `points` (n, 3); NaN where there is none."""
        result = np.full(points.shape, np.nan)
        least = np.full(len(points), np.inf)
        for vertex, point in self._by_rank():
            distance = np.linalg.norm(points[vertex] - point, axis=1)
            better = distance < least[vertex]
            least[vertex[better]] = distance[better]
            result[vertex[better]] = point[better]
        return result

    def first(self, vertices: int) -> Float64Array:
        """(vertices, 3) per vertex the visible one of the shortest path; NaN where there is none."""
        result = np.full((vertices, 3), np.nan)
        for vertex, point in self._by_rank():
            empty = np.isnan(result[vertex, 0])
            result[vertex[empty]] = point[empty]
        return result

    def _by_rank(self) -> Iterator[tuple[NDArray[np.int64], Float64Array]]:
        """First points of all vertices, then second ones, ..."""
        seen, point = self.vertex[self.visible], self.point[self.visible]
        rank = np.arange(len(seen)) - np.searchsorted(seen, seen)
        for number in range(int(rank.max(initial=-1)) + 1):
            yield seen[rank == number], point[rank == number]
