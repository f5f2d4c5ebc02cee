# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How a scene's surfaces look: what they are made of, what lights them, what paths do at them."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import Any

from ..optics.catalog import Method
from ..scene.arrays import SceneArrays
from .caustics.caustics import Caustics, Thrower
from .geometry.placed_instances import Difference
from .geometry.scene_geometry import SceneGeometry
from .indirect.indirect import IndirectLight, Means
from .lighting.left_out import seen_in_spite_of_links
from .lighting.lighting import Lighting
from .mirrors.mirror import Mirror
from .paths.features import same_for_paths
from .paths.left_out import PathNeeds
from .rays.ray_scene import RayScene
from .settings import Settings
from .shading.shade import ShadePass
from .shown.shown import Stage
from .surfaces.materials import Materials
from .tracing.tracer import PathTracer

MATERIALS = "materials and images"
LIGHT_SECONDS = 0.03
"""In each redraw of a viewport, for light between surfaces"""


class Appearance:
    """Of one scene; `free()` when done."""

    def __init__(
        self,
        scene: SceneArrays,
        geometry: SceneGeometry,
        mirrors: Mapping[int, int],
        settings: Settings,
        image_memory: int,
        is_gradual: bool,
    ) -> None:
        """`mirrors`: numbers by the indices of their instances; others as of the renderer."""
        self._scene, self._geometry, self._settings = scene, geometry, settings
        self._mirrors = dict(mirrors)
        self.materials = Materials(scene, image_memory, is_gradual, geometry)
        self.lighting = Lighting(scene, geometry, self.materials, settings.samples)
        self.shade = ShadePass(scene, self.lighting, self.materials)
        self.indirect = IndirectLight(scene, geometry)
        self.indirect.leave_caustics(settings.caustics)
        self.caustics = Caustics(scene, settings, geometry.facts)
        self.tracer: PathTracer | None = None
        """Where rays do not only go from sharp mirror to sharp mirror"""
        self._follow_paths(mirrors)

    def follow(
        self, scene: SceneArrays, difference: Difference, mirrors: Mapping[int, int], is_fresh: bool = False
    ) -> None:
        """Know another state of the scene, whose geometry the `difference` has changed; `is_fresh`: see `Renderer`."""
        before, self._scene = self._scene, scene
        self._mirrors = dict(mirrors)
        if scene.materials is not before.materials or scene.images is not before.images:
            self.materials.follow(scene)
        elif difference.elsewhere or difference.structure or scene.origin != before.origin:
            self.materials.move(scene)
        self.lighting.follow(scene, difference, is_fresh)
        self.shade.follow(scene)
        self.indirect.follow(scene, difference)
        self.caustics.follow(scene)
        self._use_light()
        if difference.structure or not same_for_paths(before, scene):
            self._follow_paths(mirrors)
        elif difference.elsewhere and self.tracer is not None:
            self.tracer.move(scene)

    def light_surfaces(
        self, rays: Callable[[], RayScene], view_uniforms: Any, seconds: float | None = None, sub_frame: int = 0
    ) -> bool:
        """Find the light between surfaces and the caustics of a sub-frame, as far as they are not known: all, or for so
        long those of any; returns whether pictures are others by it."""
        means = Means(rays, self.materials, self.lighting, view_uniforms)
        is_changed = False
        if not self.indirect.is_settled:
            is_changed = self.indirect.prepare(means) if seconds is None else self.indirect.advance(means, seconds)
        elif seconds is not None and not self.caustics.is_settled:
            is_changed = self.caustics.advance(Thrower(means, self._mirrors, self.tracer), seconds)
        if seconds is None and self._settings.caustics:
            is_changed |= self.caustics.prepare(Thrower(means, self._mirrors, self.tracer), sub_frame)
        if is_changed:
            self._use_light()
        return is_changed

    def configure(self, settings: Settings) -> None:
        """For pictures by other settings."""
        before, self._settings = self._settings, settings
        if settings.samples != before.samples:
            self._resample(settings.samples)
        self.caustics.configure(settings)
        self.indirect.leave_caustics(settings.caustics)
        self._use_light()

    def _use_light(self) -> None:
        self.lighting.use(self.indirect.irradiance, self.caustics if self.caustics.is_thrown else None)

    def stage(self, mirrors: Sequence[Mirror], rays: Callable[[], RayScene]) -> Stage:
        """With the scene's mirrors, and what makes its rays when first asked."""
        return Stage(
            mirrors, self._geometry, self.materials, self.lighting, self.shade, rays, self.indirect, self.tracer
        )

    def load_some(self, seconds: float) -> bool:
        """See `Materials.load_some`."""
        is_changed = self.materials.load_some(seconds)
        if is_changed:
            # (What of it casts no shadow can be told only now.)
            self.lighting.follow(self._scene, Difference())
        return is_changed

    def loading(self, is_drawn: bool) -> str:
        """What is not there yet, for a panel; `is_drawn`: light can be looked for."""
        if self.materials.is_loading:
            return MATERIALS
        if is_drawn and not self.indirect.is_settled:
            return "light between surfaces"
        return "caustics" if is_drawn and not self.caustics.is_settled else ""

    @property
    def light_state(self) -> str:
        """Of light that comes from other surfaces, for a panel or a report."""
        thrown = f"; caustics of lamps: {self.caustics.state}" if self._settings.caustics else ""
        return f"{self.indirect.state}{thrown}"

    @property
    def ingredients(self) -> tuple[Hashable, ...]:
        """What decides which shaders the pictures take."""
        programs = tuple(self.materials.programs.admitted) if self.materials.has_programs else ()
        return (self.lighting.features, programs, self.needs.features, self.indirect.is_gathered)

    def _resample(self, samples: int) -> None:
        self.lighting.free()
        self.lighting = Lighting(self._scene, self._geometry, self.materials, samples)
        self.shade = ShadePass(self._scene, self.lighting, self.materials)
        self._use_light()
        self.indirect.restart()
        self.tracer = self._new_tracer()

    def warnings(self, method: Method) -> tuple[str, ...]:
        """What is not shown as it is, one sentence each."""
        found = [*self.needs.left_out_by(method)]
        found += (*self.materials.warnings, *self.lighting.warnings, *self.lighting.world_warnings)
        if not (method.follows_rays or method.chooses or method.solves_vertices):
            found += seen_in_spite_of_links(self._scene)
        if self.tracer is not None:
            found += self.tracer.warnings
        found += self.caustics.warnings
        return tuple(found)

    def free(self) -> None:
        """Let go of GPU resources that do not go by themselves."""
        self.lighting.free()
        self.tracer = None

    def _follow_paths(self, mirrors: Mapping[int, int]) -> None:
        """Of what the scene is made has changed, beside places."""
        self.needs = PathNeeds(self._scene, mirrors)
        if self.tracer is not None and self.tracer.features == self.needs.features:
            self.tracer.follow(self._scene)
        else:
            self.tracer = self._new_tracer()

    def _new_tracer(self) -> PathTracer | None:
        """Where the scene needs one."""
        features = self.needs.features
        return PathTracer(self._scene, features, self.lighting, self.materials) if features else None
