# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All reflection points of scene points on a mesh with shading normals, in float64: the ways that `exact` finds
from the eye, found from both ends.

A point of the mesh shows V to the eye E where the half-vector of the ways to both is the shading normal, or its
opposite. A tree over the triangles holds balls about their places and cones about their normals; what lies in a ball
can only have half-vectors in a cone of its own, so that most of the mesh is left out at once, as in Walter and others,
"Single Scattering in Refractive Media with Triangle Mesh Boundaries" (2009), section 4. Triangles that are left are
divided until their cones are narrow, and each part starts a Newton search.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .half_vectors import HalfVectors, all_weights, towards
from .mesh_rays import halved
from .radial_surfaces import Float64Array, unit

LEAF = 2
"""Triangles of a leaf, at most"""
ROWS = 8192
"""Points that are searched for at a time"""
NARROW = 0.2
"""Radians of the half-vectors and of the normals of what starts a search"""
MOST_HALVINGS = 8
STEPS = 16
FOUND = 1e-11
"""Half-vector less normal, across the triangle"""
EDGE = 1e-9
"""Barycentric slack, so that no point is lost between two triangles"""
SAME = 1e-7
"""Of the mesh's size: two ends nearer than this are one"""


@dataclass(frozen=True)
class MeshReflections:
    """The k reflection points of n scene points, by scene point."""

    row: NDArray[np.int64]
    """(k,) number of the scene point, ascending"""
    triangle: NDArray[np.int64]
    """(k,) that holds the reflection point"""
    point: Float64Array
    """(k, 3)"""
    normal: Float64Array
    """(k, 3) unit shading normal, towards eye and scene point"""


