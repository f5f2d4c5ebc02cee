# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine CURVREFL. Blender calls it; colors, files, borders, stamps and the compositor are Blender's own.

A render has a GPU context of its own, and in a window a thread. What an animation keeps from frame to frame is let go
when it ends. Blender has taken the context down by then, and where none is active some drivers lose textures of the
next render: that frees what was kept, before it makes its own. What a still has made is freed with the still.
"""

from __future__ import annotations

import atexit
import json
import sys
import threading
import traceback
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from bpy.app.handlers import persistent

from ..errors import InputError
from ..options import filmed
from . import panels
from .job import current_job
from .passes import COMBINED, MIRROR, NUMBERED, fill, passes_of

if TYPE_CHECKING:
    from ..renderer.noise import Convergence
    from .session import RenderSession

ENGINE = "CURVREFL"
TROUBLE = (1.0, 0.0, 1.0, 1.0)
"""Blender's own color of what is missing"""


class RenderCanceledError(Exception):
    """The user stopped the render."""


class _State:
    """Of the render that goes on."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        """One render at a time: a preview may be asked for beside another render"""
        self.sessions: dict[tuple[int, str], RenderSession] = {}
        """By the scene's session_uid and the view layer's name"""
        self.ended: list[RenderSession] = []
        """Of renders before, not free yet"""
        self.said: set[str] = set()
        """Each warning comes once in a render, however many frames have cause for it"""

    def end(self) -> None:
        """The render has ended."""
        with self.lock:
            self.ended += self.sessions.values()
            self.sessions.clear()
            self.said.clear()

    def free(self, key: tuple[int, str]) -> None:
        """Let go of a session, if it is there, while its GPU context is active. The lock is held."""
        if (session := self.sessions.pop(key, None)) is not None:
            session.free()

    def free_ended(self) -> None:
        """While a GPU context is active, or none will be any more. The lock is held."""
        for session in self.ended:
            session.free()
        self.ended.clear()


_state = _State()


class CurvreflEngine(bpy.types.RenderEngine):
    """True reflections on curved mirrors"""

    bl_idname = ENGINE
    bl_label = "Curvrefl"
    bl_use_eevee_viewport = True
    bl_use_gpu_context = True

    def update(self, data: Any = None, depsgraph: Any = None) -> None:
        """Read the scene, while nobody else changes it."""
        self._trouble = ""
        with _state.lock:
            self._attempt(lambda: self._session(depsgraph).read(depsgraph, current_job()))

    def update_render_passes(
        self, scene: bpy.types.Scene | None = None, renderlayer: bpy.types.ViewLayer | None = None
    ) -> None:
        """Tell Blender of what a view layer has."""
        self.register_pass(scene, renderlayer, COMBINED, 4, "RGBA", "COLOR")
        for item in passes_of(renderlayer):
            self.register_pass(scene, renderlayer, item.name, len(item.channels), item.channels, item.kind)

    def render(self, depsgraph: Any) -> None:  # type: ignore[override]
        """Draw a view layer at a frame."""
        from ..renderer.device.frame_buffers import let_go_of_frame_buffers

        if not self._trouble:
            with _state.lock:
                try:
                    _state.free_ended()
                    self._attempt(lambda: self._draw(depsgraph))
                finally:
                    # (Which frame of an animation is its last nobody knows here.)
                    if not self.is_animation:
                        _state.free(_key(depsgraph))
                    let_go_of_frame_buffers()
        if self._trouble:
            self._refuse(self._trouble)
            if filmed(depsgraph.scene) != depsgraph.scene:
                self._show_trouble(depsgraph.view_layer)

    def _session(self, depsgraph: Any) -> RenderSession:
        from .session import RenderSession

        key = _key(depsgraph)
        if key not in _state.sessions:
            _state.sessions[key] = RenderSession()
        return _state.sessions[key]

    def _draw(self, depsgraph: Any) -> None:
        scene = filmed(depsgraph.scene)
        if scene.render.use_multiview:
            raise InputError("Stereoscopy is not rendered: switch it off in the output properties.")
        session, layer, job = self._session(depsgraph), depsgraph.view_layer, current_job()
        camera: Any = self.camera_override if scene == depsgraph.scene else None
        camera = camera or scene.camera
        if camera is None:
            raise InputError(f'Scene "{scene.name}" has no camera: add one or make one active.')
        passes = passes_of(layer)
        area, pixels = session.draw(
            depsgraph, camera.original, passes, job, self._before_sub_frame, self._go_to, self._pause
        )
        for item in passes:
            self.add_pass(item.name, len(item.channels), item.channels, layer=layer.name)
        result: Any = self.begin_result(0, 0, area.width, area.height, layer=layer.name)
        for name, values in pixels.items():
            fill(result.layers[0], name, values)
        self.end_result(result)
        if any(item.name in NUMBERED for item in passes):
            # (Into the headers of OpenEXR files.)
            whole: Any = self.get_result()
            whole.stamp_data_add_field(f"curvrefl.{layer.name}.objects", json.dumps(session.object_names))
        for warning in session.warnings:
            self._warn(warning)

    def _show_trouble(self, layer: Any) -> None:
        """Pink mirrors: the film that they go into is written all the same, and must not pass for one that is right."""
        result: Any = self.begin_result(0, 0, self.resolution_x, self.resolution_y, layer=layer.name)
        for item in result.layers[0].passes:
            if item.name in (COMBINED, MIRROR):
                fill(
                    result.layers[0], item.name, np.full((self.resolution_y, self.resolution_x, 4), TROUBLE, np.float32)
                )
        self.end_result(result)

    def _go_to(self, frame: int, subframe: float) -> None:
        self.frame_set(frame, subframe=subframe)

    def _before_sub_frame(self, convergence: Convergence) -> None:
        if is_stopped(self):
            raise RenderCanceledError
        noise = f", {convergence.noise_said}" if convergence.noise_said else ""
        self.update_stats("", f"Sub-frame {convergence.done + 1} of {convergence.samples}{noise}")
        self.update_progress(convergence.done / convergence.samples)

    def _pause(self) -> None:
        if is_stopped(self):
            raise RenderCanceledError
        self.update_stats("", "Passes of mirrors")

    def _attempt(self, work: Any) -> None:
        """What goes wrong becomes a sentence: Blender would go on with an empty picture."""
        from ..renderer.device.context import GpuUnavailableError

        job = current_job()
        try:
            work()
        except RenderCanceledError:
            return
        except Exception as error:
            if job is not None and job.error is None:
                job.error = error
            if not isinstance(error, (InputError, GpuUnavailableError)):
                traceback.print_exc()
            self._trouble = str(error) or type(error).__name__

    def _refuse(self, sentence: str) -> None:
        """An error ends the render: no file is written."""
        if sentence not in _state.said:
            _state.said.add(sentence)
            self.report({"ERROR"}, sentence)

    def _warn(self, sentence: str) -> None:
        if sentence in _state.said:
            return
        _state.said.add(sentence)
        job = current_job()
        if job is None:
            self.report({"WARNING"}, sentence)
        else:
            job.warnings.append(sentence)


def _key(depsgraph: Any) -> tuple[int, str]:
    """Of a session."""
    return depsgraph.scene.session_uid, depsgraph.view_layer.name


def sessions_kept() -> int:
    """How many view layers a render that goes on has read; none once it has ended."""
    return len(_state.sessions)


def is_stopped(engine: bpy.types.RenderEngine) -> bool:
    """Whether the user has asked for the render's end."""
    return engine.test_break()


