# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Small changes of settings that menus offer."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from typing import Any, Literal

import bpy
from bpy.props import EnumProperty

from ..curvrefl_addon.scene.opened.blend_file import SURFACE_TYPES
from ..curvrefl_addon.ui.choices import PRESETS


class CURVREFL_OT_toggle_mirror(bpy.types.Operator):
    """Make the selected objects mirrors, or no longer if the active one is"""

    bl_idname = "curvrefl.toggle_mirror"
    bl_label = "Mirror (Curvrefl)"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender's own convention)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not _surfaces(context):
            cls.poll_message_set("Select an object with a surface")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        chosen = _surfaces(context)
        first = context.object if context.object in chosen else chosen[0]
        is_mirror = not first.curvrefl.is_mirror
        locked = [item.name for item in chosen if not item.is_editable]
        for item in chosen:
            if item.is_editable:
                item.curvrefl.is_mirror = is_mirror
        if locked:
            self.report({"WARNING"}, f'"{locked[0]}" is linked: make a library override to change it')
            return {"FINISHED"} if len(locked) < len(chosen) else {"CANCELLED"}
        return {"FINISHED"}


class CURVREFL_OT_apply_preset(bpy.types.Operator):
    """Set tolerance, samples and resolutions for speed or for accuracy"""

    bl_idname = "curvrefl.apply_preset"
    bl_label = "Apply Quality Preset"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender's own convention)

    preset: EnumProperty(  # type: ignore[valid-type]
        name="Preset",
        description="Speed or accuracy",
        items=[(name, label, description) for name, (label, description, _) in PRESETS.items()],
        default="BALANCED",
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: Any) -> str:
        return PRESETS[properties.preset][1]

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene is not None

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        assert context.scene is not None
        for name, value in PRESETS[self.preset][2].items():
            setattr(context.scene.curvrefl, name, value)
        return {"FINISHED"}


def _surfaces(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Selected objects that can be mirrors."""
    return [item for item in context.selected_objects if item.type in SURFACE_TYPES]


CLASSES = (CURVREFL_OT_toggle_mirror, CURVREFL_OT_apply_preset)
