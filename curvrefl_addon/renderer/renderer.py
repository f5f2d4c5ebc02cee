# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer: (scene arrays, view, settings) -> a whole picture with true reflections on the chosen mirrors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from time import perf_counter
from typing import Any

import numpy as np

from ..errors import InputError
from ..optics.catalogue import METHODS
from ..scene.arrays import Float32Array, Int32Array, SceneArrays
from ..scene.view import View
from .choice import RAYS, Choice, Scenery, choose, in_shadow
from .device.context import require_gpu
from .device.cubes import cube_texture
from .device.textures import read_texture
from .environments.cube import EnvironmentCube
from .environments.hits import environment_hits
from .environments.vertex_lookups import VertexLookups
from .geometry.chunk import Batches, Chunk
from .geometry.scene_geometry import Difference, SceneGeometry
from .lighting.lighting import Lighting
from .mirrors.mirror import Mirror
from .rays.paths import Bounce
from .rays.ray_scene import RayScene
from .reflection import Diagnostic, Reflection
from .settings import Settings, check_settings
from .shading.diagnostics import DiagnosticPass
from .shading.lookup import Environment
from .shading.shade import ShadePass
from .surfaces.canvas import Canvas
from .surfaces.materials import Materials
from .surfaces.pixel_filter import offsets
from .surfaces.surfaces import SurfaceBuffer, Window, draw_primary, draw_reflected
from .surfaces.view_block import view_block
from .targets import Targets
from .vertices.solve import statistics

MOST_TARGETS = 3
"""Sizes of pictures whose targets are kept: a viewport draws smaller ones while it moves"""


