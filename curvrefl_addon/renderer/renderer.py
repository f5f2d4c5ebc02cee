# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer: (scene arrays, view, settings) -> a whole picture with true reflections on the chosen mirrors."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Generator, Hashable, Sequence
from dataclasses import replace
from functools import partial
from time import perf_counter
from typing import Any, Self

import numpy as np

from ..pacing.pieces import outcome, unpaced
from ..scene.arrays import Float64Array, SceneArrays
from ..scene.camera.shutter import Moment
from ..scene.camera.view import View
from .appearance import LIGHT_SECONDS, Appearance
from .device.context import require_gpu
from .diagnostic_light import DiagnosticLight
from .environments.cube import EnvironmentCube
from .exposure import ALL, Turn, expose, through_lens
from .frame import Frame, ReadBack, read_surfaces
from .geometry.placed_instances import Difference
from .geometry.scene_geometry import SceneGeometry
from .mirrors.mirror import Mirror, mirrors_of
from .noise import Convergence
from .placement import Placement, wanted_origin, with_depths_that_fit
from .preparation import Preparation
from .programs.image_pages import DEFAULT_CAP
from .rays.ray_scene import RayScene
from .rays.rays_on_demand import RaysOnDemand
from .reflection import Diagnostic, Reflection
from .seen import draw_seen
from .settings import Settings, check_settings
from .shown.rays import ShownRays, trace_seen_through
from .shown.shown import Light, Stage, chosen_mirrors
from .shown.targets import target_pool
from .surfaces.canvas import Canvas
from .surfaces.pixel_filter import offsets
from .surfaces.view_block import view_block
from .surfaces.windows import union
from .vertices.mirror_solver import require


