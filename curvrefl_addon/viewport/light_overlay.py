# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The lights of a scene where they show in its mirrors, over 3D views in which the tool Lights by Reflection is active.

Where it is not a redraw costs the question for the tool's name, and nothing is kept.
"""

from __future__ import annotations

import traceback
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from bpy.app.handlers import persistent

from ..scene.opened.areas import redraw_views

if TYPE_CHECKING:
    from ..design.lights.shown import LightsInMirrors, ShownLight
    from ..scene.arrays import Float64Array
    from ..scene.camera.view import View

TOOL = "curvrefl.lights"
"""`bl_idname` of the tool"""
OPERATOR = "curvrefl.place_light"
"""And of what it calls"""
SETTLED_SECONDS = 0.1
"""A view that has moved is looked at once it rests so long"""
WIDTH, SHADE_WIDTH = 1.5, 3.5
"""Pixels of lines, and of the dark ones under them that tell them from bright mirrors"""
SHADE = (0.0, 0.0, 0.0, 0.6)
OTHERS = (1.0, 1.0, 1.0, 1.0)
FAINT = 0.4
"""Alpha of what something keeps from the mirror"""
RADIUS = 5.0
"""Pixels, of marks"""
ROUND = 16
"""Corners of a circle"""


class _Overlay:
    """All that lives while the tool is active somewhere."""

    def __init__(self) -> None:
        self.is_heard = False
        """Handlers tell of changes"""
        self.lights: dict[int, LightsInMirrors] = {}
        """By the region's pointer: each has an eye of its own"""
        self.shown: dict[int, tuple[ShownLight, ...]] = {}
        """By the region's pointer, as drawn last"""
        self.views: dict[int, bytes] = {}
        self.handlers: list[Any] = []
        self.failure = ""


_overlay = _Overlay()


