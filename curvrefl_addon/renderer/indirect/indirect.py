# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light between the surfaces of one scene, as the scene changes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float64Array, SceneArrays
from ..geometry.placed_instances import Difference
from ..geometry.scene_geometry import SceneGeometry
from ..lighting.left_out import is_lit_indirectly
from ..lighting.lighting import Lighting
from ..rays.ray_scene import RayScene
from ..surfaces.materials import Materials
from .emitters import Emitters, emitter_table
from .gather import Gathering, gather_pool
from .irradiance import RAYS_AT_ONCE, Irradiance
from .points import Patches, Surface, place_patches

BATCHES = 4
"""Of rays, of which each patch sends RAYS_AT_ONCE in each"""
LIGHTS = 16
"""Sub-frames whose lamps light the patches, or more: the directions of the world are right together alone"""
MANY_TO_CLOSE = 300_000
"""A mesh of more triangles is not asked whether it is closed"""
LEAST_SHARE = 0.02
"""Of all light at the tenth of the patches that get most of theirs from other surfaces: less is not worth its time"""
OPEN = 0.4
"""Share of rays over patches that meet nothing: then the sky's shadows by a few directions serve better than rays"""


@dataclass(frozen=True, slots=True)
class Means:
    """What light is found by."""

    rays: Callable[[], RayScene]
    materials: Materials
    lighting: Lighting
    view_uniforms: Any


