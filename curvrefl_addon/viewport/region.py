# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of one region of a window: coarse while something moves, finer while it rests."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from ..diagnostics.colors import Legend
from ..inspection.chosen import diagnostic_of
from ..optics.catalog import label_of
from ..pacing.pieces import OutOfTime, paced
from ..renderer.appearance import MATERIALS
from ..renderer.choice import RAYS
from ..renderer.device.textures import read_texture
from ..renderer.noise import Convergence, NoiseMeter
from ..renderer.reflection import Diagnostic, Reflection
from ..renderer.renderer import Renderer
from ..renderer.surfaces.canvas import Canvas
from ..renderer.vertices.solution import statistics
from ..scene.camera.lens import Lens, lens_of
from ..scene.camera.view import View
from .composite import composite
from .motion_resolution import FIXED, MotionResolution
from .opening import SLICE_SECONDS
from .rehearsal import Rehearsal

if TYPE_CHECKING:
    from .shown_scene import ViewportScene

LOADING_SECONDS = 0.05
"""In each redraw, for images of materials that are not there yet"""
REFRESH_SECONDS = 0.5
"""Pictures without all of their images are shown for so long"""
SETTLED_SECONDS = 0.15
"""After the last change the full resolution is drawn again"""


class RegionPicture:
    """Sum of the sub-frames drawn so far, and what they show."""

    def __init__(self, scene: ViewportScene, renderer: Renderer) -> None:
        self.scene = scene
        self.renderer = renderer
        self._view: View | None = None
        """At full resolution"""
        self._state: tuple[int, Diagnostic | None] = (0, None)
        """Revision of the renderer and what is shown, at the last change"""
        self._reflection: Reflection | None = None
        self._canvas: Canvas | None = None
        self._divisor = 1
        self._motion = MotionResolution()
        self._is_sharp = True
        """Drawn without the lens"""
        self._sub_frames = 0
        self._meter: NoiseMeter | None = None
        """Of a picture at rest"""
        self._changed_at = 0.0
        self._rows: list[tuple[str, str]] = []
        self._solve_ms = self._draw_ms = 0.0
        self._measuring = ""
        """What is measured next of the mirrors' shape, for a diagnostic view"""
        self._rehearsal: Rehearsal | None = None
        """Of the next picture, while this one is shown"""
        self._rehearsed: dict[bool, Hashable] = {}
        """For pictures at rest and others, with which of the renderer's ingredients"""

    @property
    def progress(self) -> str:
        """What the next pictures wait for, in a few words; nothing once all is there."""
        if self._measuring:
            return self._measuring
        return self.renderer.loading if self._rehearsal is None else self._rehearsal.left

    @property
    def is_coarse(self) -> bool:
        """Drawn at less than the full resolution, or with less care: it is worth another go once all rests."""
        if self._divisor > 1 or self._reflection is None or self._view is None:
            return self._divisor > 1
        return not self._reflection.is_final or (self._is_sharp and self._view.lens is not None)

    @property
    def is_complete(self) -> bool:
        """No sub-frame is left to draw."""
        return self._convergence.is_enough(self.renderer.settings.noise_limit)

    @property
    def _convergence(self) -> Convergence:
        if self._meter is not None:
            return self._meter.convergence
        return Convergence(self._sub_frames, self.renderer.settings.samples, None)

    @property
    def has_work(self) -> bool:
        """There is something left to do while the view rests."""
        return not self.is_complete or self.renderer.hierarchies.can_improve or bool(self.progress)

    def advance(
        self, view: View, settings: Any, options: Any, now: float, is_timed: bool, counters: dict[str, int]
    ) -> None:
        """Draw the next sub-frame of `view`, from the start where something is not as before.

        `settings`: Scene.curvrefl; `options`: the preferences; `now`: seconds of a monotonic clock. Where it `is_timed`
        the times wait for the GPU.
        """
        diagnostic = diagnostic_of(settings, options)
        if diagnostic is not None:
            view = replace(view, lens=None)
        if self._rehearsal is None:
            self.renderer.load_some(LOADING_SECONDS)
        state = (self.renderer.revision, diagnostic)
        divisor, at_rest = 0, False
        is_another = self._view is None or diagnostic != self._state[1] or not _is_same(self._view, view)
        # (While images come in, one in each redraw, the picture is not begun again for each.)
        waits = self.renderer.loading == MATERIALS and now - self._changed_at < REFRESH_SECONDS
        if is_another or (state != self._state and not waits):
            divisor = FIXED.get(settings.motion_resolution, self._motion.divisor)
        elif state == self._state and self.is_coarse and now - self._changed_at >= SETTLED_SECONDS:
            divisor, at_rest = 1, True
        if not self._is_measured(diagnostic, view):
            return
        if is_another or diagnostic is not None:
            self._rehearsal = None
        elif divisor and not self._is_rehearsed(view, at_rest):
            return
        if divisor and not at_rest:
            self._changed_at = now
        follows_time = bool(divisor) and not at_rest and settings.motion_resolution not in FIXED
        is_measured = follows_time and self._motion.wants_time()
        begun = perf_counter()
        if divisor:
            self._start(view, divisor, diagnostic, is_timed, counters, at_rest)
        else:
            self.renderer.hierarchies.improve()
        if divisor:
            self._view, self._state = view, state
        # (What is not whole yet is begun again soon: one sub-frame of it is enough.)
        if not self.is_complete and not (self._sub_frames and self.renderer.is_loading):
            assert self._reflection is not None and self._canvas is not None
            start = perf_counter()
            self.renderer.add_sub_frame(
                self._canvas, self._reflection, self._sub_frames, 1.0, mirrors_only=True, diagnostic=diagnostic
            )
            if is_timed:
                self._canvas.wait()
                self._draw_ms = 1e3 * (perf_counter() - start)
            if is_measured:
                self._canvas.wait()
                self._motion.note(1e3 * (perf_counter() - begun))
            self._sub_frames += 1
            if self._meter is not None:
                self._meter.look(self._sub_frames)
            counters["sub-frames"] = counters.get("sub-frames", 0) + 1

    def _is_rehearsed(self, view: View, at_rest: bool) -> bool:
        """Whether all that pictures of a view need is made; goes on with that."""
        wanted = self.renderer.ingredients
        if not self.renderer.is_gradual or self._rehearsed.get(at_rest) == wanted:
            return True
        if self._rehearsal is None or self._rehearsal.made_for != (wanted, at_rest):
            self._rehearsal = Rehearsal(self.renderer, at_rest)
        if not self._rehearsal.advance(view, SLICE_SECONDS):
            return False
        self._rehearsal = None
        self._rehearsed[at_rest] = wanted
        return True

    def _is_measured(self, diagnostic: Diagnostic | None, view: View) -> bool:
        """Whether all that a diagnostic view shows of the mirrors' shape is known; goes on with that."""
        self._measuring = ""
        if diagnostic is None or diagnostic.mode != "CURVATURE":
            return True
        try:
            with paced(SLICE_SECONDS):
                self.renderer.diagnostics.curvatures.prepare(self.renderer.mirrors)
        except OutOfTime as left:
            self._measuring = str(left)
            # (Until then what was shown last; nothing, where that is nothing.)
            self._canvas = self._canvas or Canvas.of_size(view.width, view.height, linear=True)
            return False
        return True

    def legend(self) -> Legend | None:
        """What the colors of the diagnostic view mean that is shown; None where they mean nothing."""
        diagnostic = self._state[1]
        return None if diagnostic is None else self.renderer.diagnostics.legend(diagnostic, self.methods)

    def composite(self, frame_buffer: Any, viewport: tuple[int, int, int, int]) -> None:
        """Put the picture over the viewport's own."""
        assert self._canvas is not None
        composite(self._canvas, self._sub_frames, frame_buffer, viewport)

    def pixels(self) -> np.ndarray:
        """Mean of the sub-frames drawn so far, read from the GPU: (height, width, 4), scene-linear, premultiplied."""
        assert self._canvas is not None
        return read_texture(self._canvas.texture) / max(self._sub_frames, 1)

    def statistics(self) -> list[tuple[str, str]]:
        """Rows for the panel; read from the GPU once for each picture, when it rests."""
        if not self._rows and self._reflection is not None and self._reflection.solutions and not self.is_coarse:
            found = statistics(self._reflection.solutions)
            self._rows = [
                ("Vertices", f"{found['vertices']:,}"),
                ("Reflected", f"{found['reflected']:,}"),
                ("Hidden", f"{found['hidden']:,}"),
                ("Failed", f"{found['unconverged']:,}"),
                ("Iterations", f"{found['iterations']['mean']:.1f}"),
            ]
        if not self._rows and self.methods == (RAYS,) and not self.is_coarse:
            self._rows = [("Rays", "followed"), ("Bounces", str(self.renderer.settings.bounces))]
        progress = [] if self.is_coarse or self._meter is None else [("Samples", str(self._convergence))]
        times = [("Solve", self._solve_ms), ("Draw", self._draw_ms)] if self._rows else []
        choice = None if self._reflection is None else self._reflection.choice
        chosen = []
        if choice is not None:
            labels = [label_of(name) for name in choice.methods]
            chosen = [
                ("Chosen", ", ".join(labels)),
                ("Not Reflected", f"{choice.hidden} of {choice.hidden + choice.shown} objects"),
            ]
        light = [("Bounced Light", self.renderer.bounced_light)] if self._reflection is not None else []
        return [*chosen, *progress, *light, *self._rows, *((label, f"{ms:.1f} ms") for label, ms in times if ms > 0.0)]

    @property
    def reason(self) -> str:
        """Why `auto` has chosen as it has, one sentence; nothing for other methods."""
        choice = None if self._reflection is None else self._reflection.choice
        return "" if choice is None else choice.why

    @property
    def methods(self) -> tuple[str, ...]:
        """Catalog names by which its mirrors are shown, each once."""
        return () if self._reflection is None else tuple(dict.fromkeys(self._reflection.methods))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the picture does not show, one sentence each."""
        return () if self._reflection is None else self._reflection.warnings

    def _start(
        self,
        view: View,
        divisor: int,
        diagnostic: Diagnostic | None,
        is_timed: bool,
        counters: dict[str, int],
        at_rest: bool,
    ) -> None:
        # Depth of field takes all sub-frames: while something moves it would only shake.
        self._is_sharp = not at_rest
        lens = None if self._is_sharp else view.lens
        size = (max(view.width // divisor, 1), max(view.height // divisor, 1))
        small = replace(view, width=size[0], height=size[1], lens=lens, stands_for=divisor)
        texture = None if self._canvas is None else self._canvas.texture
        if self._canvas is None or (texture.width, texture.height) != (small.width, small.height):
            self._canvas = Canvas.of_size(small.width, small.height, linear=True)
        else:
            self._canvas.clear()
        start = perf_counter()
        is_solved = diagnostic is None or diagnostic.needs_solve
        self._reflection = self.renderer.reflect(small, solve=is_solved, last=self._reflection, at_rest=at_rest)
        self._solve_ms = self._draw_ms = 0.0
        if is_timed:
            self._reflection.wait()
            self._solve_ms = 1e3 * (perf_counter() - start)
        self._divisor, self._sub_frames, self._rows = divisor, 0, []
        samples = self.renderer.settings.samples
        # (While something moves a picture hardly gets beyond its first sub-frame.)
        self._meter = None if divisor > 1 or diagnostic is not None else NoiseMeter(self._canvas, samples, 1.0)
        counters["solves"] = counters.get("solves", 0) + 1


def view_of(context: bpy.types.Context) -> View:
    """The eye of a region, with the camera's lens where the viewport shows its depth of field."""
    data = context.region_data
    world_to_view = np.array(data.view_matrix, np.float64)
    return View(
        world_to_view,
        np.array(data.window_matrix, np.float64),
        context.region.width,
        context.region.height,
        _lens_shown(context, world_to_view),
    )


