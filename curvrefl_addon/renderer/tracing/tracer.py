# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths of one picture: a loop of steps, of which each adds the light that it finds."""

from __future__ import annotations

from typing import Any

from ...scene.arrays import UNLIMITED_BOUNCES, SceneArrays
from ..device.textures import depth_texture
from ..indirect.gather import Gathering, GatherPicture, Source
from ..lighting.lighting import Lighting
from ..paths.features import ABSORPTION, ALPHA, ANISOTROPY, GLASS, ROUGH, goes_on, has_base
from ..rays.ray_scene import RayScene
from ..shading.features import RayShadows
from ..surfaces.by_size import BySize
from ..surfaces.canvas import Canvas
from ..surfaces.materials import Materials
from ..surfaces.pixel_classes import CLASS_COUNT
from ..surfaces.surface_buffer import SurfaceBuffer
from ..surfaces.windows import Window
from .media import absorbing
from .object_frames import object_frames
from .path_classes import BUFFERS, PathClass, PathClasses, place_of
from .path_light import PathLight
from .path_vertices import PathVertices
from .step import Limits, Surroundings, follow

LOOK_FROM = 3
"""Steps that have to be left for it to pay to look whether any path goes on"""
MOST_SIZES = 3
"""Of pictures whose targets are kept"""