class ReflectingMesh:
    """A mesh that is asked for reflection points; both of its sides reflect."""

    def __init__(self, positions: Float64Array, normals: Float64Array, triangles: NDArray[np.integer]) -> None:
        """Corners (k, 3), their shading normals (k, 3), of any length, and triangles (t, 3) of corners, t > 0."""
        self._halves = HalfVectors(positions, normals, triangles)
        self._corners, self._normals = self._halves.corners, self._halves.normals
        self.size = float(np.linalg.norm(np.ptp(self._corners.reshape(-1, 3), axis=0)))
        groups = halved(self._corners.mean(axis=1), LEAF)
        self._leaves = np.full((len(groups), LEAF), -1)
        for number, group in enumerate(groups):
            self._leaves[number, : len(group)] = group
        self._first_leaf = len(groups) - 1
        self._center, self._radius, self._axis, self._spread = self._bounds(groups)

    def points(self, eye: Float64Array, shown: Float64Array) -> MeshReflections:
        """All of scene points (n, 4) for the eye (4,), both homogeneous: what is infinitely far away has a last number
        of 0. Whether ways are free is not asked."""
        found = [self._points(eye, shown[first : first + ROWS], first) for first in range(0, max(len(shown), 1), ROWS)]
        return MeshReflections(
            *(
                np.concatenate([getattr(part, name) for part in found])
                for name in ("row", "triangle", "point", "normal")
            )
        )

    def _points(self, eye: Float64Array, shown: Float64Array, first: int) -> MeshReflections:
        row, node = np.arange(len(shown)), np.zeros(len(shown), np.int64)
        while len(row) and node[0] < self._first_leaf:
            bounds = (self._center[node], self._radius[node], self._axis[node], self._spread[node])
            may = _may_reflect(eye, shown[row], *bounds)[0]
            row, node = row[may], node[may]
            row, node = np.repeat(row, 2), np.repeat(2 * node + 1, 2)
            node[1::2] += 1
        chosen = self._leaves[node - self._first_leaf]
        row, triangle = np.repeat(row, LEAF)[chosen.ravel() >= 0], chosen.ravel()[chosen.ravel() >= 0]
        row, triangle, start = self._starts(eye, shown, row, triangle)
        row, triangle, weights = self._polished(eye, shown, row, triangle, start)
        point, normal, _, sign = self._halves.at(eye, shown[row], triangle, weights)
        order = np.lexsort((point[:, 0], row))
        row, triangle, point = row[order], triangle[order], point[order]
        kept = _first_of_each(row, point, SAME * self.size)
        normal = (sign[:, None] * normal)[order]
        return MeshReflections(row[kept] + first, triangle[kept], point[kept], normal[kept])

    def _starts(
        self, eye: Float64Array, shown: Float64Array, row: NDArray[np.int64], triangle: NDArray[np.int64]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], Float64Array]:
        """Scene points, triangles and weights (m, 3) to search from: the middles of parts that are narrow."""
        part = np.broadcast_to(np.eye(3), (len(row), 3, 3))
        rows, triangles, starts = [row[:0]], [triangle[:0]], [np.zeros((0, 3))]
        for halving in range(MOST_HALVINGS + 1):
            places = part @ self._corners[triangle]
            normals = unit((part @ self._normals[triangle]).reshape(-1, 3)).reshape(-1, 3, 3)
            bounds = (*_balls(places), *_cones(normals))
            may, width = _may_reflect(eye, shown[row], *bounds)
            ends = may & ((np.maximum(width, bounds[3]) < NARROW) | (halving == MOST_HALVINGS))
            rows.append(row[ends])
            triangles.append(triangle[ends])
            starts.append(part[ends].mean(axis=1))
            goes_on = may & ~ends
            row, triangle, part = np.repeat(row[goes_on], 4), np.repeat(triangle[goes_on], 4), _quarters(part[goes_on])
            if len(row) == 0:
                break
        return np.concatenate(rows), np.concatenate(triangles), np.concatenate(starts)

    def _polished(
        self,
        eye: Float64Array,
        shown: Float64Array,
        row: NDArray[np.int64],
        triangle: NDArray[np.int64],
        start: Float64Array,
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], Float64Array]:
        """Newton on the half-vector less the normal, in the weights; what ends within the triangle."""
        done: list[tuple[NDArray[np.int64], NDArray[np.int64], Float64Array]] = []
        place = start[:, 1:].copy()
        for _ in range(STEPS):
            if len(row) == 0:
                break
            miss = self._halves.miss(eye, shown[row], triangle, place)
            ends = np.linalg.norm(miss, axis=1) < FOUND
            if ends.any():
                done.append((row[ends], triangle[ends], place[ends]))
                row, triangle, place, miss = row[~ends], triangle[~ends], place[~ends], miss[~ends]
            place = place + self._halves.step(eye, shown[row], triangle, place, miss)
            # Parts are small beside their cones: a search that leaves the triangle by its own size is another's.
            inside = (place > -1.0).all(axis=1) & (place.sum(axis=1) < 2.0)
            row, triangle, place = row[inside], triangle[inside], place[inside]
        if not done:
            return row[:0], triangle[:0], np.zeros((0, 3))
        row, triangle, place = (np.concatenate(parts) for parts in zip(*done, strict=True))
        weights = all_weights(place)
        within = (weights >= -EDGE).all(axis=1)
        return row[within], triangle[within], weights[within]

    def _bounds(self, groups: list[NDArray[np.int64]]) -> tuple[Float64Array, Float64Array, Float64Array, Float64Array]:
        """Centers, radii, axes and half angles of all nodes, the root first, leaves last."""
        count = self._first_leaf + len(groups)
        center, axis = np.zeros((count, 3)), np.zeros((count, 3))
        radius, spread = np.full(count, -1.0), np.full(count, np.pi)
        normals = unit(self._normals.reshape(-1, 3)).reshape(-1, 3, 3)
        level: list[NDArray[np.int64]] = groups
        first = self._first_leaf
        while True:
            for number, group in enumerate(level, first):
                if len(group) == 0:
                    continue
                places, facing = self._corners[group].reshape(1, -1, 3), normals[group].reshape(1, -1, 3)
                center[number : number + 1], radius[number : number + 1] = _balls(places)
                axis[number : number + 1], spread[number : number + 1] = _cones(facing)
            if first == 0:
                return center, radius, axis, spread
            level = [np.concatenate(level[at : at + 2]) for at in range(0, len(level), 2)]
            first = (first - 1) // 2


