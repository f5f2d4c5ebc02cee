# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far half-vectors on the triangles of a mesh are from its shading normals, and Newton's step from there, float64.

A point of the mesh shows V to the eye E where the half-vector of the ways to both is the interpolated shading normal,
or its opposite. All is per row: m places, each on a triangle, homogeneous scene points (m, 4), one eye (4,); what is
infinitely far away has a last number of 0.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .radial_surfaces import Float64Array, unit

PROBE = 1e-6
"""Step of the weights that derivatives are found by"""


class HalfVectors:
    """Of one mesh; both of its sides reflect."""

    def __init__(self, positions: Float64Array, normals: Float64Array, triangles: NDArray[np.integer]) -> None:
        """Corners (k, 3), their shading normals (k, 3), of any length, and triangles (t, 3) of corners, t > 0."""
        self.corners = np.asarray(positions, np.float64)[triangles]
        self.normals = np.asarray(normals, np.float64)[triangles]
        edge = self.corners[:, 1] - self.corners[:, 0]
        facet = np.cross(edge, self.corners[:, 2] - self.corners[:, 0])
        along = unit(np.where(np.linalg.norm(edge, axis=1, keepdims=True) > 0.0, edge, np.array([1.0, 0.0, 0.0])))
        across = np.cross(unit(np.where(np.linalg.norm(facet, axis=1, keepdims=True) > 0.0, facet, 1.0)), along)
        self.tangents = np.stack([along, across], axis=1)

    def miss(
        self, eye: Float64Array, shown: Float64Array, triangle: NDArray[np.int64], place: Float64Array
    ) -> Float64Array:
        """(m, 2) half-vector less normal along the triangle's tangents, at weights (m, 2) of its last two corners."""
        _, normal, half, sign = self.at(eye, shown, triangle, all_weights(place))
        return np.einsum("mkj,mj->mk", self.tangents[triangle], half - sign[:, None] * normal)

    def at(
        self, eye: Float64Array, shown: Float64Array, triangle: NDArray[np.int64], weights: Float64Array
    ) -> tuple[Float64Array, Float64Array, Float64Array, Float64Array]:
        """Place (m, 3), unit normal, unit half-vector, and on which side of the normal that is (1 or -1)."""
        point = np.einsum("mk,mkj->mj", weights, self.corners[triangle])
        normal = unit(np.einsum("mk,mkj->mj", weights, self.normals[triangle]))
        half = unit(towards(eye, point)[0] + towards(shown, point)[0] + 1e-300)
        return point, normal, half, np.where(np.einsum("mj,mj->m", half, normal) < 0.0, -1.0, 1.0)

    def step(
        self,
        eye: Float64Array,
        shown: Float64Array,
        triangle: NDArray[np.int64],
        place: Float64Array,
        miss: Float64Array,
    ) -> Float64Array:
        """(m, 2) what Newton's method adds to weights (m, 2) that have this miss (m, 2); 0 where there is no slope."""
        slope = np.stack(
            [(self.miss(eye, shown, triangle, place + PROBE * axis) - miss) / PROBE for axis in np.eye(2)], axis=2
        )
        determinant = slope[:, 0, 0] * slope[:, 1, 1] - slope[:, 0, 1] * slope[:, 1, 0]
        safe = np.where(determinant == 0.0, np.inf, determinant)
        step = np.stack(
            [
                slope[:, 1, 1] * miss[:, 0] - slope[:, 0, 1] * miss[:, 1],
                slope[:, 0, 0] * miss[:, 1] - slope[:, 1, 0] * miss[:, 0],
            ],
            axis=1,
        )
        return -step / safe[:, None]


def all_weights(place: Float64Array) -> Float64Array:
    """Weights (m, 3) of a triangle's corners by those (m, 2) of its last two."""
    return np.column_stack([1.0 - place.sum(axis=1), place])


def towards(points: Float64Array, place: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Unit directions (m, 3) from places (m, 3) to homogeneous points (4,) or (m, 4), and the distances (m,)."""
    way = points[..., :3] - points[..., 3:] * place
    distance = np.linalg.norm(way, axis=1)
    return way / np.maximum(distance, 1e-300)[:, None], distance
