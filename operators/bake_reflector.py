# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Bake a mesh into the radial maps that the solvers read, save them, and say how well they fit."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from typing import Literal

import bpy
from bpy.props import StringProperty

from ..curvrefl_addon.errors import InputError
from ..curvrefl_addon.settings_table import NAMED
from ..curvrefl_addon.ui.table_properties import property_of
from .paths import output_path


class CURVREFL_OT_bake_reflector(bpy.types.Operator):
    """Bake the reflector into cube maps, save them into a folder, and report how well they fit the mesh"""

    bl_idname = "curvrefl.bake_reflector"
    bl_label = "Bake Reflector"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    reflector: StringProperty(  # type: ignore[valid-type]
        name="Reflector", description="Name of the mirror object; the active object if empty"
    )
    resolution: property_of(  # type: ignore[valid-type]
        NAMED["map_resolution"], name="Resolution", description="Texels along an edge of a cube face"
    )
    folder: StringProperty(  # type: ignore[valid-type]
        name="Folder",
        description="Where the maps go",
        subtype="DIR_PATH",
        default="//curvrefl_bake",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.scene is None or not any(obj.type == "MESH" for obj in context.scene.objects):
            cls.poll_message_set("The scene has no mesh")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        from ..curvrefl_addon.output import checked_folder, folder_to_publish
        from ..curvrefl_addon.renderer.device.context import GpuUnavailableError
        from ..curvrefl_addon.renderer.mirrors.reflector_bake import bake_reflector
        from ..curvrefl_addon.renderer.mirrors.reflector_files import save
        from ..curvrefl_addon.scene.opened.render_depsgraph import read_rendered

        scene, view_layer = context.scene, context.view_layer
        assert scene is not None and view_layer is not None
        try:
            folder = checked_folder(output_path(self.folder, "a folder for the maps"))
            arrays = read_rendered(scene, view_layer, [self._reflector_name(context)])
            baked = bake_reflector(arrays, arrays.reflectors[0], self.resolution)
            with folder_to_publish(folder) as part:
                save(baked, part)
        except (InputError, GpuUnavailableError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        for warning in baked.warnings:
            self.report({"WARNING"}, warning)
        for sentence in baked.describe():
            self.report({"INFO"}, sentence)
        self.report({"INFO"}, f"The maps are in {folder}")
        return {"FINISHED"}

    def _reflector_name(self, context: bpy.types.Context) -> str:
        if self.reflector:
            return self.reflector
        if context.active_object is None:
            raise InputError("No reflector: make a mesh object active or name one.")
        return context.active_object.name


CLASSES = (CURVREFL_OT_bake_reflector,)