def _may_reflect(
    eye: Float64Array,
    shown: Float64Array,
    center: Float64Array,
    radius: Float64Array,
    axis: Float64Array,
    spread: Float64Array,
) -> tuple[NDArray[np.bool_], Float64Array]:
    """(m,) whether a half-vector in each of these balls may be a normal in the cone, on either side, and how far
    half-vectors differ from that at the center, radians."""
    to_eye, eye_distance = towards(eye, center)
    to_shown, shown_distance = towards(shown, center)
    half = to_eye + to_shown
    length = np.linalg.norm(half, axis=1)
    lean = _chord(radius, eye_distance, eye[3]) + _chord(radius, shown_distance, shown[:, 3])
    width = np.where(lean < length, np.arcsin(np.minimum(lean / np.maximum(length, 1e-300), 1.0)), np.pi)
    cosine = np.abs(np.einsum("mj,mj->m", axis, half)) / np.maximum(length, 1e-300)
    may = np.arccos(np.minimum(cosine, 1.0)) <= np.minimum(spread + width, np.pi) + 1e-9
    return (may | (width >= 0.5 * np.pi) | (spread >= 0.5 * np.pi)) & (radius >= 0.0), width


def _chord(radius: Float64Array, distance: Float64Array, w: Float64Array | float) -> Float64Array:
    """Largest difference of unit directions to a point from places in balls so far from it; 0 where it is infinitely
    far away."""
    sine = np.minimum(radius / np.maximum(distance, 1e-300), 1.0)
    # (2 sin(a / 2) of the angle a; inside of the ball it may be anything.)
    return np.where(np.asarray(w) == 0.0, 0.0, np.where(sine < 1.0, np.sqrt(2.0 - 2.0 * np.sqrt(1.0 - sine**2)), 2.0))


def _balls(places: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Centers (m, 3) and radii (m,) of balls that hold places (m, k, 3)."""
    center = 0.5 * (places.min(axis=1) + places.max(axis=1))
    return center, np.linalg.norm(places - center[:, None], axis=2).max(axis=1)


def _cones(normals: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Unit axes (m, 3) and half angles (m,) of cones that hold unit directions (m, k, 3), and what is between them."""
    total = normals.sum(axis=1)
    length = np.linalg.norm(total, axis=1)
    axis = total / np.maximum(length, 1e-300)[:, None]
    least = np.einsum("mkj,mj->mk", normals, axis).min(axis=1)
    return axis, np.where((length > 1e-9) & (least > 0.0), np.arccos(np.clip(least, -1.0, 1.0)), np.pi)


def _quarters(part: Float64Array) -> Float64Array:
    """Weights (4 m, 3, 3) of the corners of the quarters of parts (m, 3, 3)."""
    a, b, c = part[:, 0], part[:, 1], part[:, 2]
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    quarters = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.stack([np.stack(corners, axis=1) for corners in quarters], axis=1).reshape(-1, 3, 3)


def _first_of_each(row: NDArray[np.int64], point: Float64Array, reach: float) -> NDArray[np.bool_]:
    """(k,) which of the points, sorted by row and x, is not within `reach` of one before it in its row."""
    kept = np.ones(len(row), bool)
    for back in range(1, len(row)):
        other = slice(0, len(row) - back)
        close = (row[back:] == row[other]) & (np.abs(point[back:, 0] - point[other, 0]) <= reach)
        if not close.any():
            break
        kept[back:] &= ~(close & (np.linalg.norm(point[back:] - point[other], axis=1) <= reach))
    return kept
