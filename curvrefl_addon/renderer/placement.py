# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as single precision can hold it: about an origin near what is looked at, meshes about their own middles.

The GPU computes in float32, whose steps grow with the distance from the origin: half a centimeter at 1e5 m. So a scene
that is far out as compared with how near it is looked at is moved, in float64, before anything of it is uploaded. What
has not changed stays the same object here too. Near the world's origin nothing is moved at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..scene.arrays import Float32Array, Float64Array, InstanceArrays, LightArrays, MeshArrays, SceneArrays
from ..scene.camera.view import DEEPEST, View
from .geometry.mesh_facts import MeshFactsCache
from .geometry.scene_geometry import SceneGeometry
from .mirrors.mirror import Mirror

FAR = 16.0
"""What is looked at may be so many times farther from the origin than from the eye. (At 40 times, pictures of a small
room have acne: shadow maps and rays that start on surfaces compare places that differ by little.)"""
NEAREST = 0.01
"""Share of its size that the eye counts as away from what it looks at, if it is nearer"""
OFF_CENTER = 16.0
"""A mesh is moved whose middle lies so many times its size from its object's origin"""

SLACK = 0.99
"""Of distances that a view is fitted to"""


class Placement:
    """The moved arrays of one scene, and by how much they are moved."""

    def __init__(self, facts: MeshFactsCache) -> None:
        self.origin: Float64Array = np.zeros(3)
        """World space; not to be changed in place"""
        self._facts = facts
        self._meshes: dict[int, tuple[MeshArrays, MeshArrays, Float64Array | None]] = {}
        """By id the mesh, the one in its place, and the middle that it has been moved by"""
        self._instances: dict[int, tuple[InstanceArrays, Float64Array | None, InstanceArrays]] = {}
        self._lights: tuple[tuple[LightArrays, ...], tuple[LightArrays, ...]] = ((), ())

    def move_to(self, origin: Float64Array) -> None:
        """From now on `placed` is about another origin (3,)."""
        self.origin = origin
        self._instances = {}
        self._lights = ((), ())

    def placed(self, scene: SceneArrays) -> SceneArrays:
        """The scene about the origin; itself where nothing has to be moved."""
        known, self._meshes = self._meshes, {}
        for mesh in scene.meshes:
            self._meshes[id(mesh)] = known.get(id(mesh)) or (mesh, *_about_its_middle(mesh, self._facts))
        found = [self._meshes[id(mesh)] for mesh in scene.meshes]
        if not self.origin.any() and all(middle is None for _, _, middle in found):
            self._instances = {}
            return scene
        before, self._instances = self._instances, {}
        for instance in scene.instances:
            middle = found[instance.mesh][2]
            item = before.get(id(instance))
            if item is None or item[1] is not middle:
                item = (instance, middle, self._moved_instance(instance, middle))
            self._instances[id(instance)] = item
        if self._lights[0] is not scene.lights:
            self._lights = scene.lights, tuple(self._moved_light(light) for light in scene.lights)
        return replace(
            scene,
            meshes=tuple(placed for _, placed, _ in found),
            instances=tuple(self._instances[id(instance)][2] for instance in scene.instances),
            lights=self._lights[1],
            origin=(float(self.origin[0]), float(self.origin[1]), float(self.origin[2])),
        )

    def _moved_instance(self, instance: InstanceArrays, middle: Float64Array | None) -> InstanceArrays:
        if middle is None and not self.origin.any():
            return instance
        matrix = instance.matrix.copy()
        if middle is not None:
            matrix[:3, 3] += matrix[:3, :3] @ middle
        matrix[:3, 3] -= self.origin
        if middle is None:
            return replace(instance, matrix=matrix)
        x, y, z = middle.tolist()
        return replace(instance, matrix=matrix, shift=(x, y, z))

    def _moved_light(self, light: LightArrays) -> LightArrays:
        if light.kind == "SUN" or not self.origin.any():
            return light
        matrix = light.matrix.copy()
        matrix[:3, 3] -= self.origin
        return replace(light, matrix=matrix)


