# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What mirrors show at the pixels' centers by rays in float64 alone, without a GPU: the references of the data set.

The mirror law about the interpolated shading normal, which is turned where its ray would run into its own facet, as in
Cycles and by `exact` (`surfaces/reflecting_outward.glsl`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...optics.shading_normal import reflecting_outward
from ...optics.surfaces.mesh_rays import Hits
from ...optics.surfaces.radial_surfaces import unit
from ...renderer.geometry.convexity import is_convex
from ...renderer.geometry.mesh_inside import is_closed
from ...renderer.truth.images import OWN_RANGE
from ...renderer.truth.shown_points import NOTHING, ShownPoints
from ...renderer.truth.world_mesh import WorldMesh, world_mesh
from ...scene.arrays import Float64Array, SceneArrays
from ...scene.camera.view import View

BOUNCES = 12
"""Mirrors one after the other that the length of a whole path goes on over"""
RAYS = 65536
"""At a time"""


class Float64Rays:
    """Of one scene."""

    def __init__(self, scene: SceneArrays) -> None:
        self.scene = scene
        self._is_mirror = np.array([item.object_id in scene.reflectors for item in scene.instances], bool)
        self._own: dict[int, tuple[WorldMesh | None, WorldMesh, float]] = {}

    @cached_property
    def _seen(self) -> WorldMesh:
        return world_mesh(self.scene, [i for i, item in enumerate(self.scene.instances) if item.visible_camera])

    def points(self, view: View, say: Callable[[str], None], pixels: NDArray[np.int64] | None = None) -> ShownPoints:
        """Of all pixels whose center shows a mirror, or of those of `pixels` (n,), indices row by row; `say` is told
        how far it is."""
        origin, sight = view.lines_of_sight(view.pixel_centers)
        looked_at = np.arange(len(origin)) if pixels is None else pixels
        found = []
        for first in range(0, len(looked_at), RAYS):
            say(f"rays {first} of {len(looked_at)}")
            some = looked_at[first : first + RAYS]
            found.append(self._points(origin[some], sight[some], some))
        return ShownPoints(view, *(np.concatenate(parts) for parts in zip(*found, strict=True)))

    def _points(self, origin: Float64Array, sight: Float64Array, numbers: NDArray[np.int64]) -> tuple[NDArray, ...]:
        """Of lines of sight (n, 3) through the centers of pixels of these numbers (n,)."""
        hits = self._seen.rays.first_hits(origin, sight)
        instance = np.where(hits.triangle >= 0, self._seen.instance[hits.triangle], NOTHING)
        on_mirror = (instance >= 0) & self._is_mirror[instance]
        pixel, mirror = np.flatnonzero(on_mirror), instance[on_mirror]
        sight = sight[pixel]
        place = origin[pixel] + hits.distance[pixel, None] * sight
        facing = _turned(self._seen, hits, pixel, sight)
        steps = self._step(mirror, place, sight, facing)
        shown_instance, triangle, weights, shown, normal, ray = steps
        way = np.where(shown_instance >= 0, np.linalg.norm(shown[:, :3] - place, axis=1), np.inf)
        self._go_on(way, shown_instance, shown[:, :3], ray, normal)
        return (
            numbers[pixel],
            mirror,
            place,
            facing,
            shown_instance,
            triangle,
            weights,
            shown,
            np.where((shown_instance >= 0)[:, None], normal, 0.0),
            np.full((len(pixel), 3), np.nan),
            way,
        )

    def _go_on(
        self,
        way: Float64Array,
        instance: NDArray[np.int64],
        place: Float64Array,
        ray: Float64Array,
        facing: Float64Array,
    ) -> None:
        """Add what comes after further mirrors to the ways (n,), in place."""
        rows = np.flatnonzero((instance >= 0) & self._is_mirror[np.maximum(instance, 0)])
        instance, place, ray, facing = instance[rows], place[rows], ray[rows], facing[rows]
        for _ in range(BOUNCES):
            if len(rows) == 0:
                return
            onto, _, _, shown, normal, ray = self._step(instance, place, ray, facing)
            way[rows] += np.where(onto >= 0, np.linalg.norm(shown[:, :3] - place, axis=1), np.inf)
            on = (onto >= 0) & self._is_mirror[np.maximum(onto, 0)]
            rows, instance, place, ray, facing = rows[on], onto[on], shown[on, :3], ray[on], normal[on]

    def _step(
        self, mirror: NDArray[np.int64], place: Float64Array, sight: Float64Array, facing: Float64Array
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], Float64Array, Float64Array, Float64Array, Float64Array]:
        """What rays off mirrors meet: instance, triangle, weights, place (n, 4), normal towards the ray; the ray."""
        ray = unit(sight - 2.0 * np.einsum("ij,ij->i", sight, facing)[:, None] * facing)
        count = len(mirror)
        instance, triangle = np.full(count, NOTHING), np.zeros(count, np.int64)
        weights, shown, normal = np.zeros((count, 3)), np.column_stack([ray, np.zeros(count)]), np.zeros((count, 3))
        for number in np.unique(mirror).tolist():
            here = np.flatnonzero(mirror == number)
            own, others, reach = self._meshes_of(number)
            nearest = np.full(len(here), np.inf)
            for mesh, least in ((others, 0.0), (own, reach)):
                if mesh is None or len(mesh.triangles) == 0:
                    continue
                hits = mesh.rays.first_hits(place[here], ray[here], least)
                met = np.flatnonzero(hits.distance < nearest)
                rows = here[met]
                nearest[met] = hits.distance[met]
                instance[rows], triangle[rows] = mesh.instance[hits.triangle[met]], mesh.triangle[hits.triangle[met]]
                weights[rows] = hits.weights[met]
                shown[rows, :3] = place[rows] + hits.distance[met, None] * ray[rows]
                shown[rows, 3] = 1.0
                # (On what is no mirror too: only what leads into the facet is turned.)
                normal[rows] = _turned(mesh, hits, met, ray[rows], self._is_mirror[instance[rows]])
        return instance, triangle, weights, shown, normal, ray

    def _meshes_of(self, number: int) -> tuple[WorldMesh | None, WorldMesh, float]:
        """The mirror itself, where it may see itself, and all others; how far off itself it is seen."""
        if number not in self._own:
            item = self.scene.instances[number]
            mesh = self.scene.meshes[item.mesh]
            itself = world_mesh(self.scene, [number])
            never = is_convex(mesh) and is_closed(mesh)
            others = [i for i, other in enumerate(self.scene.instances) if other.visible_glossy and i != number]
            own = itself if item.visible_glossy and not never else None
            self._own[number] = own, world_mesh(self.scene, others), OWN_RANGE * itself.size
        return self._own[number]


def _turned(
    mesh: WorldMesh,
    hits: Hits,
    rows: NDArray[np.int64],
    sight: Float64Array,
    reflects: NDArray[np.bool_] | None = None,
) -> Float64Array:
    """(n, 3) shading normals of hits `rows` towards where rays (n, 3) come from; of what `reflects`, or all, such that
    the mirrored ray leaves the facet."""
    corners = mesh.positions[mesh.triangles[hits.triangle[rows]]]
    facet = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    normal = hits.normal[rows]
    facet *= np.where(np.einsum("ij,ij->i", facet, normal) < 0.0, -1.0, 1.0)[:, None]
    side = np.where(np.einsum("ij,ij->i", facet, sight) > 0.0, -1.0, 1.0)[:, None]
    facet, normal = side * facet, side * normal
    outward = reflecting_outward(facet, -sight, normal)
    return outward if reflects is None else np.where(reflects[:, None], outward, normal)
