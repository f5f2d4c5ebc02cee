# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light between the surfaces of one scene, as the scene changes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float64Array, SceneArrays
from ..geometry.scene_geometry import Difference, SceneGeometry
from ..lighting.left_out import is_lit_indirectly
from ..lighting.lighting import Lighting
from ..rays.ray_scene import RayScene
from ..surfaces.materials import Materials
from .emitters import Emitters, emitter_table
from .gather import Gathering, GatherPool
from .irradiance import Irradiance
from .points import Surface, place_patches

BATCHES = 4
"""Of rays, of which each patch sends RAYS_AT_ONCE in each"""
LIGHTS = 16
"""Sub-frames whose lamps and directions of the world light the patches"""
MANY_TO_CLOSE = 300_000
"""A mesh of more triangles is not asked whether it is closed"""


class IndirectLight:
    """Of one scene."""

    def __init__(self, scene: SceneArrays, geometry: SceneGeometry) -> None:
        self._scene, self._geometry = scene, geometry
        self.irradiance: Irradiance | None = None
        """None where light bounces off no surface"""
        self.emitters: Emitters | None = None
        """None where no surface shines"""
        self._pool = GatherPool()
        self._is_placed = self._is_lit = False

    def follow(self, scene: SceneArrays, difference: Difference) -> None:
        """Know another state of the scene, whose geometry the `difference` has changed."""
        before, self._scene = self._scene, scene
        objects = ("materials", "images", "reflectors", "origin")
        is_same = all(getattr(scene, name) == getattr(before, name) for name in ("reflectors", "origin"))
        is_same &= all(getattr(scene, name) is getattr(before, name) for name in objects[:2])
        if difference.structure or difference.moved or not is_same:
            self._is_placed = False
        same_light = scene.lights is before.lights and scene.world is before.world
        if not same_light or scene.diffuse_bounces != before.diffuse_bounces:
            self._is_lit = False

    def prepare(self, rays: Callable[[], RayScene], materials: Materials, lighting: Lighting, view_uniforms: Any) -> bool:
        """Make all that is missing; returns whether there was something."""
        if self._is_placed and self._is_lit:
            return False
        if not self._is_placed:
            table = emitter_table(self._scene)
            self.emitters = None if table is None else Emitters(table)
            self.irradiance = None
            if is_lit_indirectly(self._scene):
                self._place()
            self._is_placed = True
            if self.irradiance is not None:
                self.irradiance.find_walls(rays())
                for _ in range(BATCHES):
                    self.irradiance.follow_rays(rays(), materials, lighting, view_uniforms, self.emitters)
        if self.irradiance is not None:
            self.irradiance.light(lighting, min(LIGHTS, lighting.sub_frames))
            self.irradiance.sweep(self._scene.diffuse_bounces)
        self._is_lit = True
        return True

    def gathering(
        self, rays: Callable[[], RayScene], materials: Materials, lighting: Lighting, view_uniforms: Any, sub_frame: int
    ) -> Gathering | None:
        """What a sub-frame gathers by; None where there is nothing to."""
        if self.irradiance is None and self.emitters is None:
            return None
        has_sky = self.irradiance is not None and "LIGHTING_WORLD" in lighting.features
        made = (self._pool, rays(), materials, lighting, view_uniforms, sub_frame)
        return Gathering(self.irradiance, self.emitters, has_sky, *made)

    def _place(self) -> None:
        placed = self._geometry.placed
        shown = [index for index, item in enumerate(placed) if len(item.mesh.triangles) and is_there(item.instance)]
        is_solid = np.zeros(max(len(placed), 1), bool)
        if not shown:
            return
        is_solid[shown] = self._solid(shown)
        focus, half = self._focus(shown)
        surfaces = [Surface(placed[index].mesh, placed[index].instance, bool(is_solid[index])) for index in shown]
        patches = place_patches(surfaces, focus, half)
        if patches is not None:
            self.irradiance = Irradiance(patches, is_solid)

    def _solid(self, shown: list[int]) -> NDArray[np.bool_]:
        """Which are closed and hold no other thing's middle."""
        placed = [self._geometry.placed[index] for index in shown]
        boxes = self._geometry.box_corners(shown).reshape(len(shown), 8, 3)
        low, high = boxes.min(axis=1), boxes.max(axis=1)
        middles = 0.5 * (low + high)
        found = np.zeros(len(shown), bool)
        for place, item in enumerate(placed):
            if len(item.mesh.triangles) > MANY_TO_CLOSE or not self._geometry.facts.of(item.mesh).is_closed:
                continue
            within = ((middles > low[place]) & (middles < high[place])).all(axis=1)
            within[place] = False
            found[place] = not within.any()
        return found

    def _focus(self, shown: list[int]) -> tuple[Float64Array, float]:
        """Middle of the mirrors, and how far from there most things reach."""
        placed = self._geometry.placed
        mirrors = [index for index in shown if placed[index].instance.object_id in self._scene.reflectors] or shown
        centers, radii = self._geometry.balls(np.array(mirrors, np.int64))
        low, high = (centers - radii[:, None]).min(axis=0), (centers + radii[:, None]).max(axis=0)
        focus = 0.5 * (low + high)
        least = 0.5 * float((high - low).max())
        centers, radii = self._geometry.balls(np.array(shown, np.int64))
        reach = np.abs(centers - focus).max(axis=1) + radii
        return focus, max(float(np.quantile(reach, 0.7)), 1.5 * least, 1e-6)


def is_there(instance: Any) -> bool:
    """Whether light that scatters can meet an instance, or anybody see it"""
    return not instance.holdout and (instance.visible_diffuse or instance.visible_camera or instance.visible_glossy)