class Renderer:
    """GPU resources of one scene, which may change: `update()`; `free()` when done.

    Of a view it keeps nothing but targets of its size: what was chosen and solved for it is its `Reflection`'s.
    """

    def __init__(
        self,
        scene: SceneArrays,
        settings: Settings | None = None,
        image_memory: int = DEFAULT_CAP,
        is_gradual: bool = False,
    ) -> None:
        """Upload the scene and bake its reflectors. `image_memory`: bytes that images of materials may take on the GPU.
        With `is_gradual` materials and images get there by and by: `load_some`.

        Raises InputError for settings out of range and for reflectors that no map can hold, GpuUnavailableError
        without a GPU context.
        """
        for _ in self._open(scene, settings or Settings(), image_memory, is_gradual):
            pass

    @classmethod
    def opened_in_steps(cls, scene: SceneArrays, settings: Settings, image_memory: int) -> Generator[str, None, Self]:
        """A gradual one, made in steps, each of which yields what comes next. Raises as the constructor."""
        renderer = cls.__new__(cls)
        yield from renderer._open(scene, settings, image_memory, is_gradual=True)
        return renderer

    def _open(self, scene: SceneArrays, settings: Settings, image_memory: int, is_gradual: bool) -> Generator[str]:
        self.settings = settings
        check_settings(self.settings)
        require_gpu()
        self.counters = Counter({"maps baked": 0})
        """How often something was made, since the start; beside those of `geometry`"""
        self.revision = 0
        """Another one when pictures are not the same any more"""
        self.mirrors: list[Mirror] = []
        self.geometry = SceneGeometry()
        self._targets = target_pool()
        self._preparation = Preparation()
        self.hierarchies = RaysOnDemand(self.geometry.facts, self.geometry.uploads)
        self.diagnostics = DiagnosticLight()
        self.is_gradual = is_gradual
        self._view_uniforms: Any = None
        self._jitter = offsets(self.settings.samples)
        self.placement = Placement(self.geometry.facts)
        self._given = scene
        for _ in self._following_scene(self.placement.placed(scene)):
            yield "meshes"
        yield "lights and materials"
        self._appearance = Appearance(self.scene, self.geometry, self._numbers, self.settings, image_memory, is_gradual)

    def update(self, scene: SceneArrays, is_fresh: bool = False) -> None:
        """Show another state of the scene: does again only what depends on arrays that are other objects than before;
        `is_fresh`: so that pictures are those of a new renderer. Raises as the constructor; it is of no use then.
        """
        if is_fresh:
            self._move_to(np.zeros(3))
            self.geometry.join()
        self.geometry.facts.is_loose = not is_fresh
        if scene is self._given:
            return
        self._given = scene
        self._follow(self.placement.placed(scene), is_fresh=is_fresh)
        self.revision += 1

    def _move_to(self, origin: Float64Array) -> None:
        """Have the scene's origin at another point (3,) of the world."""
        if not np.array_equal(origin, self.placement.origin):
            self.placement.move_to(origin)
            with unpaced():
                self._follow(self.placement.placed(self._given), anew=True)

    def _follow(self, scene: SceneArrays, anew: bool = False, is_fresh: bool = False) -> None:
        self._appearance.follow(scene, outcome(self._following_scene(scene, anew)), self._numbers, is_fresh)
        self.hierarchies.follow(scene, self._numbers)

    def configure(self, settings: Settings) -> None:
        """Render otherwise from now on. Raises as the constructor; then nothing has changed."""
        check_settings(settings)
        self._require(self.mirrors, settings)
        before, self.settings = self.settings, settings
        self._appearance.configure(settings)
        self._jitter = offsets(settings.samples)
        if (settings.samples, settings.environment_resolution) != (before.samples, before.environment_resolution):
            self._preparation.forget_cubes()
        self.revision += 1

    def free(self) -> None:
        """Let go of all GPU resources; the renderer is of no use afterwards."""
        self._appearance.free()
        self.mirrors = []
        self.geometry = SceneGeometry()
        self._targets = target_pool()
        self._preparation = Preparation()
        self.hierarchies.free()
        self.diagnostics = DiagnosticLight()

    def _following_scene(self, scene: SceneArrays, anew: bool = False) -> Generator[None, None, Difference]:
        """Mirrors and geometry, in steps."""
        mirrors = mirrors_of(scene, self.mirrors, self.geometry.facts, self.counters)
        self._require(mirrors, self.settings)
        self.mirrors, self.scene = mirrors, scene
        self._preparation.follow(scene, mirrors)
        return (yield from self.geometry.updating(scene, self._numbers, anew))

    @staticmethod
    def _require(mirrors: Sequence[Mirror], settings: Settings) -> None:
        """Bake what a method needs of all mirrors. Raises InputError for what a mirror cannot do."""
        if settings.entry.needs_map:
            for mirror in mirrors:
                require(settings.entry, mirror.shape(settings.map_resolution))

    @property
    def _numbers(self) -> dict[int, int]:
        """Mirrors' numbers by the index of their instance."""
        return {mirror.index: mirror.number for mirror in self.mirrors}

    @property
    def _stage(self) -> Stage:
        return self._appearance.stage(self.mirrors, self.rays)

    def environment_cubes(self) -> list[EnvironmentCube]:
        """One per mirror, drawn when first asked for."""
        return self._preparation.environment_cubes(self._stage, self.settings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is wrong with the scene whatever the view, one sentence each."""
        found = [*self.scene.warnings]
        if self.settings.entry.needs_map:
            for mirror in self.mirrors:
                found += mirror.shape(self.settings.map_resolution).warnings
        if self.mirrors and not any(self.geometry.scenery(mirror.index) for mirror in self.mirrors):
            found.append("There is nothing to reflect: no other object is visible to glossy rays.")
        found += self._appearance.warnings(self.settings.entry)
        found += self.hierarchies.warnings
        return tuple(found)

    def render(
        self,
        view: View,
        last: Reflection | None = None,
        moments: Sequence[Moment] = (),
        mirrors_alone: Canvas | None = None,
        before_sub_frame: Callable[[Convergence], None] | None = None,
        mirrors_only: bool = False,
        turn: Turn = ALL,
    ) -> Frame:
        """Draw the picture; times have the GPU's work in them. `last`: as for `reflect`; `moments`: one per sub-frame
        of the `turn`.

        `mirrors_alone`: an empty picture of the view's size, which gets what the mirrors show and nothing else; with
        `mirrors_only` the picture itself does. `before_sub_frame` is called with how far it has come; what that raises
        ends it.
        """
        canvas = Canvas.of_size(view.width, view.height)
        start = perf_counter()
        reflection = self.reflect(view, last=last, is_still=not (view.lens or moments), at_rest=True)
        reflection.wait()
        solved = perf_counter()
        still = Moment(self._given, view)
        asked = (moments, mirrors_alone, before_sub_frame, mirrors_only, turn)
        reflection, convergence = expose(self, canvas, reflection, still, *asked)
        canvas.wait()
        done = perf_counter()
        baked = sum(shape.bake_ms for mirror in self.mirrors for shape in mirror.baked)
        spans = {"solve": solved - start, "draw": done - solved, "frame": done - start}
        times = {"bake": baked + self.hierarchies.build_ms, **{name: 1e3 * span for name, span in spans.items()}}
        times["light"] = self._appearance.indirect.prepare_ms
        read = partial(self._read_while, self.revision)
        return Frame(reflection, canvas.texture, times, read, self._given, convergence, self.bounced_light)

    def reflect(
        self,
        view: View,
        solve: bool = True,
        last: Reflection | None = None,
        is_still: bool = False,
        at_rest: bool = False,
    ) -> Reflection:
        """What all sub-frames of a view share: the vertices' reflection points, or the cubes that stand for them.

        Without `solve`, for diagnostic views of the mirrors' surface alone. `last` is what was shown in the same
        viewport before: solves may start from its points, and a choice stays where the other is hardly better. What is
        only worth its time where the view rests is done `at_rest`: edges are split where their solved midpoints leave
        the chord. A picture on its own `is_still`: its sub-frames share one solve, which counts for `auto`.
        """
        # (At rest costs are counted as while the view moves, when sub-frames come one by one. A picture at less than
        # the full resolution may be drawn another way all the same.)
        origin = self.placement.origin
        view = view.about(origin)
        self._move_to(wanted_origin(view, origin, self.geometry, self.mirrors))
        view = with_depths_that_fit(view.about(self.placement.origin - origin), self.scene, self.geometry)
        origin = self.placement.origin
        self._view_uniforms = view_block(view)
        if self.settings.entry.is_environment and not self.is_gradual:
            self._find_light()
        if not solve:
            return Reflection(view, self.settings, (), self.warnings, origin=origin)
        # (Points about another origin are elsewhere.)
        last = last if last is not None and np.array_equal(last.origin, origin) else None
        found = self._preparation.reflect(
            self._stage, view, self.settings, self._appearance.needs.reasons, last, is_still, at_rest
        )
        return replace(found, warnings=(*self.warnings, *found.warnings), origin=origin)

    def add_sub_frame(
        self,
        canvas: Canvas,
        reflection: Reflection,
        index: int,
        weight: float,
        mirrors_only: bool = False,
        diagnostic: Diagnostic | None = None,
    ) -> None:
        """Add sub-frame `index` of `settings.samples` to a picture of the view's size.

        With `mirrors_only` the other pixels stay as they are, so that alpha becomes the mirrors' coverage; so it is
        with a `diagnostic` view.
        """
        self._move_to(reflection.origin)
        dx, dy = self._jitter[index]
        reflection = through_lens(self, reflection, index)
        view = reflection.view.jittered(-dx, -dy)
        window = union([mirror.window(view) for mirror in self.mirrors]) if mirrors_only else None
        if diagnostic is None and not self.is_gradual:
            self._find_light(sub_frame=index)
        jittered = replace(reflection, view=view)
        everywhere, of_meshes = diagnostic is not None, diagnostic is not None and diagnostic.of_meshes
        sub_frame = draw_seen(self._stage, self._targets, jittered, self.settings, window, everywhere, index, of_meshes)
        groups = reflection.groups
        if diagnostic is not None:
            self.diagnostics.add(canvas, reflection, sub_frame, weight, diagnostic)
            return
        self._appearance.lighting.prepare(index, sub_frame.sky_is_gathered)
        film = self.settings.film_transparent
        if not groups:
            seen, shadows = sub_frame.targets.seen, sub_frame.shadows
            self._appearance.shade.add(
                canvas, seen, None, sub_frame.uniforms, weight, window, None, shadows, film_transparent=film
            )
        for number, (kind, members) in enumerate(groups):
            chosen = chosen_mirrors(members, len(self.mirrors)) if len(groups) > 1 else None
            light = Light(canvas, weight, chosen, number == 0, film, reflection.calm)
            kind.add_light(members, sub_frame, light)
        by_rays = bool(groups) and groups[0][0] is ShownRays
        tracer = self._appearance.tracer
        if tracer is not None and tracer.sees_through and not (mirrors_only or by_rays):
            trace_seen_through(tracer, sub_frame, canvas, weight, self.settings)

    def rays(self) -> RayScene:
        """The scene as rays need it, made when first asked for."""
        return self.hierarchies.of(self.scene, self._numbers)

    def settle(self) -> None:
        """Make all hierarchies as good as they get."""
        self.hierarchies.finish()

    @property
    def ingredients(self) -> Hashable:
        """Others when pictures may need shaders that they did not need before."""
        return (self.settings, *self._appearance.ingredients)

    @property
    def loading(self) -> str:
        """What is not there yet, for a panel; nothing once all is."""
        return self._appearance.loading(is_drawn=self._view_uniforms is not None)

    @property
    def is_loading(self) -> bool:
        """Materials or images are not drawn as they are yet, or light between what was drawn is not all found."""
        return bool(self.loading)

    def load_some(self, seconds: float) -> None:
        """Go on with that: a program, images for about so long, light."""
        is_changed = self._appearance.load_some(seconds)
        if not self._appearance.materials.is_loading and self._view_uniforms is not None:
            is_changed |= self._find_light(LIGHT_SECONDS)
        self.revision += is_changed

    def _find_light(self, seconds: float | None = None, sub_frame: int = 0) -> bool:
        """Between surfaces, and caustics: see `Appearance.light_surfaces`."""
        if not self._appearance.light_surfaces(self.rays, self._view_uniforms, seconds, sub_frame):
            return False
        self._preparation.forget_cubes()
        return True

    @property
    def bounced_light(self) -> str:
        """See `Appearance.light_state`."""
        return self._appearance.light_state

    def _read_while(self, revision: int, reflection: Reflection, read: ReadBack) -> dict[str, Any]:
        if revision != self.revision:
            raise RuntimeError("The renderer shows another state of the scene by now: read the surfaces before.")
        return self.surfaces_of(reflection, read)

    def surfaces_of(self, reflection: Reflection, read: ReadBack = read_surfaces) -> dict[str, Any]:
        """Surface buffers through the pixel centers, read back (see `Frame`)."""
        self._move_to(reflection.origin)
        return read(reflection, draw_seen(self._stage, self._targets, reflection, self.settings))
