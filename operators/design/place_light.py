# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Drag on a mirror: the active light, or whatever is active, goes where it is seen there, or where it lights it."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from typing import Any, Literal

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty

from ...curvrefl_addon.design.lights.moved import Moved
from ...curvrefl_addon.design.lights.placing import Ask, Line, Placed, Placing, line_given
from ...curvrefl_addon.design.lights.sight import has_bumps
from ...curvrefl_addon.design.lights.worlds import MovedWorld
from ...curvrefl_addon.errors import InputError
from ...curvrefl_addon.ui.light_tool import draw_placing
from ...curvrefl_addon.viewport import light_overlay

MODES = (
    ("REFLECTION", "Reflection", "It is seen in the mirror under the cursor"),
    ("ILLUMINATION", "Illumination", "It stands straight over what is under the cursor, where it gives most light"),
    ("RIM", "Rim", "It grazes the edge nearest to the cursor from behind; beside all objects it goes to the cursor"),
)
TARGETS = (
    ("ACTIVE", "Active", "The active light or object"),
    ("WORLD", "World", "The world: its sun, or the brightest place of its image, is turned there"),
)
STEP = 1.1
"""Of distance, size and power by a step of the wheel"""
HINTS = "Drag: place | Wheel: distance | Shift Wheel: size | Ctrl Wheel: power | 1 2 3: mode | A: aim | Esc: cancel"