def view_of_area(context: bpy.types.Context, area: bpy.types.Area) -> View:
    """As `view_of`, of a 3D viewport, wherever in it one is."""
    region = next(region for region in area.regions if region.type == "WINDOW")
    with context.temp_override(area=area, region=region):
        return view_of(bpy.context)


def _lens_shown(context: bpy.types.Context, world_to_view: np.ndarray) -> Lens | None:
    space, scene = context.space_data, context.scene
    if not isinstance(space, bpy.types.SpaceView3D) or scene is None or context.region_data is None:
        return None
    if context.region_data.view_perspective != "CAMERA":
        return None
    shading = space.shading
    shows = shading.use_dof if shading.type == "SOLID" else shading.type in ("MATERIAL", "RENDERED")
    camera = (space.camera if space.use_local_camera else None) or scene.camera
    if not shows or camera is None or not isinstance(camera.data, bpy.types.Camera) or not camera.data.dof.use_dof:
        return None
    depsgraph = context.evaluated_depsgraph_get()
    data: Any = camera.evaluated_get(depsgraph).data
    return lens_of(data, np.linalg.inv(world_to_view), depsgraph)


def _is_same(one: View, other: View) -> bool:
    return (
        (one.width, one.height) == (other.width, other.height)
        and np.array_equal(one.world_to_view, other.world_to_view)
        and np.array_equal(one.view_to_clip, other.view_to_clip)
        and one.lens == other.lens
    )
