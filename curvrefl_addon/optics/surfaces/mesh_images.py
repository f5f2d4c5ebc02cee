# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where in a picture a mesh shows given scene points, by Newton's method from places nearby, in float64.

`mesh_reflections` finds all reflection points of a scene point; where one is known from a frame before, or from a
method that is nearly right, the image that belongs to it is a few steps away. A step solves for the half-vector within
one triangle and is followed to the triangle that the eye's ray meets there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .half_vectors import HalfVectors, all_weights
from .mesh_rays import MeshRays
from .radial_surfaces import Float64Array

ROUNDS = 16
"""Rays for each image, at most"""
STEPS = 6
"""Newton steps within one triangle"""
FOUND = 1e-9
"""Half-vector less normal, across the triangle"""
EDGE = 1e-7
"""Barycentric slack, so that no image is lost between two triangles"""
LONGEST = 0.1
"""Step in the picture, share of its height"""

type Sight = Callable[[Float64Array], tuple[Float64Array, Float64Array]]
"""Origins (n, 3) and unit directions (n, 3) of the lines of sight through places (n, 2) in a picture, pixels"""
type Project = Callable[[Float64Array], Float64Array]
"""Places (n, 2) in a picture, pixels, of world points (n, 3)"""


class MeshImages:
    """A mesh that is asked where it shows what."""

    def __init__(self, positions: Float64Array, normals: Float64Array, triangles: NDArray[np.integer]) -> None:
        """Corners (k, 3), their shading normals (k, 3), of any length, and triangles (t, 3) of corners, t > 0."""
        self._halves = HalfVectors(positions, normals, triangles)
        self._rays = MeshRays(positions, normals, triangles)

    def places(
        self,
        eye: Float64Array,
        sight: Sight,
        project: Project,
        height: int,
        shown: Float64Array,
        start: Float64Array,
        pause: Callable[[], None] = lambda: None,
    ) -> tuple[Float64Array, Float64Array, NDArray[np.bool_]]:
        """Places (n, 2) in a picture so many pixels high where the mesh shows scene points (n, 4) to the eye (4,), the
        mesh's points (n, 3) there, and which were found (n,), searched from places (n, 2).

        The front of the mesh as seen from the eye; whether anything else hides the image is not asked. Of several
        images it is the one that the search ends at. `pause` is called between rounds; what it raises ends the search.
        """
        place, seen, found = np.array(start, np.float64), np.full((len(start), 3), np.nan), np.zeros(len(start), bool)
        row = np.flatnonzero(np.isfinite(place).all(axis=1) & np.isfinite(shown).all(axis=1))
        good = place.copy()
        longest = LONGEST * height
        for _ in range(ROUNDS):
            if len(row) == 0:
                break
            pause()
            hits = self._rays.first_hits(*sight(place[row]))
            is_met = hits.triangle >= 0
            # (Beside the mesh: halfway back to where it was met.)
            lost = row[~is_met]
            place[lost] = 0.5 * (place[lost] + good[lost])
            here = row[is_met]
            good[here] = place[here]
            weights, ends = self._within(eye, shown[here], hits.triangle[is_met], hits.weights[is_met, 1:])
            point = np.einsum("nk,nkj->nj", all_weights(weights), self._halves.corners[hits.triangle[is_met]])
            there = project(point)
            way = there - place[here]
            length = np.linalg.norm(way, axis=1)
            short = np.minimum(1.0, longest / np.maximum(length, 1e-300))[:, None]
            place[here] = np.where(ends[:, None], there, place[here] + short * way)
            found[here[ends]], seen[here[ends]] = True, point[ends]
            # (A place that the mesh was not met at before has nowhere to go back to.)
            stays = np.concatenate([here[~ends], lost[(place[lost] != good[lost]).any(axis=1)]])
            row = np.sort(stays[np.isfinite(place[stays]).all(axis=1)])
        return place, seen, found

    def _within(
        self, eye: Float64Array, shown: Float64Array, triangle: NDArray[np.int64], start: Float64Array
    ) -> tuple[Float64Array, NDArray[np.bool_]]:
        """Weights (n, 2) of the last two corners after Newton steps that end where they leave the triangle, and
        whether (n,) the image is there."""
        place, ends = start.copy(), np.zeros(len(start), bool)
        row = np.arange(len(start))
        for _ in range(STEPS):
            miss = self._halves.miss(eye, shown[row], triangle[row], place[row])
            done = np.linalg.norm(miss, axis=1) < FOUND
            ends[row[done]] = True
            row, miss = row[~done], miss[~done]
            if len(row) == 0:
                break
            place[row] += self._halves.step(eye, shown[row], triangle[row], place[row], miss)
            inside = (all_weights(place[row]) >= -EDGE).all(axis=1)
            row = row[inside]
        return place, ends & (all_weights(place) >= -EDGE).all(axis=1)
