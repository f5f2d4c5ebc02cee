# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature of a smooth surface at the vertices of a mesh, from positions and normals.

The shape operator S of a surface with unit normal n tells how n turns along a tangent t: dn = S t. Its eigenvalues are
the principal curvatures, positive where the surface bends away from n: a ball of radius r has 1 / r both ways. Here S
is a symmetric 3 x 3 *curvature tensor* of space with S n = 0, so that it needs no axes in the tangent plane and may be
interpolated between vertices. Its six numbers are in the order xx, yy, zz, xy, xz, yz.

Szymon Rusinkiewicz, "Estimating Curvatures and Their Derivatives on Triangle Meshes", 3DPVT 2004, sections 3.1 to 3.3;
the areas of corners are those of Meyer, Desbrun, Schröder and Barr, "Discrete Differential-Geometry Operators for
Triangulated 2-Manifolds", 2003, section 3.3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

type Float64Array = NDArray[np.float64]

SLIVER = 1e-7
"""A triangle whose height is less than this share of its longest edge has no plane"""
SUMMED = 1 << 15
"""Triangles at a time"""


class CurvatureSum:
    """Of the triangles of a mesh, a few at a time: `add_some` until `is_complete`."""

    def __init__(self, positions: Float64Array, normals: Float64Array, triangles: NDArray[np.integer]) -> None:
        """Vertices (n, 3) with unit normals (n, 3), in axes of equal scale; triangles (m, 3) of them."""
        self._positions, self._normals, self._triangles = positions, normals, triangles
        self._sums = np.zeros((7, len(positions)))
        """The weighted tensors' numbers, and the weights"""
        self._done = 0

    @property
    def is_complete(self) -> bool:
        """No triangle is left."""
        return self._done >= len(self._triangles)

    def add_some(self, count: int = SUMMED) -> None:
        """The next triangles."""
        triangles = self._triangles[self._done : self._done + count]
        self._done += len(triangles)
        edges, tensors, areas, kept = _of_triangles(self._positions, self._normals, triangles)
        vertices = triangles[kept].reshape(-1)
        turned = _turned(edges, tensors, self._normals[vertices].reshape(-1, 3, 3))
        weighted = areas[..., None] * turned
        for k in range(6):
            self._sums[k] += np.bincount(vertices, weighted[..., k].reshape(-1), len(self._positions))
        self._sums[6] += np.bincount(vertices, areas.reshape(-1), len(self._positions))

    def tensors(self) -> Float64Array:
        """(n, 6) curvature tensors, 1 / length; zero at vertices without a triangle that has a plane."""
        weights = self._sums[6]
        return (self._sums[:6] / np.where(weights > 0.0, weights, 1.0)).T


def curvature_tensors(positions: Float64Array, normals: Float64Array, triangles: NDArray[np.integer]) -> Float64Array:
    """(n, 6) curvature tensors at vertices (n, 3) with unit normals (n, 3) of triangles (m, 3)."""
    found = CurvatureSum(positions, normals, triangles)
    while not found.is_complete:
        found.add_some()
    return found.tensors()


type _Frames = tuple[Float64Array, Float64Array, Float64Array]
"""(m, 3) each: two axes in a triangle's plane, and its normal"""


def _of_triangles(
    positions: Float64Array, normals: Float64Array, triangles: NDArray[np.integer]
) -> tuple[_Frames, Float64Array, Float64Array, NDArray[np.bool_]]:
    """Frames, tensors (m, 3) as uu, uv, vv in them, areas of corners (m, 3), and which triangles (all,) have a plane.

    Along each edge e the normal turns by dn: (e . u, e . v) S = (dn . u, dn . v), by least squares over the edges.
    """
    corners = positions[triangles]
    edges = corners[:, (2, 0, 1)] - corners[:, (1, 2, 0)]
    squared = (edges**2).sum(-1)
    across = np.cross(edges[:, 0], edges[:, 1])
    double_area = np.linalg.norm(across, axis=1)
    kept = double_area > SLIVER * squared.max(axis=1)
    edges, squared, across, double_area = edges[kept], squared[kept], across[kept], double_area[kept]
    of_corners = normals[triangles[kept]]
    turns = of_corners[:, (2, 0, 1)] - of_corners[:, (1, 2, 0)]
    w = across / double_area[:, None]
    u = edges[:, 0] / np.sqrt(squared[:, :1])
    v = np.cross(w, u)
    a, b = (np.einsum("mki,mi->mk", edges, axis) for axis in (u, v))
    c, d = (np.einsum("mki,mi->mk", turns, axis) for axis in (u, v))
    # (As lengths of the edge that has the first axis: the system is then as well posed however large the mesh is.)
    scale = np.sqrt(squared[:, :1])
    a, b = a / scale, b / scale
    aa, ab, bb, zero = (a * a).sum(1), (a * b).sum(1), (b * b).sum(1), np.zeros(len(a))
    system = np.array([[aa, ab, zero], [ab, aa + bb, ab], [zero, ab, bb]]).transpose(2, 0, 1)
    right = np.stack([(a * c).sum(1), (a * d + b * c).sum(1), (b * d).sum(1)], axis=1)
    tensors = np.linalg.solve(system, right[..., None])[..., 0] / scale
    return (u, v, w), tensors, _corner_areas(squared, 0.5 * double_area), kept


