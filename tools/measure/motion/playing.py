# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plays frames of the open file as a viewport does while time goes on: each picture starts from that before."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from time import perf_counter, process_time
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.renderer.reflection import Reflection
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.scene.changes import Changes
from curvrefl.curvrefl_addon.scene.extract import SceneReader
from curvrefl.curvrefl_addon.scene.opened.blend_file import find_camera, view_of_camera
from curvrefl.curvrefl_addon.viewport.motion_resolution import MotionResolution
from curvrefl.curvrefl_addon.viewport.region import LOADING_SECONDS


class Film:
    """Frames of the open file: what a viewport reads of each."""

    def __init__(self, mirrors: Sequence[str], size: tuple[int, int]) -> None:
        self.mirrors = [bpy.data.objects[name] for name in mirrors]
        self.size = size
        self._reader = SceneReader()
        self._changes = Changes(everything=True)
        self.read_ms = 0.0
        """What reading took in the frame last read"""

    @contextmanager
    def playing(self) -> Iterator[None]:
        """While the depsgraph's changes are listened to."""
        lists: list[Any] = [bpy.app.handlers.depsgraph_update_post, bpy.app.handlers.frame_change_post]
        for handlers in lists:
            handlers.append(self._note)
        try:
            yield
        finally:
            for handlers in lists:
                handlers.remove(self._note)

    def _note(self, _scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        self._changes.add(depsgraph.updates)

    def frame(self, number: int) -> tuple[SceneArrays, View]:
        """The scene at a frame, with what of it is as before as the same arrays, and what its camera sees."""
        scene: Any = bpy.context.scene
        scene.frame_set(number)
        start = perf_counter()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        changes, self._changes = self._changes, Changes()
        arrays = self._reader.read(depsgraph, scene, self.mirrors, changes)
        self.read_ms = 1e3 * (perf_counter() - start)
        return arrays, view_of_camera(scene, find_camera(scene), *self.size, depsgraph)


@dataclass
class Showing:
    """One way of showing the mirrors, frame after frame."""

    method: str
    follows_time: bool = False
    """At the resolution that a viewport takes while something moves, *Automatic*; else at the film's own"""
    motion: MotionResolution = field(default_factory=MotionResolution)
    renderer: Renderer | None = None
    reflection: Reflection | None = None
    canvas: Canvas | None = None
    times_ms: list[float] = field(default_factory=list)
    """Of all frames drawn, until the GPU had finished"""
    cpu_ms: list[float] = field(default_factory=list)
    """The same by the time of all threads, reading left out"""
    methods: list[tuple[str, ...]] = field(default_factory=list)
    """By which each frame's mirrors were shown"""

    def draw(self, scene: SceneArrays, view: View, read_ms: float = 0.0) -> None:
        """One sub-frame, as while something moves. The first waits until all is there, and is drawn again then."""
        if self.renderer is None:
            self._open(scene, view)
            read_ms = 0.0
        is_measured = self.follows_time and self.motion.wants_time()
        start, start_cpu = perf_counter(), process_time()
        self._redraw(scene, view)
        assert self.canvas is not None and self.reflection is not None
        self.canvas.wait()
        self.cpu_ms.append(1e3 * (process_time() - start_cpu))
        drawn_ms = 1e3 * (perf_counter() - start)
        if is_measured:
            self.motion.note(drawn_ms)
        self.times_ms.append(drawn_ms + read_ms)
        self.methods.append(self.reflection.methods)

    def free(self) -> None:
        """Let go of GPU resources."""
        if self.renderer is not None:
            self.renderer.free()
        self.renderer = self.reflection = self.canvas = None

    def surfaces(self) -> dict[str, np.ndarray]:
        """Surface buffers of what was drawn last: see `Frame.surfaces`."""
        assert self.renderer is not None and self.reflection is not None
        return self.renderer.surfaces_of(self.reflection)

    def _open(self, scene: SceneArrays, view: View) -> None:
        self.renderer = Renderer(scene, Settings(method=self.method), is_gradual=True)
        self._redraw(scene, view)
        while self.renderer.is_loading or self.renderer.hierarchies.can_improve:
            self.renderer.hierarchies.improve()
            self._redraw(scene, view)
        assert self.canvas is not None
        self.canvas.wait()

    def _redraw(self, scene: SceneArrays, view: View) -> None:
        assert self.renderer is not None
        divisor = self.motion.divisor if self.follows_time else 1
        size = (max(view.width // divisor, 1), max(view.height // divisor, 1))
        view = replace(view, width=size[0], height=size[1], stands_for=divisor)
        texture = None if self.canvas is None else self.canvas.texture
        if self.canvas is None or (texture.width, texture.height) != size:
            self.canvas = Canvas.of_size(*size, linear=True)
        else:
            self.canvas.clear()
        self.renderer.update(scene)
        self.renderer.load_some(LOADING_SECONDS)
        self.reflection = self.renderer.reflect(view, last=self.reflection)
        self.renderer.add_sub_frame(self.canvas, self.reflection, 0, 1.0, mirrors_only=True)
