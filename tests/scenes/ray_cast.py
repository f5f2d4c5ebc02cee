# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every ray against every triangle of a scene, in float64: what `exact` is held to. No hierarchy, no shortcut."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Float64Array
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from numpy.typing import NDArray

_RAYS_AT_ONCE = 2048


@dataclass(frozen=True, slots=True)
class Triangles:
    """All triangles of a scene, world space."""

    corners: Float64Array
    """(n, 3, 3)"""
    instance: NDArray[np.int64]
    """(n,) index into the scene's instances"""


def world_triangles(scene: SceneArrays) -> Triangles:
    """Those that mirrors can see."""
    corners, owners = [], []
    for index, instance in enumerate(scene.instances):
        mesh = scene.meshes[instance.mesh]
        if instance.visible_glossy:
            places = mesh.positions[mesh.corner_vertex[mesh.triangles]].astype(np.float64)
            corners.append(places @ instance.matrix[:3, :3].T + instance.matrix[:3, 3])
            owners.append(np.full(len(places), index))
    return Triangles(np.concatenate(corners), np.concatenate(owners))


@dataclass(frozen=True, slots=True)
class FirstHits:
    """What rays meet first."""

    triangle: NDArray[np.int64]
    """(rays,) -1: nothing"""
    distance: Float64Array
    """(rays,) infinite where nothing is met"""
    second: Float64Array
    """(rays,) distance of the next triangle behind"""
    is_at_edge: NDArray[np.bool_]
    """(rays,) passes an edge of a triangle, no farther than the first hit, so closely that rounding decides"""


def first_hits(
    triangles: Triangles,
    origins: Float64Array,
    directions: Float64Array,
    own: int = -1,
    own_range: float = 0.0,
    own_sides: float = 0.0,
    edge: float = 1e-6,
) -> FirstHits:
    """Cast rays (n, 3), directions of unit length.

    Triangles of the instance `own` count farther than `own_range` meters, and with `own_sides` 1 only where their
    winding faces the ray. `edge`: share of a triangle's size that counts as its edge.
    """
    a, b, c = triangles.corners[:, 0], triangles.corners[:, 1], triangles.corners[:, 2]
    normal = np.cross(b - a, c - a)
    # Plücker coordinates: a ray passes an edge on the side of the sign of d . (p x q) + m . (q - p), m = o x d.
    edges = [np.concatenate([np.cross(p, q), q - p], axis=1) for p, q in ((a, b), (b, c), (c, a))]
    nearest = np.where(triangles.instance == own, own_range, 0.0)
    is_own = triangles.instance == own
    results: list[tuple[np.ndarray, ...]] = []
    for start in range(0, len(origins), _RAYS_AT_ONCE):
        o, d = origins[start : start + _RAYS_AT_ONCE], directions[start : start + _RAYS_AT_ONCE]
        ray = np.concatenate([d, np.cross(o, d)], axis=1)
        sides = [ray @ line.T for line in edges]
        facing = d @ normal.T
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = ((a * normal).sum(axis=1) - o @ normal.T) / facing
        total = sides[0] + sides[1] + sides[2]
        margin = np.abs(total) * edge
        low = np.minimum(np.minimum(sides[0], sides[1]), sides[2])
        high = np.maximum(np.maximum(sides[0], sides[1]), sides[2])
        counts = (distance > nearest) & ~(is_own & (own_sides * facing > 0.0))
        inside = ((low >= 0.0) | (high <= 0.0)) & counts
        around = ((low >= -margin) | (high <= margin)) & counts
        met = np.where(inside, distance, np.inf)
        first = met.argmin(axis=1)
        rows = np.arange(len(o))
        nearest_met = met[rows, first]
        met[rows, first] = np.inf
        within = ((low >= margin) | (high <= -margin)) & counts
        at_edge = (around & ~within & (distance <= nearest_met[:, None] * (1.0 + 1e-6))).any(axis=1)
        results.append((np.where(np.isfinite(nearest_met), first, -1), nearest_met, met.min(axis=1), at_edge))
    return FirstHits(*(np.concatenate(parts) for parts in zip(*results, strict=True)))
