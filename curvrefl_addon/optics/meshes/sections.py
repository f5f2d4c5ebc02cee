# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves in which planes cut a mesh, and how much the smooth surface's section bends there.

The points lie on the triangles; the curvature is that of the plane curve in which the plane cuts the surface itself,
from its curvature tensors: with the normal curvature k_n along the section and the angle a between the surface's normal
and the plane it is k_n / cos a (Meusnier's theorem; do Carmo, "Differential Geometry of Curves and Surfaces", 3-2).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .curvature import Float64Array, normal_curvature

GRAZING = 0.02
"""Cosine of the angle between normal and plane below which the plane only touches the surface"""

SPECK = 1e-9
"""Share of the mesh's size: a shorter section is that of a corner which the plane touches"""


@dataclass(frozen=True, slots=True)
class Section:
    """One curve, in order. It ends at borders and sharp edges."""

    points: Float64Array
    """(n, 3)"""
    outwards: Float64Array
    """(n, 3) unit vectors in the plane, across the curve, on the normal's side"""
    curvature: Float64Array
    """(n,) 1 / length, positive where the curve bends away from `outwards`; NaN where the plane touches the surface"""
    is_closed: bool
    """The last point is followed by the first, which is not repeated"""

    @property
    def lengths(self) -> Float64Array:
        """(n,) along the curve from its first point."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def length(self) -> float:
        """Of the whole curve."""
        back = np.linalg.norm(self.points[0] - self.points[-1]) if self.is_closed else 0.0
        return float(self.lengths[-1] + back)

    def resampled(self, count: int) -> Section:
        """With so many points at equal distances along it, at least 2."""
        ends = np.concatenate([self.lengths, [self.length]]) if self.is_closed else self.lengths
        again = np.arange(len(self.points) + self.is_closed) % len(self.points)
        places = np.linspace(0.0, self.length, max(count, 2), endpoint=not self.is_closed)

        def at_places(values: Float64Array) -> Float64Array:
            return np.stack([np.interp(places, ends, column) for column in values[again].T], axis=-1)

        outwards = at_places(self.outwards)
        return Section(
            at_places(self.points),
            outwards / np.linalg.norm(outwards, axis=1, keepdims=True).clip(1e-30),
            at_places(self.curvature[:, None])[:, 0],
            self.is_closed,
        )


def sections(
    positions: Float64Array,
    normals: Float64Array,
    tensors: Float64Array,
    triangles: NDArray[np.integer],
    origin: Float64Array,
    plane: Float64Array,
) -> list[Section]:
    """The curves in which the plane through `origin` (3,) across the unit vector `plane` (3,) cuts triangles (m, 3).

    Vertices (n, 3) with unit normals (n, 3) and curvature tensors (n, 6). The longest curve comes first.
    """
    height = (positions - origin) @ plane
    # (A vertex in the plane counts as above it: so each triangle has two edges that cross it, or none.)
    above = height >= 0.0
    of_corners = above[triangles]
    crossing = triangles[of_corners.any(axis=1) & ~of_corners.all(axis=1)]
    if not len(crossing):
        return []
    edges = np.sort(crossing[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    crossed = above[edges[..., 0]] != above[edges[..., 1]]
    cut, numbers = np.unique(edges[crossed], axis=0, return_inverse=True)
    share = (height[cut[:, 0]] / (height[cut[:, 0]] - height[cut[:, 1]]))[:, None]

    def at_cuts(values: Float64Array) -> Float64Array:
        return values[cut[:, 0]] * (1.0 - share) + values[cut[:, 1]] * share

    points, tensors_there, normals_there = at_cuts(positions), at_cuts(tensors), at_cuts(normals)
    normals_there /= np.linalg.norm(normals_there, axis=1, keepdims=True).clip(1e-30)
    in_plane = normals_there - (normals_there @ plane)[:, None] * plane
    cosine = np.linalg.norm(in_plane, axis=1)
    outwards = in_plane / cosine[:, None].clip(1e-30)
    along = np.cross(plane, outwards)
    bent = normal_curvature(tensors_there, along) / cosine.clip(1e-30)
    curvature = np.where(cosine > GRAZING, bent, np.nan)
    found = [
        Section(points[chain], outwards[chain], curvature[chain], is_closed)
        for chain, is_closed in _chains(numbers.reshape(-1, 2), len(points))
    ]
    shortest = SPECK * float(np.linalg.norm(np.ptp(positions, axis=0)))
    return sorted((section for section in found if section.length > shortest), key=lambda section: -section.length)


def _chains(segments: NDArray[np.integer], count: int) -> list[tuple[list[int], bool]]:
    """Points (numbers below `count`) in the order of segments (n, 2), and whether each chain is closed.

    Chains end where a point has not just two segments.
    """
    segments = np.unique(np.sort(segments, axis=1), axis=0)
    segments = segments[segments[:, 0] != segments[:, 1]]
    neighbors: list[list[int]] = [[] for _ in range(count)]
    for one, other in segments.tolist():
        neighbors[one].append(other)
        neighbors[other].append(one)
    walked: set[tuple[int, int]] = set()

    def walk(start: int, following: int) -> list[int]:
        chain = [start]
        before, here = start, following
        while True:
            walked.add((before, here))
            walked.add((here, before))
            chain.append(here)
            if len(neighbors[here]) != 2 or here == start:
                return chain
            one, other = neighbors[here]
            before, here = here, other if one == before else one

    ends = [point for point in range(count) if len(neighbors[point]) not in (0, 2)]
    found = []
    for start in [*ends, *(point for point in range(count) if len(neighbors[point]) == 2)]:
        for following in neighbors[start]:
            if (start, following) not in walked:
                chain = walk(start, following)
                is_closed = chain[0] == chain[-1]
                found.append((chain[:-1] if is_closed else chain, is_closed))
    return found
