# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw handlers: put the renderer's mirrors into every 3D viewport.

The mirrors are drawn into the frame buffer that is bound before the view's engine draws: it is scene-linear, so the
view transform and the overlays come out right. Who hides whom is decided by the renderer's own passes, because the
viewport's depth is not there with overlays off.

Nothing is read from the scene while only the view moves. A change of the scene marks it; the next redraw reads it
again. A handler that fails switches itself off, says why once in the panel, and can be switched on again.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import bpy
import gpu
import numpy as np
from bpy.app.handlers import persistent

from ..gpu_shaders.loader import load
from .errors import InputError
from .renderer.frame import Reflection, Renderer, Settings
from .renderer.gpu_objects import drawing_state, full_screen_triangle
from .renderer.solve import statistics as solve_statistics
from .scene.blend_file import SURFACE_TYPES
from .scene.extract import extract_scene
from .scene.view import View

IDLE_SECONDS = 0.02
"""Between the sub-frames of a view that rests"""


@dataclass
class _Region:
    """What one region of a window has drawn so far."""

    reflection: Reflection
    renderer: Renderer
    texture: Any
    canvas: Any
    sub_frames: int = 0


@dataclass
class _State:
    """All that lives while the switch is on."""

    handlers: list[Any] = field(default_factory=list)
    renderers: dict[int, Renderer | None] = field(default_factory=dict)
    """Per scene (session_uid); None: has nothing to show"""
    regions: dict[int, _Region] = field(default_factory=dict)
    frame_buffers: dict[int, Any] = field(default_factory=dict)
    """Per region, captured before its engine draws; of this redraw only"""
    messages: list[str] = field(default_factory=list)
    counters: dict[str, int] = field(default_factory=lambda: {"scene reads": 0, "solves": 0, "sub-frames": 0})


_state = _State()


def switch(on: bool) -> None:
    """Start or stop drawing. Starting clears an earlier failure."""
    _stop()
    if on:
        _state.messages.clear()
        _add_handlers()
    _redraw_all()


