# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the frame before shows in its mirrors what this one shows, by geometry alone; and how far what a method shows
is from where the mirror truly shows it, in pixels.

What rays find at pixels' centers is carried to the frame before on its own triangle, and its image is searched there in
float64 (`optics.surfaces.mesh_images`). Pixels at which rays and Cycles do not find the same are left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...renderer.truth.motion import is_same, same_instances, shown_then
from ...renderer.truth.shown_points import NOTHING, ShownPoints
from ...renderer.truth.world_mesh import WorldMesh, world_mesh
from ...report.geometry_reference import GeometryReference
from ...report.metrics import direction_angle_deg
from ...scene.arrays import Float32Array, Float64Array, Int32Array, SceneArrays
from ...scene.camera.view import View

SAME_ANGLE = 0.5
"""Degrees, as seen from the mirror, by which rays may be off Cycles"""


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """Of one frame to the one before. Row 0 is at the bottom."""

    place: Float64Array
    """(h, w, 2) where the frame before shows the same scene point, less the pixel's own place, pixels to the right and
    up; NaN where that is not known, and beside the mirrors"""
    distance: Float64Array
    """(h, w) from the mirror to that point then; infinite: the background. NaN as `place`"""


def motion_before(
    scene: SceneArrays,
    points: ShownPoints,
    truth: GeometryReference,
    then: SceneArrays,
    view: View,
    pause: Callable[[], None] = lambda: None,
) -> Motion:
    """From a frame, of which rays have found `points` and Cycles `truth`, to another state of the scene, that `view`
    sees.

    Not known: what is not there then or is another mesh, what its mirror shows no image of, and where rays and Cycles
    differ. Whether something hides the image is not asked. `pause` is called between slices of the work.
    """
    size = points.view.height, points.view.width
    place, distance = np.full((size[0] * size[1], 2), np.nan), np.full(size[0] * size[1], np.nan)
    index = same_instances(scene, then)
    shown, known = shown_then(scene, points, then, index)
    known &= _as_in_cycles(scene, points, truth)
    center = points.view.pixel_centers[points.pixel]
    for mirror in np.unique(points.mirror).tolist():
        other = int(index[mirror])
        here = np.flatnonzero((points.mirror == mirror) & known)
        if other == NOTHING or len(here) == 0:
            continue
        # (Where it would be seen if mirror and image were one body.)
        moved = then.instances[other].matrix @ np.linalg.inv(scene.instances[mirror].matrix)
        seen = points.seen[here] @ moved[:3, :3].T + moved[:3, 3]
        rests = is_same(scene, mirror, then, other) and np.array_equal(view.world_to_clip, points.view.world_to_clip)
        still = rests & (shown[here] == points.shown[here]).all(axis=1)
        found = still.copy()
        there = np.where(still[:, None], center[here], view.project(seen))
        rows = np.flatnonzero(~still)
        if len(rows):
            mesh = world_mesh(then, [other])
            there[rows], seen[rows], found[rows] = _images(mesh, view, shown[here[rows]], there[rows], pause)
        rows = here[found]
        place[points.pixel[rows]] = there[found] - center[rows]
        far = np.linalg.norm(shown[rows, :3] - seen[found], axis=1)
        distance[points.pixel[rows]] = np.where(points.is_surface[rows], far, np.inf)
    return Motion(place.reshape(*size, 2), distance.reshape(size))


def offsets(
    scene: SceneArrays,
    points: ShownPoints,
    mask: Int32Array,
    position: Float32Array,
    pause: Callable[[], None] = lambda: None,
) -> Float64Array:
    """(h, w, 2) pixels to the right and up from each pixel to where the mirror truly shows what a method shows there:
    `position` (h, w, 4), on mirrors `mask` (h, w). NaN where rays find another mirror, and where the mirror has no such
    image nearby. `pause`: as for `motion_before`."""
    view = points.view
    found = np.full((view.height * view.width, 2), np.nan)
    numbers = np.array([item.object_id for item in scene.instances])
    known = mask.ravel()[points.pixel] == numbers[points.mirror]
    center = view.pixel_centers
    for mirror in np.unique(points.mirror[known]).tolist():
        pixel = points.pixel[known & (points.mirror == mirror)]
        targets = position.reshape(-1, 4)[pixel].astype(np.float64)
        place, _, is_found = _images(world_mesh(scene, [mirror]), view, targets, center[pixel], pause)
        found[pixel[is_found]] = (place - center[pixel])[is_found]
    return found.reshape(view.height, view.width, 2)


def _images(
    mesh: WorldMesh, view: View, shown: Float64Array, start: Float64Array, pause: Callable[[], None]
) -> tuple[Float64Array, Float64Array, NDArray[np.bool_]]:
    return mesh.images.places(view.eye, view.lines_of_sight, view.project, view.height, shown, start, pause)


def _as_in_cycles(scene: SceneArrays, points: ShownPoints, truth: GeometryReference) -> NDArray[np.bool_]:
    """(n,) whether Cycles sees the same mirror there and in it the same object, in the same direction."""
    numbers = np.array([0, *(item.object_id for item in scene.instances)])
    same = truth.valid.ravel()[points.pixel]
    same &= truth.mask.ravel()[points.pixel] == numbers[points.mirror + 1]
    same &= truth.reflected_object.ravel()[points.pixel] == numbers[points.instance + 1]
    there = truth.reflected_position.reshape(-1, 4)[points.pixel].astype(np.float64)
    return same & (direction_angle_deg(points.seen, points.shown, there) < SAME_ANGLE)