def _about_its_middle(mesh: MeshArrays, facts: MeshFactsCache) -> tuple[MeshArrays, Float64Array | None]:
    """The mesh, with what its vertices have been moved by where they are far from their origin; else None."""
    if len(mesh.positions) == 0:
        return mesh, None
    low, high = (end.astype(np.float64) for end in facts.of(mesh).box)
    if np.abs(low + high).max() <= OFF_CENTER * np.linalg.norm(high - low):
        return mesh, None
    # (A difference of numbers in single precision that are nearly the same is exact.)
    middle = (0.5 * (low + high)).astype(np.float32).astype(np.float64)
    positions: Float32Array = (mesh.positions.astype(np.float64) - middle).astype(np.float32)
    return replace(mesh, positions=positions), middle


def wanted_origin(view: View, origin: Float64Array, geometry: SceneGeometry, mirrors: Sequence[Mirror]) -> Float64Array:
    """Where in the world a scene should have its origin in a view; `origin` itself while that serves.

    `view` and `geometry` are about `origin`. What counts is the mirror that is largest in the view, and where none is
    in it the place of the scene that is nearest to the eye.
    """
    if not geometry.placed:
        return origin
    if seen := [mirror.index for mirror in mirrors if min(mirror.window(view)[2:]) > 0]:
        corners = geometry.box_corners(seen)
        low, high = corners.min(axis=1), corners.max(axis=1)
    else:
        centers, radii = geometry.chunk_balls(geometry.chunks)
        low = (centers - radii[:, None]).min(axis=0, keepdims=True)
        high = (centers + radii[:, None]).max(axis=0, keepdims=True)
    anchors = np.clip(_eyes(view, 0.5 * (low + high)), low, high)
    sizes = np.linalg.norm(high - low, axis=1)
    if view.is_orthographic:
        distances = np.full(len(anchors), 1.0 / abs(float(view.view_to_clip[1, 1])))
    else:
        distances = np.linalg.norm(anchors - view.place, axis=1)
    largest = int(np.argmax(sizes / np.maximum(distances + sizes, np.finfo(float).tiny)))
    anchor, reach = anchors[largest], max(float(distances[largest]), NEAREST * float(sizes[largest]))
    if reach == 0.0 or np.linalg.norm(anchor) <= FAR * reach:
        return origin
    found = origin + anchor
    if np.linalg.norm(found) <= 0.5 * FAR * reach:
        return np.zeros(3)
    # (Round numbers leave as much as can be of matrices that were.)
    step = 2.0 ** np.floor(np.log2(reach))
    return np.round(found / step) * step


def _eyes(view: View, centers: Float64Array) -> Float64Array:
    """(n, 3) from where the boxes about these centers are looked at."""
    if not view.is_orthographic:
        return np.broadcast_to(view.place, centers.shape)
    axis = view.eye[:3]
    return view.place + ((centers - view.place) @ axis)[:, None] * axis


def with_depths_that_fit(view: View, scene: SceneArrays, geometry: SceneGeometry) -> View:
    """The view with a projection for what there is between its ends, where these are very far apart."""
    near, far = view.clip_range
    if not geometry.placed or (not view.is_orthographic and far <= DEEPEST * near):
        return view
    corners = geometry.box_corners(range(len(geometry.placed)))
    low, high = corners.min(axis=1), corners.max(axis=1)
    lamps = [light for light in scene.lights if light.kind != "SUN"]
    if lamps:
        places = np.array([light.matrix[:3, 3] for light in lamps])
        reaches = np.array([[max(light.radius, *light.size)] for light in lamps])
        low, high = np.concatenate([low, places - reaches]), np.concatenate([high, places + reaches])
    ends = np.stack([low, high])
    row = view.world_to_view[2]
    # Along the line of sight, of the box's corner that is nearest and of the one that is farthest.
    ahead = -(row[:3] * ends)
    nearest, farthest = ahead.min(axis=0).sum(axis=1) - row[3], ahead.max(axis=0).sum(axis=1) - row[3]
    if not view.is_orthographic:
        # No point of the picture is farther off the line of sight than its corners.
        slopes = (1.0 + np.abs(view.view_to_clip[[0, 1], 2])) / np.diag(view.view_to_clip)[:2]
        away = np.linalg.norm(np.clip(view.place, low, high) - view.place, axis=1)
        nearest = np.maximum(nearest, away / np.sqrt(1.0 + slopes @ slopes))
    return view.fitted(SLACK * float(nearest.min()), float(farthest.max()) / SLACK)
