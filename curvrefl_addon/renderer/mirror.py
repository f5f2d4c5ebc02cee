# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One reflector of a scene: its map, where it is, and the solve for a view."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np

from ..optics.cube_map import CubeMapSurface
from ..scene.arrays import Float64Array, InstanceArrays, MeshArrays, SceneArrays
from ..scene.view import View
from .chunk import Batches, Chunk
from .gpu_objects import cube_texture
from .mesh_facts import MeshFacts
from .reflector_bake import bake_instance, polar
from .scene_geometry import CORNERS, Sight
from .solve import VertexSolution, solve_vertices
from .split import split_angle

SAME_STRETCH = 1e-6
"""Relative: a matrix whose stretch differs less only moves and turns"""


@dataclass(frozen=True)
class SolvedChunk:
    """A part of a mirror's scenery with its reflection points."""

    chunk: Chunk
    batches: Batches
    solution: VertexSolution


class Mirror:
    """A placed reflector."""

    def __init__(self, scene: SceneArrays, index: int, number: int, facts: MeshFacts, map_resolution: int) -> None:
        """Bakes the radial map of the instance `index`. `number` is 1, 2, ... in the order of the scene's instances.

        Raises InputError where the shape cannot be one.
        """
        start = perf_counter()
        self.map = bake_instance(scene, index, map_resolution)
        self.bake_ms = 1e3 * (perf_counter() - start)
        self.radial = cube_texture(self.map.radial)
        self._instance = scene.instances[index]
        self._mesh = facts.mesh
        self._box = facts.box
        self.may_hide_itself = not facts.is_convex
        self.index, self.number = index, number

    def follow(self, scene: SceneArrays, index: int, number: int) -> bool:
        """Be the instance `index` of another state of the scene; False where the map has to be baked anew for that."""
        instance = scene.instances[index]
        if scene.meshes[instance.mesh] is not self._mesh:
            return False
        if instance is not self._instance:
            placed = _moved_map(self.map.world_to_map, self._instance, instance)
            if placed is None:
                return False
            self.map = replace(self.map, world_to_map=placed, object_name=instance.object_name)
        self._instance, self.index, self.number = instance, index, number
        return True

    @property
    def mesh(self) -> MeshArrays:
        """What was baked."""
        return self._mesh

    @property
    def object_id(self) -> int:
        return self._instance.object_id

    def radius_pixels(self, view: View) -> float:
        """Size of the reflector's bounding ball in the picture."""
        distance = 1.0
        if not view.is_orthographic:
            distance = max(float(np.linalg.norm(view.eye[:3] - self.map.center)), self.map.r_max)
        return view.focal_pixels * self.map.r_max / distance

    def holds_eye(self, view: View) -> bool:
        """Whether the eye is inside the reflector."""
        if view.is_orthographic:
            return False
        eye = (self.map.world_to_map @ view.eye)[:3]
        distance = float(np.linalg.norm(eye))
        if distance >= self.map.r_max:
            return False
        if distance == 0.0:
            return True
        radius, _ = CubeMapSurface(self.map.radial).radius(eye[None] / distance)
        return distance < float(radius[0])

    def window(self, view: View) -> tuple[int, int, int, int]:
        """x, y, width and height of pixels that hold all of the reflector's; the whole picture where it is near."""
        low, high = self._box
        corners = np.ones((8, 4))
        corners[:, :3] = np.where(CORNERS, high, low)
        clip = corners @ (view.world_to_clip @ self._instance.matrix).T
        if (clip[:, 3] <= 1e-6).any():
            return (0, 0, view.width, view.height)
        pixels = (clip[:, :2] / clip[:, 3:] * 0.5 + 0.5) * (view.width, view.height)
        size = (view.width, view.height)
        first = np.clip(np.floor(pixels.min(axis=0)) - 1, 0, size).astype(int)
        last = np.clip(np.ceil(pixels.max(axis=0)) + 1, 0, size).astype(int)
        return (int(first[0]), int(first[1]), int(last[0] - first[0]), int(last[1] - first[1]))

    def sight(self, view: View, tolerance: float) -> Sight:
        """How finely `tolerance` pixels want the scenery split at the mirror's size in this view."""
        x, y, z = self.map.center.tolist()
        return Sight((x, y, z), split_angle(self.radius_pixels(view), tolerance), self.index)

    def solve(
        self, view: View, method: str, tolerance: float, scenery: Sequence[tuple[Chunk, Batches]]
    ) -> tuple[SolvedChunk, ...]:
        """Reflection points of all vertices of the scenery."""
        return tuple(
            SolvedChunk(
                chunk,
                batches,
                solve_vertices(
                    method,
                    view,
                    self.map.world_to_map,
                    self.radial,
                    self.map.r_max,
                    chunk.positions,
                    chunk.position_count,
                    tolerance=0.1 * tolerance,
                ),
            )
            for chunk, batches in scenery
        )


def _moved_map(world_to_map: Float64Array, before: InstanceArrays, after: InstanceArrays) -> Float64Array | None:
    """The map's frame after its instance has moved or turned; None where it has been stretched."""
    old_rotation, old_stretch = polar(before.matrix[:3, :3])
    rotation, stretch = polar(after.matrix[:3, :3])
    if np.abs(stretch - old_stretch).max() > SAME_STRETCH * np.abs(old_stretch).max():
        return None
    map_to_world = np.linalg.inv(world_to_map)
    offset = old_rotation.T @ (map_to_world[:3, 3] - before.matrix[:3, 3])
    moved = np.eye(4)
    moved[:3, :3] = rotation.T
    moved[:3, 3] = -rotation.T @ (after.matrix[:3, 3] + rotation @ offset)
    return moved


def faces_views(center: np.ndarray, near: float, far: float, resolution: int) -> list[View]:
    """The six views (GL face order) of a cube map about `center`."""
    axes: list[tuple[Any, Any]] = [
        ((1, 0, 0), (0, -1, 0)),
        ((-1, 0, 0), (0, -1, 0)),
        ((0, 1, 0), (0, 0, 1)),
        ((0, -1, 0), (0, 0, -1)),
        ((0, 0, 1), (0, -1, 0)),
        ((0, 0, -1), (0, -1, 0)),
    ]
    projection = np.array(
        [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, -(far + near) / (far - near), -2.0 * far * near / (far - near)],
            [0.0, 0.0, -1.0, 0.0],
        ]
    )
    views = []
    for forward, up in axes:
        world_to_view = np.eye(4)
        world_to_view[:3, :3] = np.array([np.cross(forward, up), up, np.negative(forward)])
        world_to_view[:3, 3] = -world_to_view[:3, :3] @ center
        views.append(View(world_to_view, projection, resolution, resolution))
    return views
