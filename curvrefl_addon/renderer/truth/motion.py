# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where in another frame's picture a mirror shows the same scene point: by solving for its reflection point there."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...optics.surfaces.mesh_reflections import ROWS
from ...scene.arrays import Float64Array, SceneArrays
from ...scene.camera.view import View
from .shown_points import NOTHING, ShownPoints, places_on
from .world_mesh import world_mesh


def places_then(
    scene: SceneArrays, points: ShownPoints, then: SceneArrays, view: View, pause: Callable[[], None]
) -> tuple[Float64Array, NDArray[np.bool_]]:
    """Pixel coordinates (n, 2), origin bottom left, where the mirror of each pixel shows the same scene point in
    another state of the scene, seen by `view`; and which are known.

    A scene point is the same place on the same triangle, the background the same direction. Of several images on the
    mirror it is the one nearest to where the present one would be if it moved with the mirror. Not known: what is not
    there then, or is another mesh, and what the mirror shows no image of. Whether an image is hidden is not asked, as
    for Blender's own pass Vector. `pause`: as for `images.image_counts`.
    """
    index = same_instances(scene, then)
    places = np.zeros((len(points.pixel), 2))
    shown, known = shown_then(scene, points, then, index)
    for mirror in np.unique(points.mirror).tolist():
        other = index[mirror]
        here = np.flatnonzero((points.mirror == mirror) & known)
        known[(points.mirror == mirror)] = False
        if other == NOTHING or len(here) == 0:
            continue
        seen, is_found = points.seen[here].copy(), np.ones(len(here), bool)
        still = is_same(scene, mirror, then, other) & np.array_equal(view.eye, points.view.eye)
        # (Where neither mirror, eye nor scene point has moved the image has not.)
        moved = np.flatnonzero(~(still & (shown[here] == points.shown[here]).all(axis=1)))
        now, later = world_mesh(scene, [mirror]), world_mesh(then, [other])
        expected = seen + (later.middle - now.middle)
        for first in range(0, len(moved), ROWS):
            pause()
            some = moved[first : first + ROWS]
            found = later.mirror.points(view.eye, shown[here[some]])
            distance = np.linalg.norm(found.point - expected[some[found.row]], axis=1)
            order = np.lexsort((distance, found.row))
            rows, nearest = np.unique(found.row[order], return_index=True)
            is_found[some] = False
            is_found[some[rows]] = True
            seen[some[rows]] = found.point[order[nearest]]
        places[here[is_found]] = view.project(seen[is_found])
        known[here[is_found]] = True
    return places, known


def same_instances(scene: SceneArrays, then: SceneArrays) -> NDArray[np.int64]:
    """(instances,) index in another state of the scene, by the objects' names and their order; NOTHING: not there."""
    there = {key: number for number, key in enumerate(_keys(then))}
    return np.array([there.get(key, NOTHING) for key in _keys(scene)], np.int64)


def _keys(scene: SceneArrays) -> list[tuple[str, int]]:
    counts: Counter[str] = Counter()
    keys = []
    for instance in scene.instances:
        keys.append((instance.object_name, counts[instance.object_name]))
        counts[instance.object_name] += 1
    return keys


def is_same(scene: SceneArrays, index: int, then: SceneArrays, other: int) -> bool:
    """Whether an instance neither moves nor deforms."""
    one, two = scene.instances[index], then.instances[other]
    mesh, later = scene.meshes[one.mesh], then.meshes[two.mesh]
    return np.array_equal(one.matrix, two.matrix) and (
        mesh is later
        or (
            np.array_equal(mesh.positions, later.positions)
            and np.array_equal(mesh.corner_normals, later.corner_normals)
        )
    )


def shown_then(
    scene: SceneArrays, points: ShownPoints, then: SceneArrays, index: NDArray[np.int64]
) -> tuple[Float64Array, NDArray[np.bool_]]:
    """What is shown (n, 4) as it is then, and where that is known."""
    shown, known = points.shown.copy(), ~points.is_surface
    for number in np.unique(points.instance[points.is_surface]).tolist():
        other = int(index[number])
        if other == NOTHING:
            continue
        mesh, later = scene.meshes[scene.instances[number].mesh], then.meshes[then.instances[other].mesh]
        if not (
            np.array_equal(mesh.triangles, later.triangles) and np.array_equal(mesh.corner_vertex, later.corner_vertex)
        ):
            continue
        here = points.instance == number
        known |= here
        if not is_same(scene, number, then, other):
            triangle, weights = points.triangle[here], points.weights[here]
            shown[here, :3] = places_on(then, np.full(here.sum(), other), triangle, weights)
    return shown, known
