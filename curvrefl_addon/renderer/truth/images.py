# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How many images of a scene point the mirrors show at once, by all their reflection points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...optics.surfaces.mesh_reflections import ROWS
from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import Float64Array, SceneArrays
from .shown_points import ShownPoints
from .world_mesh import WorldMesh, world_mesh

OWN_RANGE = 1e-4
"""Nearer to a mirror's point than this share of its size nothing hides it, as for rays that leave mirrors"""
BEFORE_END = 1e-6
"""Share of a way: what is met nearer to its end is what it ends on"""


def image_counts(scene: SceneArrays, points: ShownPoints, pause: Callable[[], None]) -> NDArray[np.int64]:
    """(n,) images, by one mirror each, of what each pixel shows, 0 for the background; at least the one seen there.

    An image is a reflection point on the mesh of any mirror with a free way to the eye and to the scene point, whether
    or not the picture's frame holds it. `pause` is called between slices of the work; what it raises ends it.
    """
    counts = np.zeros(len(points.pixel), np.int64)
    asked = np.flatnonzero(points.is_surface)
    if len(asked) == 0:
        return counts
    mirrors = [index for index, item in enumerate(scene.instances) if item.object_id in scene.reflectors]
    meshes = [world_mesh(scene, [index]) for index in mirrors]
    before_eye = world_mesh(scene, [i for i, item in enumerate(scene.instances) if item.visible_camera])
    before_mirror = world_mesh(scene, [i for i, item in enumerate(scene.instances) if item.visible_glossy])
    for first in range(0, len(asked), ROWS):
        some = asked[first : first + ROWS]
        shown = points.shown[some]
        for mesh in meshes:
            pause()
            found = mesh.mirror.points(points.view.eye, shown)
            reach = OWN_RANGE * mesh.size
            free = is_free(before_eye, found.point, np.broadcast_to(points.view.eye, (len(found.row), 4)), reach)
            free[free] = is_free(before_mirror, found.point[free], shown[found.row[free]], reach)
            counts[some] += np.bincount(found.row[free], minlength=len(some))
    counts[asked] = np.maximum(counts[asked], 1)
    return counts


def is_free(mesh: WorldMesh, start: Float64Array, end: Float64Array, reach: float) -> NDArray[np.bool_]:
    """(n,) whether nothing is met between points (n, 3) and homogeneous ends (n, 4), farther than `reach` from the
    start."""
    if len(start) == 0:
        return np.zeros(0, bool)
    way = end[:, :3] - end[:, 3:] * start
    distance = np.where(end[:, 3] > 0.0, np.linalg.norm(way, axis=1), np.inf)
    met = mesh.rays.first_hits(start, unit(way), reach).distance
    return met >= np.where(np.isfinite(distance), distance * (1.0 - BEFORE_END), np.inf)