class Renderer:
    """GPU resources of one scene, which may change: `update()`; `free()` when done."""

    def __init__(self, scene: SceneArrays, settings: Settings | None = None) -> None:
        """Upload the scene and bake its reflectors.

        Raises InputError for settings out of range and for reflectors that no map can hold, GpuUnavailableError
        without a GPU context.
        """
        self.settings = settings or Settings()
        """What was asked for"""
        check_settings(self.settings)
        self._used = _before_choosing(self.settings)
        """What is done: the same, or what `auto` has chosen in the view drawn last"""
        require_gpu()
        self.counters = {"maps baked": 0}
        """How often something was made, since the start; beside those of `geometry`"""
        self.revision = 0
        """Another one when pictures are not the same any more"""
        self._warnings: tuple[int, tuple[str, ...]] | None = None
        self.mirrors: list[Mirror] = []
        self.geometry = SceneGeometry()
        self._targets: dict[tuple[int, int], Targets] = {}
        self._choice: Choice | None = None
        self._scenery: Scenery | None = None
        """Of this scene, for choosing"""
        self._cubes: list[EnvironmentCube] | None = None
        self._rays: RayScene | None = None
        self._diagnostics: DiagnosticPass | None = None
        self._jitter = offsets(self.settings.samples)
        self._follow_scene(scene)
        self._materials = Materials(scene)
        self._lighting = Lighting(scene, self.geometry, self.settings.samples)
        self._shade = ShadePass(scene, self._lighting, self._materials)

    def update(self, scene: SceneArrays) -> None:
        """Show another state of the scene: does again only what depends on arrays that are other objects than before.

        Raises as the constructor; the renderer is of no use then.
        """
        before = self.scene
        if scene is before:
            return
        difference = self._follow_scene(scene)
        if scene.materials is not before.materials or scene.images is not before.images:
            self._materials.follow(scene)
        self._lighting.follow(scene, difference)
        self._shade.follow(scene)
        if self._rays is not None:
            self._rays.follow(scene, self._numbers)
        self._cubes = None
        self.revision += 1

    def configure(self, settings: Settings) -> None:
        """Render otherwise from now on. Raises as the constructor; then nothing has changed."""
        check_settings(settings)
        before, self.settings = self.settings, settings
        try:
            self._use(_before_choosing(settings))
        except InputError:
            self.settings = before
            raise
        if settings.samples != before.samples:
            self._jitter = offsets(settings.samples)
            self._lighting.free()
            self._lighting = Lighting(self.scene, self.geometry, settings.samples)
            self._shade = ShadePass(self.scene, self._lighting, self._materials)
            self._cubes = None
        if settings.environment_resolution != before.environment_resolution:
            self._cubes = None
        self.revision += 1

    def _use(self, settings: Settings) -> None:
        """Work by these from now on. Raises InputError for what a mirror cannot do; then nothing has changed."""
        before, self._used = self._used, settings
        mirrors = self.mirrors
        try:
            same_maps = settings.map_resolution == before.map_resolution
            if METHODS[settings.method].needs_map:
                self._bake_mirrors(self.scene, keep=same_maps)
            for mirror in self.mirrors:
                mirror.require(settings.method)
        except InputError:
            self._used = before
            raise
        # (Another method leaves the cubes as they are: whoever compares methods comes back to them.)
        if any(one is not other for one, other in zip(mirrors, self.mirrors, strict=True)):
            self._cubes = None

    def _choose(self, view: View, is_still: bool) -> None:
        """Let `auto` choose what is done in a view."""
        if not METHODS[self.settings.method].chooses:
            self._choice = None
            return
        if self._scenery is None:
            self._scenery = self._read_scenery()
        self._choice = choose(self.settings, view, self.mirrors, self._scenery, self._bumpy_mirrors(), is_still)
        if self._choice.settings == self._used:
            return
        self._use(self._choice.settings)
        if METHODS[self._used.method].needs_map and any(mirror.refusal is not None for mirror in self.mirrors):
            # Baking has shown that there is no map: the other way is chosen now.
            self._choice = choose(self.settings, view, self.mirrors, self._scenery, self._bumpy_mirrors(), is_still)
            self._use(self._choice.settings)

    def _read_scenery(self) -> Scenery:
        own = {mirror.index for mirror in self.mirrors}
        shown = [
            index
            for index, item in enumerate(self.geometry.placed)
            if index not in own and item.instance.visible_glossy and len(item.mesh.triangles)
        ]
        meshes = [self.geometry.placed[index].mesh for index in shown]
        return Scenery(
            *self.geometry.balls(np.array(shown, np.int64)),
            np.array([len(mesh.positions) for mesh in meshes], np.int64),
            np.array([len(mesh.triangles) for mesh in meshes], np.int64),
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        if self._warnings is None or self._warnings[0] != self.revision:
            self._warnings = (self.revision, self._found_warnings())
        return self._warnings[1] if self._rays is None else (*self._warnings[1], *self._rays.warnings)

    def _bumpy_mirrors(self) -> list[str]:
        """Names of mirrors with bumps or normal maps."""
        instances = [self.scene.instances[mirror.index] for mirror in self.mirrors]
        return [
            instance.object_name
            for instance in instances
            if any(self.scene.materials[index].relief is not None for index in instance.materials)
        ]

    def _found_warnings(self) -> tuple[str, ...]:
        found = [*self.scene.warnings, *(warning for mirror in self.mirrors for warning in mirror.warnings)]
        if self.mirrors and not any(self.geometry.scenery(mirror.index) for mirror in self.mirrors):
            found.append("There is nothing to reflect: no other object is visible to glossy rays.")
        if METHODS[self.settings.method].solves_vertices:
            found += [
                f'"{name}" is drawn without its bumps: choose Automatic, Exact or an environment method to see them.'
                for name in self._bumpy_mirrors()
            ]
        return (*found, *self._lighting.warnings)

    def free(self) -> None:
        """Let go of all GPU resources; the renderer is of no use afterwards."""
        self._lighting.free()
        self.mirrors = []
        self.geometry = SceneGeometry()
        self._targets.clear()
        self._cubes = self._diagnostics = self._rays = None

    def _follow_scene(self, scene: SceneArrays) -> Difference:
        """Mirrors and geometry."""
        self._bake_mirrors(scene, keep=True)
        self.scene = scene
        self._scenery = None
        return self.geometry.update(scene, self._numbers)

    @property
    def _numbers(self) -> dict[int, int]:
        """Mirrors' numbers by the index of their instance."""
        return {mirror.index: mirror.number for mirror in self.mirrors}

    def _bake_mirrors(self, scene: SceneArrays, keep: bool) -> None:
        """Reflectors of the scene; with `keep`, those that only moved keep their maps.

        A method that follows rays needs no maps.
        """
        resolution = self._used.map_resolution if METHODS[self._used.method].needs_map else 0
        chosen = [index for index, instance in enumerate(scene.instances) if instance.object_id in scene.reflectors]
        before: dict[int, list[Mirror]] = {}
        for old in self.mirrors if keep else ():
            before.setdefault(old.object_id, []).append(old)
        mirrors = []
        for number, index in enumerate(chosen, 1):
            instance = scene.instances[index]
            known = before.get(instance.object_id)
            mirror: Mirror | None = known.pop(0) if known else None
            if mirror is None or (resolution and not mirror.is_baked) or not mirror.follow(scene, index, number):
                facts = self.geometry.facts.of(scene.meshes[instance.mesh])
                mirror = Mirror(scene, index, number, facts, resolution)
                self.counters["maps baked"] += bool(resolution)
            mirror.require(self._used.method)
            mirrors.append(mirror)
        self.mirrors = mirrors

    def render(self, view: View) -> Frame:
        """Draw the picture; its times have the GPU's work in them."""
        canvas = Canvas.of_size(view.width, view.height)
        start = perf_counter()
        reflection = self.reflect(view, follow=False, at_rest=True)
        for part in (part for parts in reflection.parts for part in parts):
            part.solution.wait()
        solved = perf_counter()
        for index in range(self.settings.samples):
            self.add_sub_frame(canvas, reflection, index, 1.0 / self.settings.samples)
        canvas.wait()
        done = perf_counter()
        times = {
            "bake": sum(mirror.bake_ms for mirror in self.mirrors) + (self._rays.build_ms if self._rays else 0.0),
            "solve": 1e3 * (solved - start),
            "draw": 1e3 * (done - solved),
            "frame": 1e3 * (done - start),
        }
        return Frame(self, reflection, canvas.texture, times, self._choice)

    def reflect(self, view: View, solve: bool = True, follow: bool = True, at_rest: bool = False) -> Reflection:
        """What all sub-frames of a view share: the vertices' reflection points, or the cubes that stand for them.

        Without `solve`, for diagnostic views of the mirrors' surface alone. With `follow` the solve may start from the
        last one's points. What is only worth its time where the view rests is done `at_rest`: edges are split where
        their solved midpoints leave the chord.
        """
        # (At rest costs are counted as while the view moves, when sub-frames come one by one. A picture at less than
        # the full resolution may be drawn another way all the same.)
        self._choose(view, is_still=not follow)
        if not solve:
            return Reflection(view, (), (), self.warnings)
        used = self._used
        if METHODS[used.method].follows_rays:
            self.rays()
            return Reflection(view, (), None, self.warnings, follows_rays=True)
        if any(mirror.holds_eye(view) for mirror in self.mirrors):
            black_cube = cube_texture(np.zeros((6, 1, 1, 4), np.float32))
            black = Environment("environment_cube", black_cube, lambda: black_cube)
            warning = "The eye is inside a reflector, which shows only itself there: its reflection is black."
            return Reflection(view, (), (black,) * len(self.mirrors), (*self.warnings, warning))
        if METHODS[used.method].is_environment:
            environments = tuple(cube.environment(used.method, view) for cube in self.environment_cubes())
            # Without a mirror the empty reflected buffer does.
            return Reflection(view, (), environments or None, self.warnings)
        self.geometry.refine([mirror.sight(view, used.pixel_tolerance) for mirror in self.mirrors])
        parts = tuple(
            mirror.solve(
                view,
                used,
                self._scenery_shown(mirror, view),
                self.geometry.of_instance(mirror.index),
                self._materials,
                follow,
            )
            for mirror in self.mirrors
        )
        curves = METHODS[used.method].curves_edges
        if curves and at_rest:
            parts = tuple(
                mirror.with_curved_edges(
                    view,
                    used,
                    found,
                    self.geometry.of_instance(mirror.index),
                    self._materials,
                    self.geometry.longest_edge,
                )
                for mirror, found in zip(self.mirrors, parts, strict=True)
            )
        return Reflection(view, parts, None, self.warnings, is_final=at_rest or not curves)

    def _scenery_shown(self, mirror: Mirror, view: View) -> list[tuple[Chunk, Batches]]:
        """All that a mirror may show, but chunks that it cannot for sure: these are not solved."""
        parts = self.geometry.scenery(mirror.index)
        hidden = in_shadow(mirror, view, *self.geometry.chunk_balls([chunk for chunk, _ in parts]))
        return [part for part, is_hidden in zip(parts, hidden.tolist(), strict=True) if not is_hidden]

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
        targets = self._targets_for(reflection.view)
        dx, dy = self._jitter[index]
        view = reflection.view.jittered(-dx, -dy)
        window = self._window(view) if mirrors_only else None
        uniforms = self._draw_surfaces(targets, view, reflection, window if diagnostic is None else None)
        if diagnostic is not None:
            self._add_diagnostic(canvas, reflection, targets, view, uniforms, weight, diagnostic)
            return
        self._lighting.prepare(index)
        if reflection.follows_rays and self.mirrors:
            bounces = self._bounces(targets, view, uniforms, self._most_bounces())
            first = next(bounces)
            later = bounces if first.goes_on else None
            shadows = self.rays() if self._used.shadow_rays else None
            self._shade.add(canvas, targets.seen, first.path, uniforms, weight, window, later, shadows)
            return
        shown = self._shown(targets, reflection, uniforms, of_positions=False)
        self._shade.add(canvas, targets.seen, shown, uniforms, weight, window)

    def rays(self) -> RayScene:
        """The scene as rays need it, made when first asked for."""
        if self._rays is None:
            self._rays = RayScene(self.geometry.facts)
            self._rays.follow(self.scene, self._numbers)
        return self._rays

    @property
    def choice(self) -> Choice | None:
        """What `auto` has chosen in the view drawn last, and why."""
        return self._choice

    def settle(self) -> None:
        """Do at once all that `improve` would do."""
        if self._rays is not None:
            self._rays.finish()

    @property
    def ray_counters(self) -> dict[str, int]:
        """How often hierarchies were made, since the start."""
        return {} if self._rays is None else self._rays.counters

    @property
    def can_improve(self) -> bool:
        """Whether `improve` would do anything."""
        return self._rays is not None and self._rays.can_improve

    def improve(self) -> None:
        """Do a little work that makes later pictures faster, and no different."""
        if self._rays is not None:
            self._rays.improve()

    def _most_bounces(self) -> int:
        """Mirrors that a ray can meet one after the other."""
        may_meet_another = len(self.mirrors) > 1 or any(not mirror.facts.never_sees_itself for mirror in self.mirrors)
        return self.settings.bounces if may_meet_another else 1

    def _window(self, view: View) -> Window:
        """Pixels that hold all mirrors."""
        return union([mirror.window(view) for mirror in self.mirrors])

    def _bounces(
        self, targets: Targets, view: View, uniforms: Any, most: int, keeps_ways: bool = False
    ) -> Iterator[Bounce]:
        """What rays off the mirrors that the eye sees hit, then rays off the mirrors among that, and so on.

        Each is drawn when it is asked for, into buffers that the next but one uses again. With `keeps_ways` the buffers
        tell all they can, also of the last step.
        """
        mirrors = targets.seen
        inside = any(mirror.holds_eye(view) for mirror in self.mirrors)
        window = self._window(view)
        for number in range(most):
            path = targets.path(number)
            goes_on = number + 1 < most
            path.follow(mirrors, self.rays(), self._materials, uniforms, window, inside, goes_on or keeps_ways)
            yield Bounce(mirrors, path, window, goes_on)
            mirrors = path

    def _add_diagnostic(
        self,
        canvas: Canvas,
        reflection: Reflection,
        targets: Targets,
        view: View,
        uniforms: Any,
        weight: float,
        diagnostic: Diagnostic,
    ) -> None:
        if self._diagnostics is None or self._diagnostics.colors != diagnostic.colors:
            self._diagnostics = DiagnosticPass(diagnostic.colors)
        shown: SurfaceBuffer | tuple[Environment, ...]
        if reflection.follows_rays:
            shown = next(self._bounces(targets, view, uniforms, 1)).path
        else:
            shown = self._shown(targets, reflection, uniforms, of_positions=diagnostic.needs_solve)
        methods = (self._used.method,) * len(self.mirrors)
        self._diagnostics.add(
            canvas.frame_buffer,
            targets.seen,
            shown,
            uniforms,
            weight,
            diagnostic.mode,
            diagnostic.options,
            methods,
            reflection.parts,
        )

    def _shown(
        self, targets: Targets, reflection: Reflection, uniforms: Any, of_positions: bool
    ) -> SurfaceBuffer | tuple[Environment, ...]:
        """What stands for the reflected scene in the view of `uniforms`: light, or with `of_positions` geometry."""
        environments = reflection.environments
        if environments is None:
            return targets.reflected
        if not any(environment.lookup == "environment_cube_vertex" for environment in environments):
            return environments
        if targets.vertex_lookups is None:
            targets.vertex_lookups = VertexLookups(targets.width, targets.height)
        mirrors = [
            (mirror.number, self.geometry.of_instance(mirror.index), environment)
            for mirror, environment in zip(self.mirrors, environments, strict=True)
        ]
        return tuple(targets.vertex_lookups.draw(mirrors, targets.seen, uniforms, of_positions))

    def environment_cubes(self) -> list[EnvironmentCube]:
        """One per mirror, drawn when first asked for."""
        if self._cubes is None:
            centers, radii = self.geometry.balls()
            self._cubes = [
                EnvironmentCube(
                    mirror,
                    self.geometry.scenery(mirror.index),
                    float((np.linalg.norm(centers - mirror.center, axis=1) + radii).max()),
                    self._materials,
                    self._lighting,
                    self._shade,
                    self.settings.environment_resolution,
                )
                for mirror in self.mirrors
            ]
        return self._cubes

    def _targets_for(self, view: View) -> Targets:
        size = (view.width, view.height)
        if size not in self._targets:
            while len(self._targets) >= MOST_TARGETS:
                del self._targets[next(iter(self._targets))]
            self._targets[size] = Targets(*size)
        return self._targets[size]

    def _draw_surfaces(self, targets: Targets, view: View, reflection: Reflection, window: Window | None = None) -> Any:
        """Geometry passes of one sub-frame, in `window` alone if given; returns the view's uniform block."""
        uniforms = view_block(view)
        draw_primary(
            targets.seen,
            self.geometry.seen(view),
            self._materials,
            uniforms,
            window,
            lambda chunk: self.geometry.hidden_faces(chunk, view),
            with_reliefs=not METHODS[self._used.method].solves_vertices,
        )
        if reflection.environments is None and not reflection.follows_rays:
            targets.reflected.clear()
            for mirror, parts in zip(self.mirrors, reflection.parts, strict=True):
                if mirror.may_hide_itself:
                    targets.back_faces.draw(self.geometry.of_instance(mirror.index), uniforms)
                draw_reflected(
                    targets.reflected,
                    targets.seen,
                    mirror.number,
                    targets.back_faces if mirror.may_hide_itself else None,
                    parts,
                    self._materials,
                    uniforms,
                    depth_scale=mirror.bound,
                    window=mirror.window(view),
                )
        return uniforms

    def surfaces_of(self, reflection: Reflection) -> dict[str, Float32Array]:
        """Surface buffers through the pixel centres, read back (see `Frame`)."""
        targets = self._targets_for(reflection.view)
        uniforms = self._draw_surfaces(targets, reflection.view, reflection)
        arrays = {
            "seen_position": read_texture(targets.seen.position),
            "seen_normal": read_texture(targets.seen.normal),
            "seen_color": read_texture(targets.seen.color),
        }
        if reflection.follows_rays:
            path = next(self._bounces(targets, reflection.view, uniforms, 1, keeps_ways=True)).path
            arrays["reflected_position"] = read_texture(path.position)
            arrays["reflected_color"] = read_texture(path.color)
            arrays["reflected_color"][..., 3] = read_texture(path.direction)[..., 3]
            return arrays
        shown = self._shown(targets, reflection, uniforms, of_positions=True)
        if isinstance(shown, SurfaceBuffer):
            arrays["reflected_position"] = read_texture(shown.position)
            arrays["reflected_color"] = read_texture(shown.color)
        else:
            arrays["reflected_position"] = environment_hits(targets.seen, shown, uniforms)
        return arrays


class Frame:
    """One picture and what is behind it. Arrays are copies, float32, row 0 at the bottom; valid until `free()`."""

    def __init__(
        self,
        renderer: Renderer,
        reflection: Reflection,
        color: Any,
        times_ms: dict[str, float],
        choice: Choice | None = None,
    ) -> None:
        self._renderer = renderer
        self._reflection = reflection
        self.view = reflection.view
        self.color_texture = color
        """RGBA32F, scene-linear"""
        self.times_ms = times_ms
        """bake, solve, draw, frame = solve + draw"""
        self.warnings = reflection.warnings
        """One sentence each"""
        self.choice = None if choice is None else choice.as_report()
        """What `auto` has chosen, and why"""

    @cached_property
    def solve(self) -> dict[str, Any]:
        """Counts and iterations over all mirrors, as `report.json` has them."""
        return statistics(self._reflection.solutions)

    @cached_property
    def surfaces(self) -> dict[str, Float32Array]:
        """Surface buffers through the pixels' centres (h, w, 4): see `SurfaceBuffer`; keys seen_position, seen_normal,
        seen_color, reflected_position and, where vertices are solved, reflected_color. From an environment,
        reflected_position has the direction of the background, too, with w = 0."""
        return self._renderer.surfaces_of(self._reflection)

    def color(self) -> Float32Array:
        """(h, w, 4) scene-linear picture, anti-aliased."""
        return read_texture(self.color_texture)

    def mask(self) -> Int32Array:
        """(h, w) object_id of the reflector at the pixel's centre, 0 elsewhere."""
        ids = np.rint(self.surfaces["seen_position"][..., 3]).astype(np.int32)
        return np.where(self.surfaces["seen_color"][..., 3] > 0.5, ids, 0)

    def reflector_position(self) -> Float32Array:
        """(h, w, 3) world point P seen at the pixel's centre; meant for the pixels of `mask`."""
        return self.surfaces["seen_position"][..., :3]

    def reflected_position(self) -> Float32Array:
        """(h, w, 4) world point that the mirror shows there (w = 1), or the background's unit direction (w = 0)."""
        return self._reflected[0]

    def reflected_object(self) -> Int32Array:
        """(h, w) object_id of that point, 0 for the background."""
        return self._reflected[1]

    def iterations(self) -> Float32Array:
        """(h, w) solver iterations, interpolated over the reflected triangles."""
        if "reflected_color" not in self.surfaces:
            return np.zeros((self.view.height, self.view.width), np.float32)
        return self.surfaces["reflected_color"][..., 3]

    @cached_property
    def _reflected(self) -> tuple[Float32Array, Int32Array]:
        mask = self.mask() > 0
        seen, normal = self.surfaces["seen_position"][..., :3], self.surfaces["seen_normal"][..., :3]
        eye = self.view.eye
        to_eye = eye[:3] - seen * eye[3]
        to_eye /= np.maximum(np.linalg.norm(to_eye, axis=-1, keepdims=True), 1e-30)
        direction = 2.0 * (normal * to_eye).sum(-1, keepdims=True) * normal - to_eye
        hits = self.surfaces["reflected_position"]
        ids = np.where(mask, np.rint(hits[..., 3]), 0).astype(np.int32)
        position = np.zeros((*mask.shape, 4), np.float32)
        # Environment lookups say themselves in which direction they see the background.
        found = (hits[..., :3] != 0.0).any(axis=-1, keepdims=True)
        position[..., :3] = np.where(found, hits[..., :3], direction)
        position[..., 3] = ids > 0
        position[~mask] = 0.0
        return position, ids


def union(windows: Sequence[Window]) -> Window:
    """A window that holds all of these; an empty one where all are."""
    some = np.array([window for window in windows if window[2] > 0 and window[3] > 0], np.int64)
    if len(some) == 0:
        return (0, 0, 0, 0)
    x, y = some[:, :2].min(axis=0).tolist()
    right, top = (some[:, :2] + some[:, 2:]).max(axis=0).tolist()
    return (x, y, right - x, top - y)


def _before_choosing(settings: Settings) -> Settings:
    """What is done before a view is known: no method may have to be baked for in vain."""
    return replace(settings, method=RAYS) if METHODS[settings.method].chooses else settings