class IndirectLight:
    """Of one scene."""

    def __init__(self, scene: SceneArrays, geometry: SceneGeometry) -> None:
        self._scene, self._geometry = scene, geometry
        self.irradiance: Irradiance | None = None
        """None where light bounces off no surface, or changes nothing"""
        self.emitters: Emitters | None = None
        """None where no surface shines"""
        self._pool = gather_pool()
        self._needs_patches = self._needs_light = True
        self._work: Iterator[bool] | None = None
        """Steps that are left, each True where light has changed by it"""
        self._openness, self._share = 0.0, 1.0
        self._follows_lamps = False
        self.prepare_ms = 0.0
        """Of the last time that all was found at once"""

    def follow(self, scene: SceneArrays, difference: Difference) -> None:
        """Know another state of the scene, whose geometry the `difference` has changed."""
        before, self._scene = self._scene, scene
        is_same = all(getattr(scene, name) is getattr(before, name) for name in ("materials", "images"))
        is_same &= all(getattr(scene, name) == getattr(before, name) for name in ("reflectors", "origin", "caustics"))
        if scene.origin != before.origin:
            self.irradiance = None
        if difference.structure or difference.elsewhere or not is_same:
            self._needs_patches = self._needs_light = True
        same_light = scene.lights is before.lights and scene.world is before.world
        if not same_light or scene.diffuse_bounces != before.diffuse_bounces:
            self._needs_light = True
            self._needs_patches |= is_lit_indirectly(scene) != is_lit_indirectly(before)
            # (It may be worth its time now.)
            self._needs_patches |= self.irradiance is None
        if self._needs_light:
            self._work = None

    def leave_caustics(self, are_followed: bool) -> None:
        """What lamps send over sharp mirrors and through glass is followed by others, or no more."""
        if are_followed != self._follows_lamps:
            self._follows_lamps = are_followed
            self._needs_patches = self._needs_light = True
            self._work = None

    def restart(self) -> None:
        """Find light anew, by other means than before."""
        self._needs_light, self._work = True, None

    @property
    def is_gathered(self) -> bool:
        """There is light for rays to find."""
        return self.irradiance is not None or self.emitters is not None

    @property
    def is_settled(self) -> bool:
        """Nothing is left to find."""
        return not self._needs_patches and not self._needs_light and self._work is None

    @property
    def state(self) -> str:
        """For a panel or a report."""
        if self.irradiance is None:
            if not self.is_settled:
                return "to be found"
            return "none" if self._share >= LEAST_SHARE else f"left out: {100.0 * self._share:.1f} % of the light"
        rays = RAYS_AT_ONCE * self.irradiance.batches
        # (What is sharp sends light on as if it scattered it, but for that of lamps where it is followed.)
        others = " but for those of lamps" if self._follows_lamps else ""
        caustics = f"; caustics{others} spread evenly" if self._scene.caustics else ""
        patches = f"{self.irradiance.patches.count:,} patches, {rays} rays each{caustics}"
        return patches if self.is_settled else f"{patches}, not settled"

    def prepare(self, means: Means) -> bool:
        """Find all that is missing; returns whether there was something."""
        is_changed = False
        start = perf_counter()
        while not self.is_settled:
            is_changed |= self._step(means, whole=True)
        if self.irradiance is not None:
            self.irradiance.wait()
        self.prepare_ms = 1e3 * (perf_counter() - start)
        return is_changed

    def advance(self, means: Means, seconds: float) -> bool:
        """Find light for about so long, a step at least; returns whether that of pictures has changed.

        The first time after a change what is known is lit anew, and no more: while a thing is dragged, what else would
        be found is of no use by the next redraw.
        """
        is_changed = False
        end = perf_counter() + (seconds if self._work is not None else 0.0)
        while not self.is_settled:
            is_changed |= self._step(means, whole=False)
            if perf_counter() >= end:
                break
        return is_changed

    def gathering(self, means: Means, sub_frame: int) -> Gathering | None:
        """What a sub-frame gathers by; None where there is nothing to."""
        if not self.is_gathered:
            return None
        has_sky = self.irradiance is not None and "LIGHTING_WORLD" in means.lighting.features and self._openness < OPEN
        return Gathering(
            self.irradiance,
            self.emitters,
            has_sky,
            self._pool,
            means.rays(),
            means.materials,
            means.lighting,
            means.view_uniforms,
            sub_frame,
            has_caustics=self._scene.caustics,
            clamp=self._scene.indirect_clamp,
        )

    @property
    def _even_caustics(self) -> float:
        """See `Irradiance.follow_rays`."""
        return float(self._scene.caustics) * (0.5 if self._follows_lamps else 1.0)

    def _step(self, means: Means, whole: bool) -> bool:
        if self._work is None:
            self._needs_light = False
            self._work = self._steps(means, self._needs_patches, whole)
        try:
            return next(self._work)
        except StopIteration:
            self._work = None
            return False

    def _steps(self, means: Means, anew: bool, whole: bool) -> Iterator[bool]:
        """All that there is to do; not `whole`: with light that is not yet right in between."""
        lights = max(min(LIGHTS, means.lighting.sub_frames), means.lighting.with_all_directions)
        bounces = self._scene.diffuse_bounces
        if not whole:
            # What is known of the surfaces before serves until there is more.
            if self.irradiance is not None:
                self.irradiance.light(means.lighting, 1)
                self.irradiance.sweep(bounces)
            yield self.irradiance is not None
        if anew:
            table = emitter_table(self._scene)
            self.emitters = None if table is None else Emitters(table)
            found = None
            if is_lit_indirectly(self._scene):
                for step in self._place():
                    found = step
                    yield False
            if found is None:
                # (Patches are asked for until they are there: a lamp that changes first begins with them again.)
                self._needs_patches = False
                was, self.irradiance, self._share = self.irradiance, None, 1.0
                yield was is not None
                return
            patches, is_solid = found
            irradiance = Irradiance(patches, is_solid)
            yield False
            irradiance.find_walls(means.rays())
            for batch in range(BATCHES):
                for _ in irradiance.follow_rays(
                    means.rays(),
                    means.materials,
                    means.lighting,
                    means.view_uniforms,
                    self.emitters,
                    self._even_caustics,
                ):
                    yield False
                if batch == 0:
                    self._openness = irradiance.openness()
                if batch == 0 and not whole:
                    irradiance.light(means.lighting, 1)
                    irradiance.sweep(bounces)
                    self.irradiance = irradiance
                    yield True
            self.irradiance, self._needs_patches = irradiance, False
        if self.irradiance is None:
            return
        for _ in self.irradiance.light_some(means.lighting, lights):
            yield False
        self.irradiance.sweep(bounces)
        if anew:
            self._share = self.irradiance.share_of_surfaces()
            if self._share < LEAST_SHARE:
                self.irradiance = None
        yield True

    def _place(self) -> Iterator[tuple[Patches, NDArray[np.bool_]] | None]:
        """Patches, last, and which instances are solid."""
        placed = self._geometry.placed
        shown = [index for index, item in enumerate(placed) if len(item.mesh.triangles) and is_there(item.instance)]
        is_solid = np.zeros(max(len(placed), 1), bool)
        if not shown:
            yield None
            return
        is_solid[shown] = self._solid(shown)
        yield None
        focus, half = self._focus(shown)
        surfaces = []
        for index in shown:
            mesh, instance = placed[index].mesh, placed[index].instance
            surfaces.append(Surface(mesh, instance, bool(is_solid[index]), self._scene.light_set_of(instance)))
        patches = None
        for step in place_patches(surfaces, focus, half):
            patches = step
            yield None
        yield None if patches is None else (patches, is_solid)

    def _solid(self, shown: list[int]) -> NDArray[np.bool_]:
        """Which are closed and hold no other thing's middle."""
        placed = [self._geometry.placed[index] for index in shown]
        boxes = self._geometry.box_corners(shown)
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