class PathTracer:
    """Follows paths in one scene."""

    def __init__(self, scene: SceneArrays, features: frozenset[str], lighting: Lighting, materials: Materials) -> None:
        """`features`: what the scene needs of paths, not empty (`paths.features.path_features`)."""
        self.features = features
        self._lighting, self._materials = lighting, materials
        self._has_programs = materials.has_programs
        self._targets = _targets(materials.has_programs)
        self.follow(scene)

    def follow(self, scene: SceneArrays) -> None:
        """Know another state of the scene, which needs the same features."""
        self._absorbing: Any = absorbing(scene) if ABSORPTION in self.features else None
        self.move(scene)
        used = {
            index
            for instance in scene.instances
            for index in instance.materials
            if goes_on(scene.materials[index], instance.object_id in scene.reflectors)
        }
        self._has_base = any(has_base(scene.materials[index]) for index in used)
        self._limits = (scene.most_bounces, scene.mirror_bounces, scene.transmission_bounces, scene.transparent_bounces)
        self.sees_through = any(scene.materials[index].is_seen_through for index in used)
        """Paths begin at other surfaces than mirrors, too"""
        if self._has_programs != self._materials.has_programs:
            self._has_programs = self._materials.has_programs
            self._targets = _targets(self._has_programs)

    def move(self, scene: SceneArrays) -> None:
        """Know a state of the scene that differs in its objects' places alone."""
        self._frames: Any = object_frames(scene) if ANISOTROPY in self.features else None

    @property
    def can_be_calm(self) -> bool:
        """Sharp rays, blurred, stand for the paths while the view moves (`shading/calm.py`): these are of rough mirrors
        that let nothing through."""
        return ROUGH in self.features and self.features.isdisjoint({GLASS, ALPHA})

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        _, _, interfaces, transparent = self._limits
        most = max(interfaces if GLASS in self.features else 0, transparent if ALPHA in self.features else 0)
        if MOST_EVENTS < most < UNLIMITED_BOUNCES:
            return (f"Light is followed through {MOST_EVENTS} surfaces, fewer than the file's bounces allow.",)
        return ()

    def surroundings(self, rays: RayScene, view_uniforms: Any, window: Window) -> Surroundings:
        """What steps of paths have bound, in pictures of which the `window` is drawn."""
        return Surroundings(
            self.features | self._materials.links,
            self._materials,
            rays,
            self._lighting.ggx,
            self._frames,
            self._absorbing,
            view_uniforms,
            window,
        )

    def limits(self, bounces: int) -> Limits:
        """`bounces`: mirrors that are followed at most."""
        most, reflections, interfaces, transparent = self._limits
        reflections = min(reflections, bounces)
        interfaces = min(interfaces, MOST_EVENTS) if GLASS in self.features else 0
        transparent = min(transparent, MOST_EVENTS) if ALPHA in self.features else 0
        return Limits(reflections, interfaces, transparent, min(most, reflections + interfaces))

    def add(
        self,
        canvas: Canvas,
        weight: float,
        seen: SurfaceBuffer,
        rays: RayScene,
        view_uniforms: Any,
        window: Window | None,
        sub_frame: int,
        bounces: int,
        chosen: Any = None,
        sees_through: bool = True,
        meets_mirrors: bool = True,
        shadows: RayShadows | None = None,
        film_transparent: bool = False,
        gathers: Gathering | None = None,
    ) -> None:
        """Add the light of one sample of the paths that begin in `window` at mirrors and, if it `sees_through` them, at
        other surfaces that do not stop the light, times `weight`. `meets_mirrors`: rays off mirrors may meet mirrors.

        `chosen`: record texture by mirrors' numbers, 1 of those whose paths are followed; None is all. `sub_frame`:
        number of the sample. `gathers`: see `ShadePass.add`.
        """
        window = window or (0, 0, seen.width, seen.height)
        if window[2] <= 0 or window[3] <= 0:
            return
        classes, vertices = self._targets.of(seen.width, seen.height)
        around = self.surroundings(rays, view_uniforms, window)
        light = PathLight(around, self._lighting, shadows, film_transparent, self._has_base, gathers)
        gathered: GatherPicture | None = None
        limits = self.limits(bounces)
        classes.sort_seen(seen, window, chosen, sees_through and self.sees_through)
        light.add(canvas, weight, PathClass.GOES_ON, seen, classes.depth(0))
        before: SurfaceBuffer | PathVertices = seen
        # (Without anything that goes on behind the first surface one step is all.)
        last = limits.most_steps if meets_mirrors or self.sees_through else 1
        sample = (sub_frame, self._lighting.sub_frames)
        for step in range(1, last + 1):
            met = vertices[place_of(step)]
            follow(around, before, classes.depth(step - 1), met, limits, sample, step)
            classes.sort_met(step, met, window)
            kinds = [PathClass.MISSES, PathClass.STOPS]
            if step < last and (self._has_base or light.lights_samples or light.has_bodies):
                kinds.append(PathClass.GOES_ON)
            stops = (classes.depth(step), PathClass.STOPS / CLASS_COUNT)
            surface = (met.position, met.normal, met.color)
            shared = None
            if gathers is not None and step == 1:
                # (Most paths stop here, where pixels next to each other still see the same.)
                picture = gathers.picture(seen.width, seen.height, window)
                shared = picture.share(gathers, Source.PATHS, surface, met.made, (met.way, met.throughput), stops)
            for kind in kinds:
                light.add(
                    canvas, weight, kind, met, classes.depth(step), before, classes.depth(step - 1), sub_frame, shared
                )
            if gathers is not None and step > 1:
                gathered = gathered or gathers.picture(seen.width, seen.height, window)
                gathered.follow(gathers, Source.PATHS, surface, met.made, (met.way, met.throughput), stops)
            before = met
            # (A look that waits for the GPU costs less than the passes of the steps that are left.)
            if last - step >= LOOK_FROM and step % 2 == 0 and not classes.any_left(step):
                break
        if gathers is not None and gathered is not None:
            gathered.add(gathers, canvas, weight)


def _targets(has_programs: bool) -> BySize[tuple[PathClasses, dict[int, PathVertices]]]:
    def made(width: int, height: int) -> tuple[PathClasses, dict[int, PathVertices]]:
        classes = PathClasses([depth_texture(width, height) for _ in range(BUFFERS)])
        return classes, {place: PathVertices(width, height, has_programs) for place in range(1, BUFFERS)}

    return BySize(made, MOST_SIZES)


MOST_EVENTS = 63
"""Interfaces or transparent surfaces that a path is followed through at most: what its state counts"""