def mirrors_of(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Objects of the scene that are marked as mirrors."""
    return [item for item in scene.objects if item.curvrefl.is_mirror and item.type in SURFACE_TYPES]


def messages() -> list[str]:
    """What the user should know, one sentence each."""
    return list(_state.messages)


def counters() -> dict[str, int]:
    """How often scenes were read, views solved and sub-frames drawn since the extension was enabled."""
    return dict(_state.counters)


def statistics() -> list[tuple[str, str]]:
    """Rows for the panel: vertices, solved, hidden, failed, iterations, of the view drawn last."""
    for region in reversed(_state.regions.values()):
        if region.reflection.solutions:
            found = solve_statistics(region.reflection.solutions)
            return [
                ("Vertices", f"{found['vertices']:,}"),
                ("Reflected", f"{found['reflected']:,}"),
                ("Hidden", f"{found['hidden']:,}"),
                ("Failed", f"{found['unconverged']:,}"),
                ("Iterations", f"{found['iterations']['mean']:.1f}"),
            ]
    return [("Nothing solved yet", "")]


def forget_scene(scene: bpy.types.Scene | None = None) -> None:
    """Read the scene (or all) again at the next redraw."""
    chosen = list(_state.renderers) if scene is None else [scene.session_uid]
    for uid in chosen:
        renderer = _state.renderers.pop(uid, None)
        if renderer is not None:
            for key in [key for key, region in _state.regions.items() if region.renderer is renderer]:
                del _state.regions[key]
            renderer.free()
    _redraw_all()


def unregister() -> None:
    """Leave nothing behind."""
    _stop()
    _state.messages.clear()


def _add_handlers() -> None:
    space = bpy.types.SpaceView3D
    _state.handlers = [
        space.draw_handler_add(_guarded(_capture), (), "WINDOW", "PRE_VIEW"),
        space.draw_handler_add(_guarded(_draw), (), "WINDOW", "POST_VIEW"),
    ]
    for handlers, function in _app_handlers():
        handlers.append(function)


def _stop() -> None:
    for handler in _state.handlers:
        bpy.types.SpaceView3D.draw_handler_remove(handler, "WINDOW")
    _state.handlers = []
    for handlers, function in _app_handlers():
        if function in handlers:
            handlers.remove(function)
    if bpy.app.timers.is_registered(_redraw_all):
        bpy.app.timers.unregister(_redraw_all)
    _state.regions.clear()
    _state.frame_buffers.clear()
    for renderer in _state.renderers.values():
        if renderer is not None:
            renderer.free()
    _state.renderers.clear()


def _app_handlers() -> list[tuple[list[Any], Callable[..., None]]]:
    handlers = bpy.app.handlers
    return [
        (handlers.depsgraph_update_post, _scene_changed),
        (handlers.frame_change_post, _frame_changed),
        (handlers.undo_post, _all_changed),
        (handlers.redo_post, _all_changed),
        (handlers.load_post, _all_changed),
    ]


@persistent
def _scene_changed(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if any(_changes_picture(update) for update in depsgraph.updates):
        forget_scene(scene)


def _changes_picture(update: bpy.types.DepsgraphUpdate) -> bool:
    """Whether what is drawn may change: not by selecting, and not by moving a camera, which is only another view."""
    changed = update.id
    if isinstance(changed, bpy.types.Camera) or (
        isinstance(changed, bpy.types.Object) and changed.type in {"CAMERA", "SPEAKER", "LIGHT_PROBE"}
    ):
        return False
    return update.is_updated_geometry or update.is_updated_transform or update.is_updated_shading


@persistent
def _frame_changed(scene: bpy.types.Scene, _depsgraph: bpy.types.Depsgraph | None = None) -> None:
    forget_scene(scene)


@persistent
def _all_changed(*_arguments: Any) -> None:
    forget_scene()


def _guarded(function: Callable[[bpy.types.Context], None]) -> Callable[[], None]:
    """A handler that never raises: a failure ends the drawing and is reported once."""

    def handler() -> None:
        try:
            function(bpy.context)
        except Exception as error:
            traceback.print_exc()
            _state.messages[:] = [f"Drawing stopped: {error}. Switch it on again once that is put right."]
            # A handler cannot be removed while it runs, and a property not be set while drawing.
            bpy.app.timers.register(_switch_off, first_interval=0.0)

    return handler


def _switch_off() -> None:
    _stop()
    kept = list(_state.messages)
    for manager in bpy.data.window_managers:
        if manager.curvrefl_enabled:
            manager.curvrefl_enabled = False
    _state.messages[:] = kept


def _capture(context: bpy.types.Context) -> None:
    _state.frame_buffers[context.region.as_pointer()] = gpu.state.active_framebuffer_get()


def _draw(context: bpy.types.Context) -> None:
    # The frame buffer is this redraw's own: never kept beyond it.
    frame_buffer = _state.frame_buffers.pop(context.region.as_pointer(), None)
    space = context.space_data
    if frame_buffer is None or not isinstance(space, bpy.types.SpaceView3D):
        return
    if space.shading.type not in {"SOLID", "MATERIAL", "RENDERED"}:
        return
    renderer = _renderer_for(context)
    if renderer is None:
        return
    viewport = gpu.state.viewport_get()
    region = _region_for(context, renderer)
    samples = renderer.settings.samples
    if region.sub_frames < samples:
        renderer.add_sub_frame(region.canvas, region.reflection, region.sub_frames, 1.0, mirrors_only=True)
        region.sub_frames += 1
        _state.counters["sub-frames"] += 1
    _composite(frame_buffer, viewport, region)
    if region.sub_frames < samples and not bpy.app.timers.is_registered(_redraw_all):
        bpy.app.timers.register(_redraw_all, first_interval=IDLE_SECONDS)


def _renderer_for(context: bpy.types.Context) -> Renderer | None:
    scene = context.scene
    key = scene.session_uid
    if key not in _state.renderers:
        _state.messages.clear()
        _state.renderers[key] = _new_renderer(context)
        _state.counters["scene reads"] += 1
    return _state.renderers[key]


def _new_renderer(context: bpy.types.Context) -> Renderer | None:
    """A renderer with all mirrors that can be drawn; the others are named in the messages."""
    depsgraph = context.evaluated_depsgraph_get()
    scene = context.scene
    assert scene is not None
    settings = scene.curvrefl
    chosen = Settings(method=settings.method, samples=settings.samples, pixel_tolerance=settings.pixel_tolerance)
    usable = [mirror for mirror in mirrors_of(scene) if mirror.visible_get(view_layer=context.view_layer)]
    while usable:
        try:
            arrays = extract_scene(depsgraph, scene, usable, for_render=False)
            renderer = Renderer(arrays, chosen)
        except InputError as error:
            _state.messages.append(str(error))
            broken = [mirror for mirror in usable if f'"{mirror.name}"' in str(error)]
            if not broken:
                return None
            usable = [mirror for mirror in usable if mirror not in broken]
        else:
            _state.messages += renderer.warnings
            return renderer
    return None


def _region_for(context: bpy.types.Context, renderer: Renderer) -> _Region:
    """The region's picture in progress; a new one where view, size or scene are not the same."""
    data = context.region_data
    view = View(
        np.array(data.view_matrix, np.float64),
        np.array(data.window_matrix, np.float64),
        context.region.width,
        context.region.height,
    )
    key = context.region.as_pointer()
    region = _state.regions.get(key)
    if region is not None and region.renderer is renderer and _is_same(region.reflection.view, view):
        return region
    texture = gpu.types.GPUTexture((view.width, view.height), format="RGBA32F")
    canvas = gpu.types.GPUFrameBuffer(color_slots=(texture,))
    with canvas.bind():
        canvas.clear(color=(0.0, 0.0, 0.0, 0.0))
    region = _Region(renderer.reflect(view), renderer, texture, canvas)
    _state.counters["solves"] += 1
    _state.regions[key] = region
    return region


def _is_same(one: View, other: View) -> bool:
    return (
        (one.width, one.height) == (other.width, other.height)
        and np.array_equal(one.world_to_view, other.world_to_view)
        and np.array_equal(one.view_to_clip, other.view_to_clip)
    )


def _composite(frame_buffer: Any, viewport: tuple[int, int, int, int], region: _Region) -> None:
    shader = _composite_shader()
    with frame_buffer.bind():
        gpu.state.viewport_set(*viewport)
        with drawing_state(blend="ALPHA_PREMULT"):
            shader.bind()
            shader.uniform_float("sub_frames", float(region.sub_frames))
            shader.uniform_float("corner", (float(viewport[0]), float(viewport[1])))
            shader.uniform_sampler("picture", region.texture)
            full_screen_triangle().draw(shader)
    # What handlers before and after ours take for granted in this place.
    gpu.state.depth_mask_set(True)


@cache
def _composite_shader() -> Any:
    info = gpu.types.GPUShaderCreateInfo()
    info.vertex_in(0, "VEC2", "pos")
    info.fragment_out(0, "VEC4", "color")
    info.push_constant("FLOAT", "sub_frames")
    info.push_constant("VEC2", "corner")
    info.sampler(0, "FLOAT_2D", "picture")
    info.vertex_source(load("full_screen.vert.glsl"))
    info.fragment_source(load("composite.frag.glsl"))
    return gpu.shader.create_from_info(info)


def _redraw_all() -> None:
    for manager in bpy.data.window_managers:
        for window in manager.windows:
            for area in window.screen.areas:
                if area.type == "VIEW_3D":
                    area.tag_redraw()
