# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer: (scene arrays, view, settings) -> a whole picture with true reflections on the chosen mirrors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from time import perf_counter
from typing import Any

import gpu
import numpy as np

from ..diagnostic_colors import SOLVED_MODES, DiagnosticColors, DiagnosticOptions
from ..errors import InputError
from ..optics.catalogue import METHODS
from ..scene.arrays import Float32Array, Int32Array, SceneArrays
from ..scene.view import View
from .diagnostics import DiagnosticPass
from .environment import Environment
from .environment_cube import EnvironmentCube
from .environment_hits import environment_hits
from .environment_vertex import VertexLookups
from .exact import PathBuffer, Window
from .gpu_objects import cube_texture, read_texture, require_gpu
from .lighting import Lighting
from .materials import Materials
from .mirror import Mirror
from .pixel_filter import offsets
from .ray_scene import RayScene
from .scene_geometry import Difference, SceneGeometry
from .shade import ShadePass
from .solve import SolvedChunk, VertexSolution, statistics
from .surfaces import BackFaces, SurfaceBuffer, draw_primary, draw_reflected
from .view_block import view_block


@dataclass(frozen=True, slots=True)
class Settings:
    """How to render."""

    method: str = "secant_star"
    """A name of `optics.catalogue.METHODS`"""
    samples: int = 2
    """Jittered sub-frames of an anti-aliased picture; 1: pixel centres only, 16: a still"""
    pixel_tolerance: float = 0.5
    """Largest error of a reflected chord in pixels; the solver goes to a tenth of it"""
    map_resolution: int = 128
    """Texels along an edge of the reflector's radial cube map"""
    environment_resolution: int = 512
    """Texels along an edge of environment maps: of a cube's faces, of a sphere map's square"""
    steps: int = 0
    """Of methods with a fixed number of search steps; 0: the method's own"""
    grid_share: float = 0.1
    """Points of bounding grids that are solved, as a share of the vertices (`bisector_grid`)"""
    frustum: float = 1.25
    """Width of the view that is searched, in widths of the picture (`bisector_screen`)"""
    search_resolution: float = 1.0
    """Texels per pixel of the view that is searched (`bisector_screen`)"""
    bounces: int = 4
    """Mirrors on the way of a ray (`exact`); what the last one shows of a mirror is its own light alone"""


MOST_TARGETS = 3
"""Sizes of pictures whose targets are kept: a viewport draws smaller ones while it moves"""


@dataclass
class _Targets:
    """Everything that has the size of the picture."""

    width: int
    height: int
    seen: SurfaceBuffer = field(init=False)
    reflected: SurfaceBuffer = field(init=False)
    back_faces: BackFaces = field(init=False)
    vertex_lookups: VertexLookups | None = None
    """Made where a method needs them, as the next"""
    paths: list[PathBuffer] = field(default_factory=list)

    def path(self, bounce: int) -> PathBuffer:
        """Where rays get to after the mirror `bounce`, 0 for the first; two buffers take turns."""
        while len(self.paths) <= min(bounce, 1):
            self.paths.append(PathBuffer(self.width, self.height))
        return self.paths[bounce % 2]

    def __post_init__(self) -> None:
        self.seen = SurfaceBuffer(self.width, self.height)
        self.reflected = SurfaceBuffer(self.width, self.height)
        self.back_faces = BackFaces(self.width, self.height)


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """A view that shows how the picture comes about in place of the picture."""

    mode: str
    """A name of `diagnostic_colors.MODES`"""
    options: DiagnosticOptions = field(default_factory=DiagnosticOptions)
    colors: DiagnosticColors = field(default_factory=DiagnosticColors)

    @property
    def needs_solve(self) -> bool:
        """Whether it shows what the mirrors show, not their surface alone."""
        return self.mode in SOLVED_MODES


@dataclass(frozen=True)
class Reflection:
    """What the mirrors show in one view, before it is drawn."""

    view: View
    parts: tuple[tuple[SolvedChunk, ...], ...]
    """Per mirror, where vertices are solved, its scenery with the reflection points"""
    environments: tuple[Environment, ...] | None
    """Per mirror the environment that stands for what it reflects; None where vertices are solved"""
    warnings: tuple[str, ...]
    """One sentence each"""
    follows_rays: bool = False
    """Mirror pixels follow their rays: there is nothing to solve before"""

    @property
    def solutions(self) -> tuple[VertexSolution, ...]:
        """Of all mirrors and chunks: of every vertex its first image."""
        return tuple(part.solution for parts in self.parts for part in parts if part.image == 0)


