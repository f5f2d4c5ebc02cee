# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Measure how smoothly surfaces meet: along marked edges of an object, or where two objects touch."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from math import pi
from typing import Any, Literal

import bpy
from bpy.props import EnumProperty, FloatProperty

from ...curvrefl_addon.errors import InputError
from ...curvrefl_addon.scene.opened.areas import redraw_views
from ...curvrefl_addon.scene.opened.blend_file import SURFACE_TYPES


class CURVREFL_OT_check_joints(bpy.types.Operator):
    """Measure gap, angle and difference of curvature along edges where surfaces meet, and color them by that"""

    bl_idname = "curvrefl.check_joints"
    bl_label = "Check Joints"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    edges: EnumProperty(  # type: ignore[valid-type]
        name="Edges",
        description="Where the surfaces meet",
        items=(
            ("SHARP", "Marked Sharp", "Edges of the active object that are marked sharp"),
            ("SEAM", "Seams", "Edges of the active object that are UV seams"),
            ("FREESTYLE", "Freestyle", "Edges of the active object that are marked for Freestyle"),
            ("SELECTED", "Selected", "Edges of the active object that are selected in Edit Mode"),
            ("OBJECTS", "Between Two Objects", "Open edges of the active object near those of the other selected one"),
        ),
        default="SHARP",
    )
    gap: FloatProperty(  # type: ignore[valid-type]
        name="Largest Gap",
        description="Surfaces that are less apart touch",
        default=0.0001,
        min=0.0,
        subtype="DISTANCE",
        precision=5,
    )
    angle: FloatProperty(  # type: ignore[valid-type]
        name="Largest Angle",
        description="Surfaces whose normals differ less are tangent",
        default=0.1 * pi / 180.0,
        min=0.0,
        max=pi,
        subtype="ANGLE",
        precision=3,
    )
    curvature: FloatProperty(  # type: ignore[valid-type]
        name="Largest Difference",
        description="Of the curvatures across the edge, over the larger one: below it they are the same",
        default=0.1,
        min=0.0,
        max=1.0,
    )
    reach: FloatProperty(  # type: ignore[valid-type]
        name="Reach",
        description="How far apart edges of two objects may be; 0 for half an edge of the active one",
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        item = context.object
        if item is None or item.type not in SURFACE_TYPES:
            cls.poll_message_set("Make an object with a surface active")
            return False
        return True

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> Any:
        if context.mode == "EDIT_MESH" and not self.properties.is_property_set("edges"):
            self.edges = "SELECTED"
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("edges", "gap", "angle", "curvature"):
            layout.prop(self, name)
        if self.edges == "OBJECTS":
            layout.prop(self, "reach")

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        from ...curvrefl_addon.inspection import shown as surface_lines
        from ...curvrefl_addon.inspection.joints import Tolerances, check_edges, check_objects

        item = context.object
        assert item is not None
        depsgraph = context.evaluated_depsgraph_get()
        tolerances = Tolerances(self.gap, self.angle, self.curvature)
        try:
            if self.edges == "OBJECTS":
                other = _other_selected(context, item)
                checked = check_objects(item, other, depsgraph, self.reach, tolerances)
            else:
                checked = check_edges(item, depsgraph, self.edges, tolerances)
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        surface_lines.show_joints(checked)
        for message in checked.messages:
            self.report({"WARNING"}, message)
        self.report({"INFO"}, checked.sentence())
        redraw_views()
        return {"FINISHED"}


class CURVREFL_OT_clear_joints(bpy.types.Operator):
    """Take the checked joints out of the viewports"""

    bl_idname = "curvrefl.clear_joints"
    bl_label = "Clear Joints"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        from ...curvrefl_addon.inspection import shown as surface_lines

        return surface_lines.shown_joints() is not None

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        from ...curvrefl_addon.inspection import shown as surface_lines

        surface_lines.clear_joints()
        redraw_views()
        return {"FINISHED"}


def _other_selected(context: bpy.types.Context, item: bpy.types.Object) -> bpy.types.Object:
    others = [obj for obj in context.selected_objects if obj != item and obj.type in SURFACE_TYPES]
    if len(others) != 1:
        raise InputError("Select two objects: the joint is where the open edges of both are close.")
    return others[0]


CLASSES = (CURVREFL_OT_check_joints, CURVREFL_OT_clear_joints)