def add() -> None:
    """From now on."""
    _overlay.handlers.append(bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL"))


def remove() -> None:
    """Leave nothing behind."""
    while _overlay.handlers:
        bpy.types.SpaceView3D.draw_handler_remove(_overlay.handlers.pop(), "WINDOW")
    _let_go()
    _overlay.failure = ""


def failure() -> str:
    """Why nothing is drawn, a sentence for the tool's header, or nothing."""
    return _overlay.failure


def shown_in(region: bpy.types.Region) -> tuple[ShownLight, ...]:
    """What was drawn last in a region."""
    return _overlay.shown.get(region.as_pointer(), ())


def view_in(context: bpy.types.Context) -> View:
    """The eye of the context's region."""
    from .region import view_of

    return view_of(context)


@dataclass(frozen=True, slots=True)
class Picked:
    """By a click on its reflection."""

    item: bpy.types.Object | None
    """None for the world"""
    center: Float64Array
    """(2,) of its image, pixels from the bottom left"""


def picked_at(context: bpy.types.Context, pixel: Float64Array, is_world: bool) -> Picked | None:
    """The light of those drawn last in the region whose image is at a pixel (2,); of the world where that is asked for.
    None where there is none."""
    from ..design.lights.shown import path_at, picked

    shown = () if context.region is None else shown_in(context.region)
    lights = tuple(light for light in shown if light.is_world == is_world)
    if not lights or context.scene is None:
        return None
    path = path_at(context.evaluated_depsgraph_get(), context.scene, view_in(context), pixel)
    found = picked(lights, path, pixel)
    if found is None:
        return None
    item = None if is_world else context.view_layer.objects.get(found[0])
    return None if item is None and not is_world else Picked(item, found[1])


def is_active(context: bpy.types.Context) -> bool:
    """Whether the tool is, in the 3D views of the context's workspace."""
    return _tool(context) is not None


def _tool(context: bpy.types.Context) -> Any | None:
    if context.workspace is None or context.mode != "OBJECT":
        return None
    tool = context.workspace.tools.from_space_view3d_mode("OBJECT", create=False)
    return tool if tool is not None and tool.idname == TOOL else None


def _draw() -> None:
    context = bpy.context
    if not is_active(context):
        if _overlay.is_heard:
            _let_go()
        return
    space = context.space_data
    if _overlay.failure or not isinstance(space, bpy.types.SpaceView3D) or not space.overlay.show_overlays:
        return
    try:
        shown = _look(context)
        _overlay.shown[context.region.as_pointer()] = shown
        _draw_lights(context, shown)
    except Exception as error:
        traceback.print_exc()
        _overlay.failure = f"Reflections of lights are not shown: {error}"


def _look(context: bpy.types.Context) -> tuple[ShownLight, ...]:
    from ..design.lights.shown import LightsInMirrors

    if not _overlay.is_heard:
        _overlay.is_heard = True
        bpy.app.handlers.depsgraph_update_post.append(_scene_changed)
        bpy.app.handlers.frame_change_post.append(_frame_changed)
        bpy.app.handlers.load_pre.append(_loaded)
    view, region = view_in(context), context.region.as_pointer()
    key = view.world_to_clip.tobytes()
    has_moved = _overlay.views.get(region, key) != key
    _overlay.views[region] = key
    if has_moved:
        # (An orbit is not slowed down.)
        _draw_soon()
        return ()
    scene, tool = context.scene, _tool(context)
    assert scene is not None and tool is not None
    has_world = tool.operator_properties(OPERATOR).target == "WORLD"
    lights = _overlay.lights.setdefault(region, LightsInMirrors())
    return lights.of(context.evaluated_depsgraph_get(), scene, view, context.object, has_world)


def _draw_lights(context: bpy.types.Context, shown: tuple[ShownLight, ...]) -> None:
    from ..renderer.device.overlays import draw_segments

    scale = context.preferences.system.ui_scale
    chosen = (*context.preferences.themes[0].view_3d.object_active, 1.0)
    active = None if context.object is None else context.object.name
    is_world = any(light.is_world for light in shown)

    def is_taken(light: ShownLight) -> bool:
        return light.is_world if is_world else light.name == active

    for light in sorted(shown, key=is_taken):
        color = chosen if is_taken(light) else OTHERS
        lit, faint = [light.segments], [np.zeros((0, 2, 2))]
        for center, is_lit in zip(light.centers, light.is_lit, strict=True):
            (lit if is_lit else faint).append(_mark(light, center, RADIUS * scale))
        for parts, alpha in ((lit, 1.0), (faint, FAINT)):
            segments = np.concatenate(parts)
            draw_segments(segments, SHADE_WIDTH * scale, (*SHADE[:3], SHADE[3] * alpha))
            draw_segments(segments, WIDTH * scale, (*color[:3], alpha))


def _mark(light: ShownLight, center: Float64Array, radius: float) -> Float64Array:
    """(n, 2, 2) about a light's image: a circle for point and spot lamps, with rays for suns, else a cross."""
    kind = "" if light.light is None else light.light.kind
    if kind in ("", "AREA"):
        ends = np.array([[[-1.0, 0], [1, 0]], [[0, -1], [0, 1]]])
        return center + radius * ends
    turn = np.linspace(0.0, 2.0 * np.pi, ROUND + 1)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    parts = [np.stack([circle[:-1], circle[1:]], axis=1)]
    if kind == "SUN":
        parts.append(np.stack([1.4 * circle[:-1:2], 2.0 * circle[:-1:2]], axis=1))
    return center + radius * np.concatenate(parts)


def _let_go() -> None:
    handlers = bpy.app.handlers
    for listed, function in (
        (handlers.depsgraph_update_post, _scene_changed),
        (handlers.frame_change_post, _frame_changed),
        (handlers.load_pre, _loaded),
    ):
        if function in listed:
            listed.remove(function)
    if bpy.app.timers.is_registered(redraw_views):
        bpy.app.timers.unregister(redraw_views)
    _overlay.is_heard = False
    _overlay.lights.clear()
    _overlay.shown.clear()
    _overlay.views.clear()


@persistent
def _scene_changed(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if any(update.is_updated_geometry and not _is_lamp(update.id) for update in depsgraph.updates):
        _forget_meshes()


def _forget_meshes() -> None:
    for lights in _overlay.lights.values():
        lights.forget_meshes()


def _is_lamp(block: Any) -> bool:
    return isinstance(block, bpy.types.Light) or (isinstance(block, bpy.types.Object) and block.type == "LIGHT")


@persistent
def _frame_changed(*_arguments: Any) -> None:
    _forget_meshes()


@persistent
def _loaded(*_arguments: Any) -> None:
    _let_go()


def _draw_soon() -> None:
    if bpy.app.timers.is_registered(redraw_views):
        bpy.app.timers.unregister(redraw_views)
    bpy.app.timers.register(redraw_views, first_interval=SETTLED_SECONDS)