class Renderer:
    """GPU resources of one scene, which may change: `update()`; `free()` when done."""

    def __init__(self, scene: SceneArrays, settings: Settings | None = None) -> None:
        """Upload the scene and bake its reflectors.

        Raises InputError for settings out of range and for reflectors that no map can hold, GpuUnavailableError
        without a GPU context.
        """
        self.settings = settings or Settings()
        _check(self.settings)
        require_gpu()
        self.counters = {"maps baked": 0}
        """How often something was made, since the start; beside those of `geometry`"""
        self.revision = 0
        """Another one when pictures are not the same any more"""
        self._warnings: tuple[int, tuple[str, ...]] | None = None
        self.mirrors: list[Mirror] = []
        self.geometry = SceneGeometry()
        self._targets: dict[tuple[int, int], _Targets] = {}
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
        _check(settings)
        before, self.settings = self.settings, settings
        try:
            if settings.map_resolution != before.map_resolution or not METHODS[settings.method].follows_rays:
                self._bake_mirrors(self.scene, keep=settings.map_resolution == before.map_resolution)
            for mirror in self.mirrors:
                mirror.require(settings.method)
        except InputError:
            self.settings = before
            raise
        if settings.samples != before.samples:
            self._jitter = offsets(settings.samples)
            self._lighting.free()
            self._lighting = Lighting(self.scene, self.geometry, settings.samples)
            self._shade = ShadePass(self.scene, self._lighting, self._materials)
        self._cubes = None
        self.revision += 1

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        if self._warnings is None or self._warnings[0] != self.revision:
            self._warnings = (self.revision, self._found_warnings())
        return self._warnings[1]

    def _found_warnings(self) -> tuple[str, ...]:
        found = [*self.scene.warnings, *(warning for mirror in self.mirrors for warning in mirror.warnings)]
        if self.mirrors and not any(self.geometry.scenery(mirror.index) for mirror in self.mirrors):
            found.append("There is nothing to reflect: no other object is visible to glossy rays.")
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
        return self.geometry.update(scene, self._numbers)

    @property
    def _numbers(self) -> dict[int, int]:
        """Mirrors' numbers by the index of their instance."""
        return {mirror.index: mirror.number for mirror in self.mirrors}

    def _bake_mirrors(self, scene: SceneArrays, keep: bool) -> None:
        """Reflectors of the scene; with `keep`, those that only moved keep their maps.

        A method that follows rays needs no maps.
        """
        resolution = 0 if METHODS[self.settings.method].follows_rays else self.settings.map_resolution
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
            mirror.require(self.settings.method)
            mirrors.append(mirror)
        self.mirrors = mirrors

    def render(self, view: View) -> Frame:
        """Draw the picture; its times have the GPU's work in them."""
        color = gpu.types.GPUTexture((view.width, view.height), format="RGBA32F")
        color.filter_mode(False)
        canvas = gpu.types.GPUFrameBuffer(color_slots=(color,))
        start = perf_counter()
        reflection = self.reflect(view, follow=False)
        for part in (part for parts in reflection.parts for part in parts):
            part.solution.wait()
        solved = perf_counter()
        with canvas.bind():
            canvas.clear(color=(0.0, 0.0, 0.0, 0.0))
        for index in range(self.settings.samples):
            self.add_sub_frame(canvas, reflection, index, 1.0 / self.settings.samples)
        with canvas.bind():
            canvas.read_color(0, 0, 1, 1, 4, 0, "FLOAT")
        done = perf_counter()
        times = {
            "bake": sum(mirror.bake_ms for mirror in self.mirrors) + (self._rays.build_ms if self._rays else 0.0),
            "solve": 1e3 * (solved - start),
            "draw": 1e3 * (done - solved),
            "frame": 1e3 * (done - start),
        }
        return Frame(self, reflection, color, times)

    def reflect(self, view: View, solve: bool = True, follow: bool = True) -> Reflection:
        """What all sub-frames of a view share: the vertices' reflection points, or the cubes that stand for them.

        Without `solve`, for diagnostic views of the mirrors' surface alone. With `follow` the solve may start from the
        last one's points.
        """
        if not solve:
            return Reflection(view, (), (), self.warnings)
        if METHODS[self.settings.method].follows_rays:
            self.rays()
            return Reflection(view, (), None, self.warnings, follows_rays=True)
        if any(mirror.holds_eye(view) for mirror in self.mirrors):
            black_cube = cube_texture(np.zeros((6, 1, 1, 4), np.float32))
            black = Environment("environment_cube", black_cube, lambda: black_cube)
            warning = "The eye is inside a reflector, which shows only itself there: its reflection is black."
            return Reflection(view, (), (black,) * len(self.mirrors), (*self.warnings, warning))
        if METHODS[self.settings.method].is_environment:
            environments = tuple(cube.environment(self.settings.method, view) for cube in self.environment_cubes())
            # Without a mirror the empty reflected buffer does.
            return Reflection(view, (), environments or None, self.warnings)
        tolerance = self.settings.pixel_tolerance
        self.geometry.refine([mirror.sight(view, tolerance) for mirror in self.mirrors])
        parts = tuple(
            mirror.solve(
                view,
                self.settings,
                self.geometry.scenery(mirror.index),
                self.geometry.of_instance(mirror.index),
                self._materials,
                follow,
            )
            for mirror in self.mirrors
        )
        return Reflection(view, parts, None, self.warnings)

    def add_sub_frame(
        self,
        canvas: Any,
        reflection: Reflection,
        index: int,
        weight: float,
        mirrors_only: bool = False,
        diagnostic: Diagnostic | None = None,
    ) -> None:
        """Add sub-frame `index` of `settings.samples` to the frame buffer `canvas`.

        With `mirrors_only` the other pixels stay as they are, so that alpha becomes the mirrors' coverage; so it is
        with a `diagnostic` view.
        """
        targets = self._targets_for(reflection.view)
        dx, dy = self._jitter[index]
        uniforms = self._draw_surfaces(targets, reflection.view.jittered(-dx, -dy), reflection)
        if diagnostic is not None:
            self._add_diagnostic(canvas, reflection, targets, uniforms, weight, diagnostic)
            return
        self._lighting.prepare(index)
        if reflection.follows_rays:
            self._shade.add(canvas, targets.seen, None, uniforms, weight, mirrors_only)
            window = self._window(reflection.view)
            bounces = self._bounces()
            for bounce, (mirrors, path) in enumerate(self._paths(targets, reflection, uniforms, bounces)):
                goes_on = bounce + 1 < bounces
                self._shade.add_path(canvas, mirrors, path, uniforms, weight, window, bounce == 0, goes_on)
            return
        shown = self._shown(targets, reflection, uniforms, of_positions=False)
        self._shade.add(canvas, targets.seen, shown, uniforms, weight, mirrors_only)

    def rays(self) -> RayScene:
        """The scene as rays need it, made when first asked for."""
        if self._rays is None:
            self._rays = RayScene(self.geometry.facts)
            self._rays.follow(self.scene, self._numbers)
        return self._rays

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

    def _bounces(self) -> int:
        """Mirrors that a ray can meet one after the other."""
        may_meet_another = len(self.mirrors) > 1 or any(not mirror.facts.never_sees_itself for mirror in self.mirrors)
        return self.settings.bounces if may_meet_another else 1

    def _window(self, view: View) -> Window:
        """Pixels that hold all mirrors."""
        windows = np.array([mirror.window(view) for mirror in self.mirrors], np.int64).reshape(-1, 4)
        windows = windows[(windows[:, 2] > 0) & (windows[:, 3] > 0)]
        if len(windows) == 0:
            return (0, 0, 0, 0)
        x, y = windows[:, :2].min(axis=0)
        right, top = (windows[:, :2] + windows[:, 2:]).max(axis=0)
        return (int(x), int(y), int(right - x), int(top - y))

    def _paths(
        self, targets: _Targets, reflection: Reflection, uniforms: Any, bounces: int
    ) -> Iterator[tuple[SurfaceBuffer, PathBuffer]]:
        """Of each bounce the mirrors that rays leave and where they get to; the buffers are used again."""
        mirrors = targets.seen
        inside = any(mirror.holds_eye(reflection.view) for mirror in self.mirrors)
        scale = max((mirror.bound for mirror in self.mirrors), default=1.0)
        window = self._window(reflection.view)
        for bounce in range(bounces if self.mirrors else 0):
            path = targets.path(bounce)
            path.follow(mirrors, self.rays(), self._materials, uniforms, window, inside, scale)
            yield mirrors, path
            mirrors = path

    def _add_diagnostic(
        self,
        canvas: Any,
        reflection: Reflection,
        targets: _Targets,
        uniforms: Any,
        weight: float,
        diagnostic: Diagnostic,
    ) -> None:
        if self._diagnostics is None or self._diagnostics.colors != diagnostic.colors:
            self._diagnostics = DiagnosticPass(diagnostic.colors)
        shown: SurfaceBuffer | tuple[Environment, ...]
        if reflection.follows_rays:
            shown = self._first_path(targets, reflection, uniforms)
        else:
            shown = self._shown(targets, reflection, uniforms, of_positions=diagnostic.needs_solve)
        methods = (self.settings.method,) * len(self.mirrors)
        self._diagnostics.add(
            canvas,
            targets.seen,
            shown,
            uniforms,
            weight,
            diagnostic.mode,
            diagnostic.options,
            methods,
            reflection.parts,
        )

    def _first_path(self, targets: _Targets, reflection: Reflection, uniforms: Any) -> PathBuffer:
        for _, path in self._paths(targets, reflection, uniforms, 1):
            return path
        path = targets.path(0)
        path.clear()
        return path

    def _shown(
        self, targets: _Targets, reflection: Reflection, uniforms: Any, of_positions: bool
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

    def _targets_for(self, view: View) -> _Targets:
        size = (view.width, view.height)
        if size not in self._targets:
            while len(self._targets) >= MOST_TARGETS:
                del self._targets[next(iter(self._targets))]
            self._targets[size] = _Targets(*size)
        return self._targets[size]

    def _draw_surfaces(self, targets: _Targets, view: View, reflection: Reflection) -> Any:
        """Geometry passes of one sub-frame; returns the view's uniform block."""
        uniforms = view_block(view)
        draw_primary(targets.seen, self.geometry.seen(view), self._materials, uniforms)
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
            path = self._first_path(targets, reflection, uniforms)
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

    def __init__(self, renderer: Renderer, reflection: Reflection, color: Any, times_ms: dict[str, float]) -> None:
        self._renderer = renderer
        self._reflection = reflection
        self.view = reflection.view
        self.color_texture = color
        """RGBA32F, scene-linear"""
        self.times_ms = times_ms
        """bake, solve, draw, frame = solve + draw"""
        self.warnings = reflection.warnings
        """One sentence each"""

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


def _check(settings: Settings) -> None:
    if settings.method not in METHODS:
        raise InputError(f'There is no method "{settings.method}": choose one of {", ".join(METHODS)}.')
    if not 1 <= settings.samples <= 1024:
        raise InputError(f"{settings.samples} samples are out of range: choose 1 to 1024.")
    if not 0.01 <= settings.pixel_tolerance <= 100.0:
        raise InputError(f"A tolerance of {settings.pixel_tolerance} pixels is out of range: choose 0.01 to 100.")
    if not 8 <= settings.map_resolution <= 2048:
        raise InputError(f"A map of {settings.map_resolution} texels is out of range: choose 8 to 2048.")
    if not 8 <= settings.environment_resolution <= 4096:
        raise InputError(
            f"An environment map of {settings.environment_resolution} texels is out of range: choose 8 to 4096."
        )
    if not 1 <= settings.bounces <= 64:
        raise InputError(f"{settings.bounces} bounces are out of range: choose 1 to 64.")
    if not 0 <= settings.steps <= 1000:
        raise InputError(f"{settings.steps} search steps are out of range: choose 0 (the method's own) to 1000.")
    if not 0.0 < settings.grid_share <= 1.0:
        raise InputError(f"A grid share of {settings.grid_share} is out of range: choose more than 0, at most 1.")
    if not 1.0 <= settings.frustum <= 4.0:
        raise InputError(f"A frustum factor of {settings.frustum} is out of range: choose 1 to 4.")
    if not 0.1 <= settings.search_resolution <= 4.0:
        raise InputError(
            f"A search resolution of {settings.search_resolution} texels per pixel is out of range: choose 0.1 to 4."
        )
