# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One view layer over the frames of a render: what a frame leaves as it was is neither read nor uploaded again."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import bpy

from ..errors import InputError
from ..options import current_options, filmed, mirrors_in, overrides_of, settings_of
from ..renderer.device.context import require_gpu
from ..renderer.frame import Frame
from ..renderer.noise import Convergence
from ..renderer.renderer import Renderer
from ..renderer.settings import Settings
from ..renderer.surfaces.canvas import Canvas
from ..scene.arrays import Float32Array, SceneArrays
from ..scene.camera.film import on_film
from ..scene.camera.shutter import Moment, ReadMoment, moments_at, read_moments
from ..scene.camera.view import View
from ..scene.changes import Changes
from ..scene.extract import SceneReader
from ..scene.opened.blend_file import find_reflectors, view_of_camera
from ..scene.opened.render_depsgraph import shown_of
from ..viewport.device_run import take_what_is_known
from .area import Area, area_of
from .earlier_frames import Drawn, EarlierFrames, Reuse
from .job import Job
from .passes import COMBINED, MIRROR, OF_MIRRORS, SLOW, UV, VECTOR, Pass, passes_of


class RenderSession:
    """Reads and draws a view layer; `free()` when done."""

    def __init__(self) -> None:
        self.warnings: tuple[str, ...] = ()
        """Of the last frame, one sentence each"""
        self._reader = SceneReader()
        self._renderer: Renderer | None = None
        self._arrays: SceneArrays | None = None
        self._settings = Settings()
        """With the sub-frames of all frames that are drawn on for one"""
        self._reuse = Reuse(self._settings)
        self._earlier = EarlierFrames()
        self._mirrors: list[bpy.types.Object] = []
        self._refused: list[str] = []
        self._asked: set[str] = set()
        """Names of passes, the job's among them"""

    def read(self, depsgraph: Any, job: Job | None) -> None:
        """The scene at the depsgraph's frame. Raises InputError for what a job names and cannot be a mirror."""
        scene, shown = filmed(depsgraph.scene), _shown(depsgraph)
        self._refused = []
        if job is None:
            chosen = settings_of(shown.curvrefl, shown.curvrefl.render_samples)
            mirrors = mirrors_in(depsgraph)
        else:
            chosen = job.settings
            mirrors = shown_of(depsgraph, find_reflectors(scene, job.reflectors))
            job.missing -= {obj.name for obj in mirrors}
        of_job = () if job is None else [OF_MIRRORS[name] for name in job.passes]
        self._asked = {item.name for item in (*passes_of(depsgraph.view_layer), *of_job)}
        self._reader.reads_uv = UV in self._asked
        self._reuse = Reuse(chosen)
        self._settings = replace(
            chosen, film_transparent=scene.render.film_transparent, samples=self._reuse.samples_of_all
        )
        while True:
            # All is read: what a new frame changes is not listed. What comes out as it was stays the same object.
            changes = Changes(everything=self._arrays is None, frame=True)
            try:
                self._arrays = self._reader.read(depsgraph, shown, mirrors, changes, overrides_of(mirrors))
                self._mirrors = mirrors
                return
            except InputError as error:
                uid = self._reader.uid_of(error.object_id)
                left = [obj for obj in mirrors if obj.session_uid != uid]
                if job is not None or len(left) == len(mirrors):
                    raise
                self._refused.append(str(error))
                mirrors = left

    def draw(
        self,
        depsgraph: Any,
        camera: bpy.types.Object,
        passes: list[Pass],
        job: Job | None,
        before_sub_frame: Callable[[Convergence], None],
        go_to: Callable[[int, float], None],
        pause: Callable[[], None],
    ) -> tuple[Area, dict[str, Float32Array]]:
        """The rendered area and its passes by name, Combined among them: (h, w, channels), row 0 at the bottom.

        `before_sub_frame` gets how far the picture has come; `go_to(frame, subframe)` shows the depsgraph at another
        time; `pause` is called while passes are made. What they raise ends it. Raises InputError for a camera that
        cannot be drawn and for mirrors that the method does not show, GpuUnavailableError without a GPU.
        """
        assert self._arrays is not None
        scene = filmed(depsgraph.scene)
        area = area_of(scene.render)
        view = area.view(view_of_camera(scene, camera, area.full_width, area.full_height, depsgraph))
        read_now = self._reading(depsgraph, camera, area)
        read_moment = self._reading(depsgraph, camera, area, may_be_hidden=True)
        still = Moment(self._arrays, view)
        moments, untold = read_moments(scene, still, self._reuse.samples, read_moment, go_to)
        has_mirrors = any(item.name == MIRROR for item in passes)
        # (Of a film's scene nothing else is seen.)
        only_mirrors = has_mirrors and scene != depsgraph.scene

        def drawn(at: Moment, times: Sequence[Moment], number: int) -> Drawn:
            alone = Canvas.of_size(view.width, view.height) if has_mirrors and not only_mirrors else None
            renderer = self._up_to_date(at.scene)
            frame = renderer.render(
                at.view,
                moments=times,
                mirrors_alone=alone,
                before_sub_frame=before_sub_frame,
                mirrors_only=only_mirrors,
                turn=self._reuse.turn(number),
            )
            return frame, alone, renderer

        if self._reuse.count:
            made_for = (self._settings, area, camera.session_uid, has_mirrors, only_mirrors, tuple(self._mirrors))
            frame, alone = self._earlier.draw(
                scene, camera, still, moments, made_for, self._reuse, (read_now, read_moment), go_to, drawn
            )
        else:
            frame, alone, _ = drawn(still, moments, 0)
        if not self._asked.isdisjoint(SLOW):
            frame.truth.pause = pause
        if VECTOR in self._asked:
            frame.truth.beside = _beside(scene, read_now, go_to)
        result = {COMBINED: _exposed(frame.color(), depsgraph)}
        for item in passes:
            if item.read is not None:
                result[item.name] = item.pixels(frame)
            else:
                result[item.name] = result[COMBINED] if alone is None else _exposed(alone.pixels(), depsgraph)
        if job is not None:
            job.convergence = frame.convergence
        if job is not None and not job.object_names:
            self._tell(job, frame, area)
        # (Of one that is left out as well the scene's own sentence is enough.)
        refused = [one for one in self._refused if not _is_said(one, frame.warnings)]
        remarks = () if self._asked.isdisjoint(SLOW) else dict.fromkeys(frame.truth.remarks)
        self.warnings = (*refused, *self._without_mirrors(frame), *frame.warnings, *untold, *remarks)
        return area, result

    @property
    def object_names(self) -> dict[int, str]:
        """By their numbers in passes."""
        assert self._arrays is not None
        return {instance.object_id: instance.object_name for instance in self._arrays.instances}

    def free(self) -> None:
        """Let go of all GPU resources."""
        self._earlier = EarlierFrames()
        if self._renderer is not None:
            self._renderer.free()
            self._renderer = None

    def _reading(self, depsgraph: Any, camera: bpy.types.Object, area: Area, may_be_hidden: bool = False) -> ReadMoment:
        """Reads what the depsgraph shows at its present time. `may_be_hidden`: mirrors that come or go while the
        shutter is open are not there at some moments; else that is an error."""
        scene = filmed(depsgraph.scene)

        def read_now(changes: Changes) -> tuple[SceneArrays, View]:
            mirrors = shown_of(depsgraph, self._mirrors) if may_be_hidden else self._mirrors
            arrays = self._reader.read(depsgraph, _shown(depsgraph), mirrors, changes, overrides_of(mirrors))
            return arrays, area.view(view_of_camera(scene, camera, area.full_width, area.full_height, depsgraph))

        return read_now

    def _up_to_date(self, arrays: SceneArrays) -> Renderer:
        require_gpu()
        if self._renderer is None:
            take_what_is_known()
            self._renderer = Renderer(arrays, self._settings, current_options().image_memory << 20)
            return self._renderer
        try:
            self._renderer.update(arrays, is_fresh=True)
            if self._renderer.settings != self._settings:
                self._renderer.configure(self._settings)
        except InputError:
            self.free()
            raise
        return self._renderer

    def _without_mirrors(self, frame: Frame) -> list[str]:
        assert self._arrays is not None
        if not self._arrays.reflectors:
            return ["No object is marked as a mirror: the picture has no reflections."]
        return [] if frame.mask().any() else ["No reflector is in view: the picture has no reflections."]

    def _tell(self, job: Job, frame: Frame, area: Area) -> None:
        assert self._arrays is not None
        if not job.multilayer:
            job.arrays = {name: area.uncropped(OF_MIRRORS[name].pixels(frame)) for name in job.passes}
        job.object_names = self.object_names


def _beside(
    scene: bpy.types.Scene, read_now: ReadMoment, go_to: Callable[[int, float], None]
) -> tuple[Moment | None, Moment | None]:
    """The frames before and after the present one; None where it cannot be read, as its mirrors cannot be ones."""
    found: list[Moment | None] = []
    for time in (-1.0, 1.0):
        try:
            found += moments_at(scene, (time,), read_now, go_to)
        except InputError:
            found.append(None)
    return found[0], found[1]


def _shown(depsgraph: Any) -> Any:
    """The evaluated scene whose settings count."""
    return filmed(depsgraph.scene).evaluated_get(depsgraph)


def _exposed(pixels: Float32Array, depsgraph: Any) -> Float32Array:
    """As on the film of Cycles; EEVEE's, which a film's scene joins, has no exposure."""
    return pixels if filmed(depsgraph.scene) != depsgraph.scene else on_film(pixels, depsgraph.scene_eval)


def _is_said(refusal: str, warnings: Sequence[str]) -> bool:
    """Whether a warning tells the same of the same object."""
    return any(warning.startswith(refusal.split(":")[0]) for warning in warnings)
