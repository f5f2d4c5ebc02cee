# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw handlers: put the renderer's mirrors into every 3D viewport.

The mirrors are drawn into the frame buffer that is bound before the view's engine draws: it is scene-linear, so the
view transform and the overlays come out right. Where none was seen there, they are drawn over the finished view, with
the colors of the Standard view transform and over its overlays. Who hides whom is decided by the renderer's own passes,
because the viewport's depth is not there with overlays off.

While only the view moves nothing is read from the scene. Updates of the scene are gathered and looked at by the next
redraw. A handler that fails switches itself off, says why once in the panel, and can be switched on again.
"""

from __future__ import annotations

import traceback
from collections import Counter
from collections.abc import Callable, Mapping
from time import monotonic
from types import MappingProxyType
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ..diagnostics.colors import MODES
from ..inspection import shown as surface_lines
from ..options import current_options, settings_of
from ..renderer.device.frame_buffers import active_frame_buffer
from ..renderer.device.state import viewport
from ..renderer.shading.diagnostic_legend import draw_legend
from . import device_run
from .opening import SLICE_SECONDS
from .region import SETTLED_SECONDS, RegionPicture, view_of
from .shown_scene import ViewportScene, look_of
from .state import forget_scenes, free_scene, redraw_all, state

IDLE_SECONDS = 0.02
"""Between the sub-frames of a view that rests"""
ASKED_SECONDS = 5.0
"""Statistics asked for less long ago are still of interest"""
SHOWN_IN = {"SOLID", "MATERIAL", "RENDERED"}


def switch(on: bool) -> None:
    """Start or stop drawing. Starting clears an earlier failure."""
    _stop()
    if on:
        state.failure = ""
        _add_handlers()
    redraw_all()


def messages() -> list[str]:
    """What the user should know, one sentence each."""
    found = [*([state.failure] if state.failure else []), *device_run.messages()]
    for scene in state.scenes.values():
        found += scene.messages
        for renderer in scene.renderers.values():
            found += renderer.warnings
    for picture in state.pictures.values():
        found += picture.warnings
    return list(dict.fromkeys(found))


def material_remarks() -> dict[str, list[str]]:
    """Causes of remarks (`scene/remarks.py`) by the name of the material that they concern."""
    found: dict[str, list[str]] = {}
    for scene in state.scenes.values():
        for remark in scene.material_remarks:
            causes = found.setdefault(remark.name, [])
            if remark.cause not in causes:
                causes.append(remark.cause)
    return found


def counters() -> dict[str, int]:
    """How often what was read, made and drawn since the extension was enabled: what tests of laziness count."""
    total = Counter(state.counters)
    for scene in state.scenes.values():
        total.update(scene.counters)
    return dict(total)


def pictures() -> Mapping[int, RegionPicture]:
    """What is drawn now, by the region's pointer; the one drawn last comes last. To look at only."""
    return MappingProxyType(state.pictures)


def statistics() -> list[tuple[str, str]]:
    """Rows for the panel: vertices, solved, hidden, failed, iterations and times of the view drawn last.

    Times are taken while somebody asks for them: that costs a wait for the GPU.
    """
    state.asked_at = monotonic()
    for picture in reversed(state.pictures.values()):
        if rows := picture.statistics():
            return rows
    return [("Nothing solved yet", "")]


def reason() -> str:
    """Why `auto` has chosen as it has in the view drawn last, one sentence, or nothing."""
    return next((picture.reason for picture in reversed(state.pictures.values())), "")


def progress() -> str:
    """What is still being made for pictures, in a few words for the panel; nothing once all is there."""
    found = [scene.progress for scene in state.scenes.values()]
    found += [picture.progress for picture in state.pictures.values()]
    return next(filter(None, found), "")


def bake_state(mirror: bpy.types.Object) -> list[tuple[str, str]]:
    """Rows for the panel on an object's map; empty where there is none yet."""
    for scene in state.scenes.values():
        for renderer in scene.renderers.values():
            for known in renderer.mirrors:
                for shape in reversed(known.baked):
                    if shape.map is not None and known.object_name == mirror.name:
                        return [*shape.map.rows(), ("Bake Time", f"{shape.bake_ms:.0f} ms")]
    return []


def settings_changed() -> None:
    """Show the scene with other settings: nothing is read for it."""
    redraw_all()


def mirrors_changed() -> None:
    """Objects were marked as mirrors, or no longer, or show another material as such."""
    for scene in state.scenes.values():
        scene.mirrors_changed()
    redraw_all()


def unregister() -> None:
    """Leave nothing behind."""
    for manager in bpy.data.window_managers:
        if manager.curvrefl_enabled:
            manager.curvrefl_enabled = False
    _stop()
    state.failure = ""
    state.counters.clear()


def _add_handlers() -> None:
    space = bpy.types.SpaceView3D
    state.handlers = [
        space.draw_handler_add(_guarded(_capture), (), "WINDOW", "PRE_VIEW"),
        space.draw_handler_add(_guarded(_draw), (), "WINDOW", "POST_VIEW"),
        space.draw_handler_add(_guarded(_draw_legend), (), "WINDOW", "POST_PIXEL"),
    ]
    for handlers, function in _app_handlers():
        handlers.append(function)


def _stop() -> None:
    for handler in state.handlers:
        bpy.types.SpaceView3D.draw_handler_remove(handler, "WINDOW")
    state.handlers = []
    for handlers, function in _app_handlers():
        if function in handlers:
            handlers.remove(function)
    for timer in (redraw_all, _redraw_settled):
        if bpy.app.timers.is_registered(timer):
            bpy.app.timers.unregister(timer)
    device_run.cancel()
    state.pictures.clear()
    state.frame_buffers.clear()
    for key in list(state.scenes):
        free_scene(key)