class CURVREFL_OT_place_light(bpy.types.Operator):
    """Drag on a mirror to move the active light or object to where it is seen under the cursor"""

    bl_idname = "curvrefl.place_light"
    bl_label = "Place Light by Reflection"
    bl_options = {"REGISTER", "UNDO", "BLOCKING"}  # noqa: RUF012 (Blender's own convention)

    mode: EnumProperty(name="Mode", description="What it does under the cursor", items=MODES)  # type: ignore[valid-type]
    target: EnumProperty(name="Place", description="What is placed", items=TARGETS)  # type: ignore[valid-type]
    level: BoolProperty(  # type: ignore[valid-type]
        name="Keep Level",
        description="Turn the world about the vertical alone: its sun may then show above or below the cursor",
        default=False,
    )
    keep_distance: BoolProperty(  # type: ignore[valid-type]
        name="Distance", description="Keep its distance from the point that it is placed by", default=True
    )
    distance: FloatProperty(  # type: ignore[valid-type]
        name="Distance",
        description="From the point that it is placed by, over all mirrors on the way",
        subtype="DISTANCE",
        default=1.0,
        min=1e-6,
        soft_max=100.0,
    )
    keep_size: BoolProperty(  # type: ignore[valid-type]
        name="Size", description="Keep its size; else it looks as large from any distance", default=True
    )
    keep_power: BoolProperty(  # type: ignore[valid-type]
        name="Power", description="Keep its power; else it is as bright there from any distance", default=True
    )
    aim: BoolProperty(  # type: ignore[valid-type]
        name="Aim", description="Turn area and spot lamps to the point that they are placed by", default=True
    )
    rim_width: FloatProperty(  # type: ignore[valid-type]
        name="Rim Width",
        description="How far in from the edge its light reaches, as an angle of the surface",
        subtype="ANGLE",
        default=0.2617994,
        min=0.0,
        max=1.5533430,
    )
    size: FloatProperty(  # type: ignore[valid-type]
        name="Size Factor",
        description="Times the size that it has",
        default=1.0,
        min=1e-3,
        max=1e3,
        options={"SKIP_SAVE"},
    )
    power: FloatProperty(  # type: ignore[valid-type]
        name="Power Factor",
        description="Times the power that it has",
        default=1.0,
        min=0.0,
        max=1e6,
        options={"SKIP_SAVE"},
    )
    pixel: FloatVectorProperty(  # type: ignore[valid-type]
        name="Pixel",
        description="For scripts: place in the active camera's picture, in pixels from the bottom left",
        size=2,
        options={"HIDDEN", "SKIP_SAVE"},
    )
    point: FloatVectorProperty(  # type: ignore[valid-type]
        name="Point",
        description="For scripts: where on the mirror, world space, as seen from Eye or else by the active camera",
        subtype="TRANSLATION",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    eye: FloatVectorProperty(  # type: ignore[valid-type]
        name="Eye",
        description="Where the line of sight starts, world space",
        subtype="TRANSLATION",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    direction: FloatVectorProperty(  # type: ignore[valid-type]
        name="Direction",
        description="Where the line of sight goes, world space",
        subtype="DIRECTION",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    parallel: BoolProperty(  # type: ignore[valid-type]
        name="Parallel", description="The view is an orthographic one", options={"HIDDEN", "SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.scene is None or context.mode != "OBJECT":
            cls.poll_message_set("Only in Object Mode")
            return False
        return True

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Any:
        region = context.region
        if region is None or region.type != "WINDOW" or context.region_data is None:
            self.report({"ERROR"}, "Start it with the mouse over a 3D view")
            return {"CANCELLED"}
        self._grab = np.zeros(2)
        """Pixels from the mouse to the image that was picked: that goes with it, and does not jump"""
        self._start = np.array((event.mouse_region_x, event.mouse_region_y), np.float64)
        self._waits = False
        self._left: bpy.types.Object | None = None
        """What was active before another light was picked"""
        self._is_held = event.type == "LEFTMOUSE" and event.value in {"PRESS", "CLICK_DRAG"}
        if self._is_held:
            self._pick(context)
        try:
            self._placing = Placing(self._taken(context), _scene(context))
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self._placed: Placed | None = None
        self._by: Line | None = None
        """The line of sight that it was placed by"""
        self._problem = ""
        context.window_manager.modal_handler_add(self)
        context.workspace.status_text_set(HINTS)
        if self._is_held and not self._waits:
            self._follow(context, event)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> Any:
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        if event.type == "LEFTMOUSE":
            if event.value != ("RELEASE" if self._is_held else "PRESS"):
                return {"RUNNING_MODAL"}
            if not self._is_held:
                self._follow(context, event)
            return self._finish(context)
        if event.type == "MOUSEMOVE":
            self._follow(context, event)
        elif self._is_changed_by(event) and self._by is not None:
            # (By the last place that served: the mouse may be beside the mirror.)
            self._place(context, self._by)
        return {"PASS_THROUGH"} if event.type == "MIDDLEMOUSE" else {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        self._placing.moved.restore()
        if self._left is not None:
            _select_alone(context, self._left)
        self._end(context)

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        depsgraph = context.evaluated_depsgraph_get()
        try:
            scene = _scene(context)
            placing = Placing(self._taken(context), scene)
            placed = placing.place(depsgraph, scene, self._line(scene, depsgraph), self._ask())
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self._tell(context, placing, placed)
        return {"FINISHED"}

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        draw_placing(layout, self.properties)
        layout.prop(self, "size")
        layout.prop(self, "power")

    def _taken(self, context: bpy.types.Context) -> Moved | MovedWorld:
        """What is placed. Raises InputError for what cannot be."""
        return MovedWorld(_scene(context).world, self.level) if self.target == "WORLD" else Moved(_active(context))

    def _ask(self) -> Ask:
        return Ask(
            mode=self.mode,
            distance=None if self.keep_distance else self.distance,
            keeps_size=self.keep_size,
            keeps_power=self.keep_power,
            size=self.size,
            power=self.power,
            aims=self.aim,
            rim_width=self.rim_width,
        )

    def _line(self, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> Line:
        """The line of sight that the properties say."""
        given = {
            name: np.array(getattr(self, name), np.float64)
            for name in ("pixel", "point", "eye", "direction")
            if self.properties.is_property_set(name)
        }
        return line_given(scene, depsgraph, given, self.parallel)

    def _follow(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        """Place it by what is under the mouse; where that does not serve it stays, and the header says why."""
        mouse = np.array((event.mouse_region_x, event.mouse_region_y), np.float64)
        if self._waits and np.abs(mouse - self._start).max() < context.preferences.inputs.drag_threshold_mouse:
            return
        self._waits = False
        x, y = mouse + 0.5 + self._grab
        self._place(context, Line.through(light_overlay.view_in(context), x, y))

    def _pick(self, context: bpy.types.Context) -> None:
        """Take the light whose reflection is under the mouse, if there is one."""
        found = light_overlay.picked_at(context, self._start + 0.5, self.target == "WORLD")
        if found is None:
            return
        self._grab, self._waits = found.center - self._start - 0.5, True
        if found.item is not None and found.item != context.object:
            self._left = context.object
            _select_alone(context, found.item)

    def _place(self, context: bpy.types.Context, line: Line) -> None:
        assert context.area is not None
        try:
            self._placed = self._placing.place(context.evaluated_depsgraph_get(), _scene(context), line, self._ask())
        except InputError as error:
            self._problem = str(error)
            context.area.header_text_set(self._problem)
            return
        self._problem, self._by = "", line
        self.eye, self.direction, self.parallel = line.origin.tolist(), line.direction.tolist(), line.is_parallel
        context.area.header_text_set(self._header(self._placed))

    def _header(self, placed: Placed) -> str:
        mode = next(label for name, label, _ in MODES if name == self.mode)
        shares = f"Size {100.0 * self.size:.0f} %   Power {100.0 * self.power:.0f} %"
        distance = "" if not np.isfinite(placed.goal.distance) else f"Distance {placed.goal.distance:.4g} m   "
        over = f"   over {placed.goal.mirrors} mirrors" if placed.goal.mirrors > 1 else ""
        return f"{mode}   {distance}{shares}{over}{_limits(placed)}"

    def _is_changed_by(self, event: bpy.types.Event) -> bool:
        """Whether the event changes what is asked for; does so."""
        if event.type in {"WHEELUPMOUSE", "WHEELDOWNMOUSE"}:
            step = STEP if event.type == "WHEELUPMOUSE" else 1.0 / STEP
            if event.shift:
                self.size *= step
            elif event.ctrl:
                self.power *= step
            elif self._placed is not None and np.isfinite(self._placed.goal.distance):
                self.distance = step * self._placed.goal.distance
                self.keep_distance = False
            return True
        if event.value != "PRESS":
            return False
        numbers = {"ONE": 0, "TWO": 1, "THREE": 2, "NUMPAD_1": 0, "NUMPAD_2": 1, "NUMPAD_3": 2}
        if event.type in numbers:
            self.mode = MODES[numbers[event.type]][0]
            return True
        if event.type == "A":
            self.aim = not self.aim
            return True
        return False

    def _finish(self, context: bpy.types.Context) -> Any:
        self._end(context)
        if self._placed is None and self._waits:
            # A click on the reflection of a light takes that, and is a step of undo where it was another one.
            return {"FINISHED"} if self._left is not None else {"CANCELLED"}
        if self._placed is None:
            self.report({"WARNING"}, self._problem)
            return {"CANCELLED"}
        self._tell(context, self._placing, self._placed)
        return {"FINISHED"}

    def _tell(self, context: bpy.types.Context, placing: Placing, placed: Placed) -> None:
        """Say what came of it, once the scene has followed."""
        if _scene(context).tool_settings.use_keyframe_insert_auto:
            placing.moved.insert_keys(self.aim)
        if held := placing.moved.held(placed.goal, context.evaluated_depsgraph_get()):
            self.report({"WARNING"}, held)
            return
        what = {
            "REFLECTION": f'is seen in "{placed.on}"',
            "ILLUMINATION": f'stands over "{placed.on}"',
            "RIM": f'grazes the edge of "{placed.on}"' if placed.on else "is where you clicked",
        }[self.mode]
        self.report({"INFO"}, f'"{placing.moved.name}" {what}{_limits(placed)}{_bumps(placed)}')

    def _end(self, context: bpy.types.Context) -> None:
        context.workspace.status_text_set(None)
        if context.area is not None:
            context.area.header_text_set(None)


def _active(context: bpy.types.Context) -> bpy.types.Object:
    """Raises InputError for none."""
    if context.object is None:
        raise InputError("Make a light or another object active, or click the reflection of a light.")
    return context.object


def _select_alone(context: bpy.types.Context, item: bpy.types.Object) -> None:
    for other in context.selected_objects:
        other.select_set(False)
    item.select_set(True)
    context.view_layer.objects.active = item


def _scene(context: bpy.types.Context) -> bpy.types.Scene:
    assert context.scene is not None
    return context.scene


def _limits(placed: Placed) -> str:
    """What keeps it from where it was asked to go, at the end of a sentence."""
    if placed.behind:
        return f', in front of "{placed.behind}"'
    return f', but "{placed.hides}" hides it' if placed.hides else ""


def _bumps(placed: Placed) -> str:
    """That it is placed by the smooth surface, at the end of a sentence."""
    item = bpy.data.objects.get(placed.on)
    return "; the bumps of that are left out" if item is not None and has_bumps(item) else ""


CLASSES = (CURVREFL_OT_place_light,)
