# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays against a triangle mesh with shading normals, by a bounding-volume hierarchy in numpy: the oracle's other check.

What the oracle says of a mirror is turned round: the eye's ray to a reflection point must meet the mesh there first,
and reflected about the shading normal, as Cycles does, it must lead to the vertex. float64; no Python per ray.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .radial_surfaces import Float64Array, unit

LEAF = 8
"""Triangles of a leaf, at most"""
EDGE = 1e-9
"""Barycentric slack, so that no ray slips between two triangles"""


@dataclass(frozen=True)
class Hits:
    """First hits of n rays."""

    distance: Float64Array
    """(n,) along unit directions; infinite where nothing is hit"""
    triangle: NDArray[np.int64]
    """(n,) -1 where nothing is hit"""
    normal: Float64Array
    """(n, 3) unit shading normal there; NaN where nothing is hit"""
    weights: Float64Array
    """(n, 3) of the triangle's corners"""


class MeshRays:
    """A mesh that rays can be cast at."""

    def __init__(self, positions: Float64Array, normals: Float64Array, triangles: NDArray[np.integer]) -> None:
        """Corners (k, 3), their shading normals (k, 3) and triangles (t, 3) of corners."""
        self._normals = np.asarray(normals, np.float64)[triangles]
        corners = np.asarray(positions, np.float64)[triangles]
        self._origin, self._edge_1, self._edge_2 = (
            corners[:, 0],
            corners[:, 1] - corners[:, 0],
            corners[:, 2] - corners[:, 0],
        )
        # A full binary tree over triangles; all leaves at one depth.
        groups = halved(corners.mean(axis=1), LEAF)
        self._first_leaf = len(groups) - 1
        self._leaves = np.full((len(groups), LEAF), -1)
        for number, group in enumerate(groups):
            self._leaves[number, : len(group)] = group
        count = self._first_leaf + len(groups)
        self._low, self._high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
        for number, group in enumerate(groups, self._first_leaf):
            if len(group):
                self._low[number] = corners[group].min(axis=(0, 1))
                self._high[number] = corners[group].max(axis=(0, 1))
        for node in range(self._first_leaf - 1, -1, -1):
            self._low[node] = self._low[2 * node + 1 : 2 * node + 3].min(axis=0)
            self._high[node] = self._high[2 * node + 1 : 2 * node + 3].max(axis=0)

    def first_hits(self, origins: Float64Array, directions: Float64Array, least: float = 0.0) -> Hits:
        """Of rays (n, 3) along unit directions (n, 3), farther away than `least`; both sides of triangles are hit."""
        count = len(origins)
        distance, triangle = np.full(count, np.inf), np.full(count, -1)
        weights = np.zeros((count, 2))
        inverse = 1.0 / np.where(directions == 0.0, 1e-300, directions)
        ray, node = np.arange(count), np.zeros(count, int)
        while len(ray):
            with np.errstate(over="ignore", invalid="ignore"):
                near = (self._low[node] - origins[ray]) * inverse[ray]
                far = (self._high[node] - origins[ray]) * inverse[ray]
            enter = np.minimum(near, far).max(axis=1)
            leave = np.maximum(near, far).min(axis=1)
            met = (enter <= leave * (1.0 + 1e-12)) & (leave >= least) & (enter <= distance[ray])
            ray, node = ray[met], node[met]
            leaf = node >= self._first_leaf
            self._meet(ray[leaf], node[leaf], origins, directions, least, distance, triangle, weights)
            ray, node = ray[~leaf], node[~leaf]
            ray, node = np.concatenate([ray, ray]), np.concatenate([2 * node + 1, 2 * node + 2])
        corner_normals = self._normals[np.maximum(triangle, 0)]
        shares = np.column_stack([1.0 - weights.sum(axis=1), weights])
        normal = unit(np.einsum("nk,nkj->nj", shares, corner_normals))
        normal[triangle < 0] = np.nan
        return Hits(distance, triangle, normal, shares)

    def _meet(
        self,
        ray: NDArray[np.int64],
        node: NDArray[np.int64],
        origins: Float64Array,
        directions: Float64Array,
        least: float,
        distance: Float64Array,
        triangle: NDArray[np.int64],
        weights: Float64Array,
    ) -> None:
        """Test rays against the triangles of their leaves; updates the last three in place."""
        for column in range(LEAF):
            chosen = self._leaves[node - self._first_leaf, column]
            kept = chosen >= 0
            rays, tested = ray[kept], chosen[kept]
            # Moeller & Trumbore 1997.
            across = np.cross(directions[rays], self._edge_2[tested])
            determinant = np.einsum("ij,ij->i", self._edge_1[tested], across)
            scale = 1.0 / np.where(determinant == 0.0, np.inf, determinant)
            offset = origins[rays] - self._origin[tested]
            u = np.einsum("ij,ij->i", offset, across) * scale
            other = np.cross(offset, self._edge_1[tested])
            v = np.einsum("ij,ij->i", directions[rays], other) * scale
            t = np.einsum("ij,ij->i", self._edge_2[tested], other) * scale
            hit = (determinant != 0.0) & (u >= -EDGE) & (v >= -EDGE) & (u + v <= 1.0 + EDGE) & (t > least)
            # A ray may be in several leaves of this round: the nearest hit last.
            order = np.flatnonzero(hit)[np.argsort(-t[hit], kind="stable")]
            order = order[t[order] < distance[rays[order]]]
            distance[rays[order]], triangle[rays[order]] = t[order], tested[order]
            weights[rays[order]] = np.column_stack([u, v])[order]


def reflected_miss(mesh: MeshRays, eye: Float64Array, points: Float64Array, vertices: Float64Array) -> Float64Array:
    """(n,) radians between the eye's ray to each point (n, 3), reflected at the mesh, and the way on to the vertex.

    `eye` (4,) is homogeneous; infinite where the ray misses the mesh.
    """
    direction = unit(points * eye[3] - eye[:3])
    back = np.linalg.norm(points - eye[:3], axis=1) if eye[3] else np.full(len(points), 1e3)
    origins = points - back[:, None] * direction
    hits = mesh.first_hits(origins, direction)
    met = hits.triangle >= 0
    place = origins + np.where(met, hits.distance, 0.0)[:, None] * direction
    cosine = np.einsum("ij,ij->i", direction, hits.normal)
    ray = direction - 2.0 * cosine[:, None] * hits.normal
    way = unit(vertices - place)
    angle = np.arctan2(np.linalg.norm(np.cross(ray, way), axis=1), np.einsum("ij,ij->i", ray, way))
    return np.where(met, angle, np.inf)


def halved(middle: Float64Array, most: int) -> list[NDArray[np.int64]]:
    """Things with these middles (n, 3) in groups of `most` at most, a power of two of them, by halving them along the
    longest axis again and again: the leaves of a full tree from left to right."""
    depth = max(int(np.ceil(np.log2(max(len(middle), 1) / most))), 0)
    groups = [np.arange(len(middle))]
    for _ in range(depth):
        groups = [half for group in groups for half in _halves(group, middle)]
    return groups


def _halves(group: NDArray[np.int64], middle: Float64Array) -> list[NDArray[np.int64]]:
    if len(group) < 2:
        return [group, group[:0]]
    axis = int(np.ptp(middle[group], axis=0).argmax())
    order = group[np.argsort(middle[group, axis], kind="stable")]
    half = (len(order) + 1) // 2
    return [order[:half], order[half:]]
