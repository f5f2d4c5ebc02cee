# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tool in the 3D viewport's toolbar that lights are placed by."""

from __future__ import annotations

from typing import Any

import bpy

from ..viewport import light_overlay


class CURVREFL_WST_lights(bpy.types.WorkSpaceTool):
    """Lights by reflection"""

    bl_space_type = "VIEW_3D"
    bl_context_mode = "OBJECT"
    bl_idname = light_overlay.TOOL
    bl_label = "Lights by Reflection"
    bl_description = (
        "Drag on a mirror to move the active light or object to where it is seen under the cursor.\n"
        "Click or drag the reflection of another light to take that. Ctrl-click selects objects"
    )
    bl_icon = "ops.generic.cursor"
    bl_cursor = "CROSSHAIR"
    bl_keymap = (
        (light_overlay.OPERATOR, {"type": "LEFTMOUSE", "value": "PRESS"}, None),
        (
            "view3d.select",
            {"type": "LEFTMOUSE", "value": "PRESS", "ctrl": True},
            {"properties": [("deselect_all", True)]},
        ),
    )

    @staticmethod
    def draw_settings(_context: bpy.types.Context, layout: Any, tool: Any) -> None:
        """In the tool settings: the operator's own."""
        draw_placing(layout, tool.operator_properties(light_overlay.OPERATOR))
        if failure := light_overlay.failure():
            layout.label(text=failure, icon="ERROR")


def draw_placing(layout: Any, properties: Any) -> None:
    """What the tool's header and the operator's panel show of the operator's properties."""
    layout.prop(properties, "target")
    layout.prop(properties, "mode")
    if properties.target == "WORLD":
        layout.prop(properties, "level")
        if properties.mode == "RIM":
            layout.prop(properties, "rim_width")
        return
    row = layout.row(align=True, heading="Keep")
    for name in ("keep_distance", "keep_size", "keep_power"):
        row.prop(properties, name, toggle=True)
    if not properties.keep_distance:
        layout.prop(properties, "distance")
    layout.prop(properties, "aim")
    if properties.mode == "RIM":
        layout.prop(properties, "rim_width")


CLASSES = ()


def add() -> None:
    """Put the tool into the toolbar."""
    bpy.utils.register_tool(CURVREFL_WST_lights, after={"builtin.transform"}, separator=True)
    light_overlay.add()


def remove() -> None:
    """Take it out again."""
    light_overlay.remove()
    bpy.utils.unregister_tool(CURVREFL_WST_lights)
