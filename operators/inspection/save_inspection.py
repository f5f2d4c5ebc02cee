# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Save what is shown of the mirrors' surfaces: a picture of the view, or tables of curvature, combs and joints."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from typing import Any, Literal

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty

from ...curvrefl_addon.errors import InputError
from ...curvrefl_addon.settings_table import NAMED, STILL_SAMPLES
from ...curvrefl_addon.ui.table_properties import property_of
from ..paths import ChoosesFile, output_path


class CURVREFL_OT_save_inspection(ChoosesFile, bpy.types.Operator):
    """Save a picture of the view with its diagnostic view, combs, checked joints and legends"""

    bl_idname = "curvrefl.save_inspection"
    bl_label = "Save Inspection Picture"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    filepath: StringProperty(  # type: ignore[valid-type]
        name="File",
        description="Picture to write, .png",
        subtype="FILE_PATH",
        default="//curvrefl_inspection.png",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    from_camera: BoolProperty(  # type: ignore[valid-type]
        name="From the Camera",
        description="At the size of the scene's renders, not what the 3D viewport shows; so it is without a viewport",
        default=False,
    )
    samples: property_of(  # type: ignore[valid-type]
        NAMED["samples"], description="Pictures that are averaged against jagged edges", default=STILL_SAMPLES
    )
    filter_glob: StringProperty(default="*.png", options={"HIDDEN"})  # type: ignore[valid-type]

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.scene is None or (context.scene.camera is None and _view_area(context) is None):
            cls.poll_message_set("There is neither a 3D viewport nor a camera")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        from ...curvrefl_addon.inspection import shown as surface_lines
        from ...curvrefl_addon.inspection.picture import save_picture
        from ...curvrefl_addon.output import checked_file
        from ...curvrefl_addon.renderer.device.context import GpuUnavailableError

        scene = context.scene
        assert scene is not None
        checked = None if surface_lines.joints_are_stale() else surface_lines.shown_joints()
        try:
            path = checked_file(output_path(self.filepath, "a file for the picture"), (".png",))
            depsgraph = context.evaluated_depsgraph_get()
            saved = save_picture(path, scene, depsgraph, self._view(context, depsgraph), self.samples, checked)
        except (InputError, GpuUnavailableError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        for warning in saved.warnings:
            self.report({"WARNING"}, warning)
        self.report({"INFO"}, f"Saved {path}")
        return {"FINISHED"}

    def _view(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> Any:
        """Of the 3D viewport that it is called in, or of the camera."""
        from ...curvrefl_addon.scene.camera.film import rendered_size
        from ...curvrefl_addon.scene.opened.blend_file import find_camera, view_of_camera
        from ...curvrefl_addon.viewport.region import view_of_area

        scene, area = context.scene, _view_area(context)
        assert scene is not None
        if area is None or self.from_camera:
            return view_of_camera(scene, find_camera(scene), *rendered_size(scene.render), depsgraph)
        return view_of_area(context, area)


class CURVREFL_OT_export_inspection(ChoosesFile, bpy.types.Operator):
    """Write curvature, combs or checked joints into a table for other programs"""

    bl_idname = "curvrefl.export_inspection"
    bl_label = "Export Inspection Table"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    filepath: StringProperty(  # type: ignore[valid-type]
        name="File",
        description="Table to write, .csv",
        subtype="FILE_PATH",
        default="//curvrefl_inspection.csv",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    what: EnumProperty(  # type: ignore[valid-type]
        name="What",
        description="What the rows of the table are",
        items=(
            ("CURVATURE", "Curvature", "Principal curvatures of every vertex of the mirrors"),
            ("COMBS", "Combs", "Curvature along the sections of the mirrors, as set in the panel"),
            ("JOINTS", "Joints", "The edges that were checked last"),
        ),
        default="CURVATURE",
    )
    filter_glob: StringProperty(default="*.csv", options={"HIDDEN"})  # type: ignore[valid-type]

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene is not None

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        from ...curvrefl_addon.output import checked_file, write_whole

        try:
            path = checked_file(output_path(self.filepath, "a file for the table"), (".csv",))
            text = self._table(context)
            write_whole(path, text)
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Wrote {text.count(chr(10)) - 1} rows to {path}")
        return {"FINISHED"}

    def _table(self, context: bpy.types.Context) -> str:
        from ...curvrefl_addon.inspection import shown as surface_lines
        from ...curvrefl_addon.inspection import tables
        from ...curvrefl_addon.inspection.chosen import combs_of
        from ...curvrefl_addon.options import mirrors_in

        scene = context.scene
        assert scene is not None
        if self.what == "JOINTS":
            checked = surface_lines.shown_joints()
            if checked is None:
                raise InputError("No joints were checked: do that first.")
            if surface_lines.joints_are_stale():
                raise InputError("What was checked has changed since: check the joints again.")
            return tables.joint_table(checked)
        depsgraph = context.evaluated_depsgraph_get()
        mirrors = tables.read_mirrors(depsgraph, scene, mirrors_in(depsgraph))
        if self.what == "COMBS":
            return tables.comb_table(mirrors, combs_of(scene))
        return tables.curvature_table(mirrors)


def _view_area(context: bpy.types.Context) -> Any:
    """The 3D viewport that an operator is called in, if it is in one."""
    return context.area if context.area is not None and context.area.type == "VIEW_3D" else None


CLASSES = (CURVREFL_OT_save_inspection, CURVREFL_OT_export_inspection)
