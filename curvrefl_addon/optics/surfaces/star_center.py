# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Finding a point from which a triangle mesh is star-shaped, or as nearly so as it gets.

A mesh is star-shaped about c when every triangle turns its outside away from c: n . (x - c) > 0. Those c form the
mesh's kernel, a convex polytope that may be empty. Candidates are tried and then moved towards the kernel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .radial_surfaces import Float64Array

MAX_TRIANGLES = 20_000
"""Of larger meshes an evenly spread subset of about so many triangles is looked at to choose the center."""


@dataclass(frozen=True, slots=True)
class StarCenter:
    """A point and how well it sees the mesh."""

    name: str
    """Which candidate it is"""
    position: Float64Array
    """(3,)"""
    misfit: float
    """|solid angle of the triangles that face away from the center / 4 pi - 1|: what directions leave the mesh more
    than once, or never, add up to; 0 for a closed star-shaped mesh"""
    worst_cosine: float
    """Least cosine between a triangle's normal and the direction to it; at most 0 when the mesh is not star-shaped"""


def find_star_center(corners: Float64Array, origin: Float64Array) -> StarCenter:
    """Best center for triangles (n, 3, 3) that are wound alike; `origin` (3,) is the first candidate.

    Triangles without area do not matter. Everything is relative to the mesh's size.
    """
    centroids = _centroids(corners)
    # Column by column: reducing many short rows is many times slower.
    low = np.array([corners[..., axis].min() for axis in range(3)])
    high = np.array([corners[..., axis].max() for axis in range(3)])
    size = float(np.linalg.norm(high - low))
    normals = _normals(corners)
    doubled_areas = _lengths(normals)
    # Six times the volumes between the triangles and `low`.
    signed_volumes = np.einsum("ij,ij->i", normals, corners[:, 0] - low)
    candidates = [
        ("origin", origin),
        ("middle of the box", 0.5 * (low + high)),
        ("triangle mean", np.array([centroids[:, axis].mean() for axis in range(3)])),
    ]
    total_area = float(doubled_areas.sum())
    if total_area > 0.0:
        candidates.append(("area centroid", doubled_areas @ centroids / total_area))
    volume = signed_volumes.sum()
    # A flat or open mesh has a volume near 0 and then a centroid anywhere.
    if abs(volume) > 6e-3 * size**3:
        centroid = low + signed_volumes @ (0.75 * (centroids - low)) / volume
        candidates.append(("volume centroid", centroid))

    if volume < 0.0:
        corners = corners[:, ::-1]
    stride = -(-len(corners) // MAX_TRIANGLES)
    planes = _Planes(corners[::stride], size, total_area)
    tried = [planes.judge(name, np.asarray(position, np.float64)) for name, position in candidates]
    best = min(tried, key=_rank)
    moved = planes.judge("moved into the kernel", planes.towards_kernel(best.position))
    return min(best, moved, key=_rank)


def _rank(center: StarCenter) -> tuple[int, float]:
    # Less than half a percent of the sphere is below what the subset of a large mesh can tell.
    return round(center.misfit * 200.0), -center.worst_cosine


def _normals(corners: Float64Array) -> Float64Array:
    """Normals (n, 3) of triangles, as long as twice their areas."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def _centroids(corners: Float64Array) -> Float64Array:
    return (corners[:, 0] + corners[:, 1] + corners[:, 2]) / 3.0


def _lengths(vectors: Float64Array) -> Float64Array:
    return np.sqrt(np.einsum("ij,ij->i", vectors, vectors))


class _Planes:
    """The half-spaces n . (x - c) >= 0 of a mesh, seen from points c."""

    def __init__(self, corners: Float64Array, size: float, total_area: float) -> None:
        normals = _normals(corners)
        doubled_areas = _lengths(normals)
        # Slivers have normals of rounding noise.
        kept = doubled_areas > 1e-9 * size**2 / max(len(corners), 1)
        self.corners = corners[kept]
        self.centroids = _centroids(self.corners)
        self.size = size
        self.share = float(doubled_areas.sum() / total_area) if total_area > 0.0 else 1.0
        self.normals = normals[kept] / doubled_areas[kept, None]
        self.offsets = np.einsum("ij,ij->i", self.normals, self.corners[:, 0])

    def judge(self, name: str, center: Float64Array) -> StarCenter:
        angles = solid_angles(self.corners - center)
        seen = float(angles[angles > 0.0].sum()) / (4.0 * np.pi * self.share)
        to_triangles = self.centroids - center
        heights = np.einsum("ij,ij->i", self.normals, to_triangles)
        cosines = heights / np.maximum(_lengths(to_triangles), 1e-30 * self.size)
        return StarCenter(name, center, abs(seen - 1.0), float(cosines.min(initial=1.0)))

    def towards_kernel(self, start: Float64Array, steps: int = 200) -> Float64Array:
        """Point found by Agmon's relaxation: stepwise onto the half-space that is violated most.

        The half-spaces are pushed in by a margin that grows while a point inside all of them is found and shrinks
        when none is, so that the result lies deep in the kernel. (S. Agmon, The relaxation method for linear
        inequalities, Canadian Journal of Mathematics 6, 1954.)
        """
        best, best_slack = start, float((self.offsets - self.normals @ start).min(initial=np.inf))
        margin = max(best_slack, 0.0) + 0.05 * self.size
        point = start.copy()
        for _ in range(steps):
            slack = self.offsets - self.normals @ point
            worst = int(slack.argmin())
            if slack[worst] > best_slack:
                best, best_slack = point.copy(), float(slack[worst])
            if slack[worst] >= margin:
                margin *= 1.5
                continue
            point -= 1.1 * (margin - slack[worst]) * self.normals[worst]
            margin = max(best_slack, 0.0) + 0.99 * (margin - max(best_slack, 0.0))
        return best


def solid_angles(corners: Float64Array) -> Float64Array:
    """Solid angles (n,) of triangles (n, 3, 3) seen from the origin; positive when they turn their back to it.

    A. van Oosterom, J. Strackee, The solid angle of a plane triangle, IEEE Trans. Biomedical Engineering 30, 1983.
    """
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    la, lb, lc = _lengths(a), _lengths(b), _lengths(c)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    denominator = (
        la * lb * lc
        + np.einsum("ij,ij->i", a, b) * lc
        + np.einsum("ij,ij->i", a, c) * lb
        + np.einsum("ij,ij->i", b, c) * la
    )
    return 2.0 * np.arctan2(volume, denominator)
