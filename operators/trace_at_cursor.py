# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Click on a mirror: what does it show there? And the other way round: put something where it is seen there."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from typing import Any, Literal

import bpy
import numpy as np
from bpy.props import EnumProperty, FloatVectorProperty

from ..curvrefl_addon.design.lights.moved import Moved
from ..curvrefl_addon.design.lights.placing import Ask, Line, Placing
from ..curvrefl_addon.errors import InputError
from ..curvrefl_addon.scene.opened.areas import redraw_views
from ..curvrefl_addon.viewport import tracing

TEXT_NAME = "Curvrefl trace"


class CURVREFL_OT_trace_at_cursor(bpy.types.Operator):
    """Click on a mirror to see the reflected ray, what it meets, and where"""

    bl_idname = "curvrefl.trace_at_cursor"
    bl_label = "Trace at Cursor"
    # A step of undo is made only where something is placed.
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    place: EnumProperty(  # type: ignore[valid-type]
        name="Place",
        description="What is moved so that its reflection appears at the clicked point",
        items=(
            ("NONE", "Nothing", "Show the ray alone"),
            ("ACTIVE", "Active Object", "Move the active object or light so that it is seen at the clicked point"),
        ),
        default="NONE",
        options={"SKIP_SAVE"},
    )
    origin: FloatVectorProperty(  # type: ignore[valid-type]
        name="Origin", description="Where the line of sight starts, world space", subtype="TRANSLATION"
    )
    direction: FloatVectorProperty(  # type: ignore[valid-type]
        name="Direction", description="Where the line of sight goes, world space", subtype="DIRECTION"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.scene is None or context.mode != "OBJECT":
            cls.poll_message_set("Only in Object Mode")
            return False
        return True

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> Any:
        if context.area is None or context.area.type != "VIEW_3D":
            self.report({"ERROR"}, "Start it in a 3D viewport")
            return {"CANCELLED"}
        if self.place == "ACTIVE" and context.object is None:
            self.report({"ERROR"}, "There is no active object to place: select one")
            return {"CANCELLED"}
        context.window.cursor_modal_set("EYEDROPPER")
        context.workspace.status_text_set("Click on a mirror; Escape or right click to cancel")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> Any:
        if event.type in {"ESC", "RIGHTMOUSE"}:
            self._end(context)
            return {"CANCELLED"}
        if event.type != "LEFTMOUSE" or event.value != "PRESS":
            # Orbiting and zooming go on.
            return {"PASS_THROUGH"} if event.type not in {"LEFTMOUSE", "RET"} else {"RUNNING_MODAL"}
        self._end(context)
        ray = _line_of_sight(context, event)
        if ray is None:
            self.report({"ERROR"}, "Click into a 3D viewport")
            return {"CANCELLED"}
        self.origin, self.direction = ray
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        scene = context.scene
        assert scene is not None
        depsgraph = context.evaluated_depsgraph_get()
        try:
            found = tracing.trace(depsgraph, scene, np.array(self.origin), np.array(self.direction))
            placed = self._place(context, found) if self.place == "ACTIVE" else ""
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if placed:
            context.view_layer.update()
            found = tracing.trace(
                context.evaluated_depsgraph_get(), scene, np.array(self.origin), np.array(self.direction)
            )
        tracing.show(found)
        _write_text(found, placed)
        self.report({"INFO"}, placed or found.sentence())
        redraw_views()
        return {"FINISHED"}

    def _place(self, context: bpy.types.Context, found: tracing.Trace) -> str:
        item = context.object
        if item is None:
            raise InputError("There is no active object to place: select one.")
        assert context.scene is not None
        line = Line.along(np.array(self.origin), np.array(self.direction))
        placed = Placing(Moved(item), context.scene).place(
            context.evaluated_depsgraph_get(), context.scene, line, Ask(aims=False)
        )
        distance = placed.goal.distance
        bpy.ops.ed.undo_push(message="Place by Reflection")
        return f'"{item.name}" is seen in "{found.mirror}" where you clicked, {distance:.4g} m from the mirror'

    def _end(self, context: bpy.types.Context) -> None:
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)


class CURVREFL_OT_clear_trace(bpy.types.Operator):
    """Take the traced ray out of the viewports"""

    bl_idname = "curvrefl.clear_trace"
    bl_label = "Clear Trace"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        return tracing.shown() is not None

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        tracing.clear()
        redraw_views()
        return {"FINISHED"}


def _line_of_sight(context: bpy.types.Context, event: bpy.types.Event) -> tuple[Any, Any] | None:
    """Origin and direction through the mouse, in whichever 3D viewport it is."""
    from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d

    for area in context.window.screen.areas:
        if area.type != "VIEW_3D":
            continue
        for region in area.regions:
            x, y = event.mouse_x - region.x, event.mouse_y - region.y
            if region.type == "WINDOW" and 0 <= x < region.width and 0 <= y < region.height:
                data: Any = region.data
                return region_2d_to_origin_3d(region, data, (x, y)), region_2d_to_vector_3d(region, data, (x, y))
    return None


def _write_text(found: tracing.Trace, placed: str) -> None:
    text = bpy.data.texts.get(TEXT_NAME) or bpy.data.texts.new(TEXT_NAME)
    text.clear()
    text.write("\n".join(f"{label:14} {value}" for label, value in found.rows()) + "\n")
    if placed:
        text.write(f"\n{placed}\n")


CLASSES = (CURVREFL_OT_trace_at_cursor, CURVREFL_OT_clear_trace)