def _app_handlers() -> list[tuple[list[Any], Callable[..., None]]]:
    handlers = bpy.app.handlers
    return [
        (handlers.depsgraph_update_post, _scene_changed),
        (handlers.frame_change_post, _scene_changed),
        (handlers.undo_post, _mirrors_may_differ),
        (handlers.redo_post, _mirrors_may_differ),
        (handlers.load_post, _loaded),
    ]


@persistent
def _scene_changed(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph | None = None) -> None:
    if depsgraph is None or depsgraph.mode != "VIEWPORT" or depsgraph.view_layer is None:
        return
    known = state.scenes.get((scene.session_uid, depsgraph.view_layer.name))
    if known is not None:
        known.note(depsgraph.updates, scene.frame_current)


@persistent
def _mirrors_may_differ(*_arguments: Any) -> None:
    """Undo brings settings of objects back; what it brings back of the scene comes as an update."""
    mirrors_changed()


@persistent
def _loaded(*_arguments: Any) -> None:
    """Another file: nothing of the last one is left."""
    if any(manager.curvrefl_enabled for manager in bpy.data.window_managers):
        device_run.cancel()
        forget_scenes()
    else:
        _stop()


def _guarded(function: Callable[[bpy.types.Context], None]) -> Callable[[], None]:
    """A handler that never raises: a failure ends the drawing and is reported once."""

    def handler() -> None:
        if state.failure:
            return
        try:
            function(bpy.context)
        except Exception as error:
            traceback.print_exc()
            state.failure = f"Drawing stopped: {_reason(error)}. Put that right and switch it on again."
            # A handler cannot be removed while it runs, and a property not be set while drawing.
            bpy.app.timers.register(_switch_off, first_interval=0.0)

    return handler


def _reason(error: Exception) -> str:
    """Why it failed, for the user."""
    text = str(error).strip().rstrip(".")
    if isinstance(error, MemoryError) or ("gpu." in text and ".new(" in text):
        # What Blender says when the driver gives it no texture or buffer.
        return "the GPU has no memory left; hide objects, make the view smaller or lower the samples"
    return text or type(error).__name__


def _switch_off() -> None:
    kept = state.failure
    _stop()
    for manager in bpy.data.window_managers:
        if manager.curvrefl_enabled:
            manager.curvrefl_enabled = False
    state.failure = kept
    redraw_all()


def _capture(context: bpy.types.Context) -> None:
    state.frame_buffers[context.region.as_pointer()] = active_frame_buffer()


def _draw(context: bpy.types.Context) -> None:
    # The frame buffer is this redraw's own: never kept beyond it.
    region = context.region.as_pointer()
    frame_buffer = state.frame_buffers.pop(region, None)
    space = context.space_data
    if not isinstance(space, bpy.types.SpaceView3D) or space.shading.type not in SHOWN_IN:
        return
    scene, layer = context.scene, context.view_layer
    assert scene is not None and layer is not None
    key = (scene.session_uid, layer.name)
    shown = state.scenes.get(key)
    if shown is None:
        shown = state.scenes[key] = ViewportScene()
    chosen = scene.curvrefl
    options = current_options()
    device_run.begin_session(options.measures_devices)
    memory, images = options.memory_cap << 20, options.image_memory << 20
    view, look = view_of(context), look_of(space, chosen)
    renderer = shown.renderer_soon(context, look, settings_of(chosen), memory, images, view, SLICE_SECONDS)
    picture = state.pictures.pop(region, None)
    pixels = viewport()
    if renderer is None:
        if shown.sketch is not None:
            shown.sketch.show(view, frame_buffer or active_frame_buffer(), pixels)
            _draw_soon()
        return
    if picture is None or picture.renderer is not renderer:
        picture = RegionPicture(shown, renderer)
    state.pictures[region] = picture
    now = monotonic()
    is_timed = now - state.asked_at < ASKED_SECONDS
    picture.advance(view, chosen, options, now, is_timed, state.counters)
    # Diagnostic colors must come out as they are in their legend: not through the view transform.
    if chosen.show in MODES or frame_buffer is None:
        frame_buffer = active_frame_buffer()
    picture.composite(frame_buffer, pixels)
    if not chosen.comb_show:
        surface_lines.forget_combs()
    elif not surface_lines.show_combs(renderer, scene, view, SLICE_SECONDS):
        _draw_soon()
    device_run.advance(is_resting=not picture.is_coarse)
    _draw_again(picture)


def _draw_legend(context: bpy.types.Context) -> None:
    """What the colors of a diagnostic view mean."""
    picture = state.pictures.get(context.region.as_pointer())
    legend = None if picture is None else picture.legend()
    if legend is not None:
        draw_legend(legend, context)


def _draw_again(picture: RegionPicture) -> None:
    """While the view rests its picture gets finer."""
    if picture.is_coarse and not bpy.app.timers.is_registered(_redraw_settled):
        bpy.app.timers.register(_redraw_settled, first_interval=SETTLED_SECONDS)
    is_waited_for = picture.has_work or device_run.is_running()
    if is_waited_for and (not picture.is_coarse or picture.progress):
        _draw_soon()


def _draw_soon() -> None:
    if not bpy.app.timers.is_registered(redraw_all):
        bpy.app.timers.register(redraw_all, first_interval=IDLE_SECONDS)


def _redraw_settled() -> None:
    redraw_all()
