# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab in the 3D viewport's sidebar."""

from __future__ import annotations

from typing import Any

import bpy


class _Tab:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Curvrefl"


class CURVREFL_PT_main(_Tab, bpy.types.Panel):
    """The switch, the mirrors, and what keeps them from showing"""

    bl_label = "Curved Reflections"

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.window_manager, "curvrefl_enabled", text="")

    def draw(self, context: bpy.types.Context) -> None:
        from .. import viewport

        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        item = context.object
        if item is None:
            layout.label(text="Select an object to make it a mirror", icon="INFO")
        else:
            layout.prop(item.curvrefl, "is_mirror", text=f"{item.name} is a Mirror")
        messages = viewport.messages()
        scene = context.scene
        if scene is not None and not viewport.mirrors_of(scene):
            messages = ["No object is marked as a mirror", *messages]
        for message in messages:
            _wrapped(layout, message, context.region.width)


class CURVREFL_PT_quality(_Tab, bpy.types.Panel):
    """How reflections are found and how finely"""

    bl_label = "Quality"
    bl_parent_id = "CURVREFL_PT_main"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender's own convention)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.curvrefl
        layout.prop(settings, "method")
        layout.prop(settings, "pixel_tolerance")
        layout.prop(settings, "samples")


class CURVREFL_PT_statistics(_Tab, bpy.types.Panel):
    """What the last picture took"""

    bl_label = "Statistics"
    bl_parent_id = "CURVREFL_PT_main"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender's own convention)

    def draw(self, context: bpy.types.Context) -> None:
        from .. import viewport

        column = self.layout.column(align=True)
        for label, value in viewport.statistics():
            row = column.row()
            row.label(text=label)
            row.label(text=value)


def _wrapped(layout: Any, text: str, width: int) -> None:
    """A message over as many lines as the sidebar's width needs."""
    letters = max(int(width / 8), 20)
    column = layout.column(align=True)
    line = ""
    icon = "ERROR"
    for word in text.split():
        if len(line) + len(word) + 1 > letters and line:
            column.label(text=line, icon=icon)
            line, icon = "", "BLANK1"
        line = f"{line} {word}".strip()
    column.label(text=line, icon=icon)


CLASSES = (CURVREFL_PT_main, CURVREFL_PT_quality, CURVREFL_PT_statistics)