@persistent
def _begins(scene: bpy.types.Scene, *_arguments: Any) -> None:
    """In background, without a driver, Blender would crash as it makes the engine's GPU context: a sentence instead."""
    if not bpy.app.background or scene.render.engine != ENGINE:
        return
    from ..renderer.device.context import GpuUnavailableError, require_gpu

    try:
        require_gpu()
    except GpuUnavailableError as error:
        print(f"Error: {error}", file=sys.stderr, flush=True)
        sys.exit(1)


@persistent
def _ended(*_arguments: Any) -> None:
    """A render is complete or canceled."""
    _state.end()


def _free() -> None:
    """Let go of all: no other render comes."""
    _state.end()
    with _state.lock:
        _state.free_ended()


CLASSES = (CurvreflEngine,)


def _handlers() -> list[tuple[list[Any], Callable[..., None]]]:
    handlers = bpy.app.handlers
    return [(handlers.render_init, _begins), (handlers.render_complete, _ended), (handlers.render_cancel, _ended)]


def add() -> None:
    """Hear of renders' begins and ends; the classes are registered."""
    for handlers, function in _handlers():
        handlers.append(function)
    atexit.register(_free)
    panels.add(ENGINE)


def remove() -> None:
    """Leave nothing behind."""
    panels.remove(ENGINE)
    for handlers, function in _handlers():
        if function in handlers:
            handlers.remove(function)
    atexit.unregister(_free)
    _free()