def _corner_areas(squared: Float64Array, area: Float64Array) -> Float64Array:
    """(m, 3) which part of each triangle is nearer to which corner: `squared` (m, 3) lengths of the edges opposite.

    Voronoi's where no angle is obtuse, else half for the obtuse corner and a quarter for each of the others.
    """
    total = squared.sum(axis=1, keepdims=True)
    opposite = total - 2.0 * squared
    """Twice the product of the sides at a corner and its angle's cosine"""
    cotangent = opposite / (4.0 * area[:, None])
    shares = squared * cotangent / 8.0
    voronoi = shares[:, (1, 2, 0)] + shares[:, (2, 0, 1)]
    obtuse = opposite < 0.0
    halves = area[:, None] * np.where(obtuse, 0.5, 0.25)
    return np.where(obtuse.any(axis=1, keepdims=True), halves, voronoi)


def _turned(frames: _Frames, tensors: Float64Array, normals: Float64Array) -> Float64Array:
    """(m, 3, 6) triangles' tensors in the tangent planes of their corners, whose unit normals are (m, 3, 3).

    By the shortest turn of the triangle's plane: the normal's side of it is that of the corner.
    """
    u, v, w = frames
    facing = np.einsum("mki,mi->mk", normals, w)
    w = np.where(facing[..., None] < 0.0, -1.0, 1.0) * w[:, None]
    halfway = (w + normals) / (1.0 + np.abs(facing))[..., None]
    axes = [axis[:, None] - np.einsum("mki,mi->mk", normals, axis)[..., None] * halfway for axis in (u, v)]
    (ux, uy, uz), (vx, vy, vz) = (np.moveaxis(axis, -1, 0) for axis in axes)
    uu, uv, vv = (tensors[:, k, None] for k in range(3))

    def entry(u1: Float64Array, v1: Float64Array, u2: Float64Array, v2: Float64Array) -> Float64Array:
        return uu * u1 * u2 + uv * (u1 * v2 + v1 * u2) + vv * v1 * v2

    return np.stack(
        [
            *(entry(ux, vx, ux, vx), entry(uy, vy, uy, vy), entry(uz, vz, uz, vz)),
            *(entry(ux, vx, uy, vy), entry(ux, vx, uz, vz), entry(uy, vy, uz, vz)),
        ],
        axis=-1,
    )


@dataclass(frozen=True, slots=True)
class Principal:
    """Principal curvatures at n points."""

    largest: Float64Array
    """(n,) 1 / length, signed"""
    smallest: Float64Array
    """(n,)"""
    direction: Float64Array
    """(n, 3) unit tangents along which it is largest; any tangent where both are the same"""

    @property
    def gaussian(self) -> Float64Array:
        """(n,) their product, 1 / area."""
        return self.largest * self.smallest

    @property
    def mean(self) -> Float64Array:
        """(n,) half of their sum."""
        return 0.5 * (self.largest + self.smallest)

    @property
    def strongest(self) -> Float64Array:
        """(n,) the absolute value of that which has the larger one."""
        return np.maximum(np.abs(self.largest), np.abs(self.smallest))


def principal_curvatures(tensors: Float64Array, normals: Float64Array) -> Principal:
    """Of curvature tensors (n, 6) at points with unit normals (n, 3)."""
    first, second = tangent_axes(normals)
    along_first, along_second = applied(tensors, first), applied(tensors, second)
    a, b, c = _dot(along_first, first), _dot(along_first, second), _dot(along_second, second)
    mean, spread = 0.5 * (a + c), np.hypot(0.5 * (a - c), b)
    angle = 0.5 * np.arctan2(b, 0.5 * (a - c))
    direction = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * second
    return Principal(mean + spread, mean - spread, direction)


def normal_curvature(tensors: Float64Array, tangents: Float64Array) -> Float64Array:
    """(n,) curvature along unit tangents (n, 3), 1 / length: t . S t."""
    return _dot(applied(tensors, tangents), tangents)


def applied(tensors: Float64Array, vectors: Float64Array) -> Float64Array:
    """(n, 3) S x for tensors (n, 6) and vectors x (n, 3)."""
    xx, yy, zz, xy, xz, yz = tensors.T
    x, y, z = vectors.T
    return np.column_stack([xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z])


def tangent_axes(normals: Float64Array) -> tuple[Float64Array, Float64Array]:
    """(n, 3) each: two unit vectors across unit normals (n, 3) and each other.

    Duff and others, "Building an Orthonormal Basis, Revisited", JCGT 6 (1), 2017.
    """
    x, y, z = normals.T
    sign = np.where(z < 0.0, -1.0, 1.0)
    a = -1.0 / (sign + z)
    b = x * y * a
    first = np.column_stack([1.0 + sign * x * x * a, sign * b, -sign * x])
    return first, np.column_stack([b, sign + y * y * a, -y])


def _dot(one: Float64Array, other: Float64Array) -> Float64Array:
    return np.einsum("ni,ni->n", one, other)
