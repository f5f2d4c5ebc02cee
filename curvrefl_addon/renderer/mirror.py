# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One reflector of a scene: its map, what it can show, and the solve for a view."""

from __future__ import annotations

from time import perf_counter
from typing import Any

import numpy as np

from ..optics.cube_map import CubeMapSurface
from ..scene.arrays import InstanceArrays, SceneArrays
from ..scene.view import View
from .convexity import is_convex
from .geometry import WorldGeometry, flatten
from .gpu_objects import cube_texture
from .reflector_bake import bake_instance
from .solve import VertexSolution, solve_vertices
from .split import split_angle, split_for_reflection


class Mirror:
    """A placed reflector. `number` is 1, 2, ... in the order of the scene's instances."""

    def __init__(self, scene: SceneArrays, instance_index: int, number: int, map_resolution: int) -> None:
        """Bakes the radial map. Raises InputError where the shape cannot be one."""
        self.number = number
        start = perf_counter()
        self.map = bake_instance(scene, instance_index, map_resolution)
        self.bake_ms = 1e3 * (perf_counter() - start)
        self.radial = cube_texture(self.map.radial)
        own = scene.instances[instance_index]

        def is_own(instance: InstanceArrays) -> bool:
            return instance is own

        def is_reflected(instance: InstanceArrays) -> bool:
            return instance is not own and instance.visible_glossy

        self.surface = flatten(scene, is_own)
        """The reflector's own triangles"""
        self.may_hide_itself = not is_convex(self.surface)
        self.whole_scenery = flatten(scene, is_reflected)
        """All that it may show, unsplit"""
        self._split: tuple[float, WorldGeometry] | None = None

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
        low, high = self.surface.bounds
        corners = np.array(
            [[x, y, z, 1.0] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        )
        clip = corners @ view.world_to_clip.T
        if (clip[:, 3] <= 1e-6).any():
            return (0, 0, view.width, view.height)
        pixels = (clip[:, :2] / clip[:, 3:] * 0.5 + 0.5) * (view.width, view.height)
        size = (view.width, view.height)
        first = np.clip(np.floor(pixels.min(axis=0)) - 1, 0, size).astype(int)
        last = np.clip(np.ceil(pixels.max(axis=0)) + 1, 0, size).astype(int)
        return (int(first[0]), int(first[1]), int(last[0] - first[0]), int(last[1] - first[1]))

    def scenery(self, view: View, tolerance: float) -> WorldGeometry:
        """What this mirror shows, split as finely as `tolerance` pixels need at the mirror's size in this view."""
        angle = split_angle(self.radius_pixels(view), tolerance)
        if self._split is None or self._split[0] != angle:
            self._split = (angle, split_for_reflection(self.whole_scenery, self.map.center, angle))
        return self._split[1]

    def solve(self, view: View, method: str, tolerance: float) -> VertexSolution:
        """Reflection points of all vertices of the scenery."""
        geometry = self.scenery(view, tolerance)
        return solve_vertices(
            method,
            view,
            self.map.world_to_map,
            self.radial,
            self.map.r_max,
            geometry.position_texture,
            len(geometry.positions),
            tolerance=0.1 * tolerance,
        )

    def free(self) -> None:
        """Let go of what is on the GPU."""
        self._split = None
        del self.radial


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
