# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel of sections, joints and what is saved of an inspection."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, Any

import bpy

from ..settings_table import OF_SCENES
from .messages import draw_message, draw_rows
from .panel import SubPanel

if TYPE_CHECKING:
    from ..inspection.joints import CheckedJoints

MOST_EDGES = 8
"""In the table of the panel: the worst"""


class CURVREFL_PT_inspection(SubPanel, bpy.types.Panel):
    """Sections and joints of surfaces"""

    bl_label = "Inspection"

    def draw(self, context: bpy.types.Context) -> None:
        from ..inspection import shown as surface_lines

        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.curvrefl
        layout.prop(settings, "comb_show")
        column = layout.column()
        column.active = settings.comb_show
        for item in OF_SCENES:
            if item.panel == self.bl_label and item.name != "comb_show":
                column.prop(settings, item.name)
        if settings.comb_show and not context.window_manager.curvrefl_enabled:
            draw_message(layout, "Tick Curved Reflections above to see them", context, "INFO")
        elif settings.comb_show:
            draw_rows(layout, surface_lines.comb_rows())
        layout.separator()
        layout.operator("curvrefl.check_joints", icon="MOD_EDGESPLIT")
        if (checked := surface_lines.shown_joints()) is not None:
            box = layout.box()
            if surface_lines.joints_are_stale():
                draw_message(box, "What was checked has changed since: check it again", context, "INFO")
            else:
                _draw_joints(box, checked, context)
            layout.operator("curvrefl.clear_joints", icon="X")
        layout.separator()
        layout.operator("curvrefl.save_inspection", icon="IMAGE_DATA")
        layout.operator_menu_enum("curvrefl.export_inspection", "what", text="Export Table", icon="EXPORT")


def _draw_joints(layout: Any, checked: CheckedJoints, context: bpy.types.Context) -> None:
    """Counts, and a table of the worst edges."""
    from ..optics.meshes.joints import GRADES

    draw_rows(layout, checked.rows())
    for message in checked.messages:
        draw_message(layout, message, context, "INFO")
    joints = checked.joints
    columns: list[list[str]] = [["Edge"], ["Grade"], ["Gap, mm"], ["Angle"], ["1/m Apart"]]
    for number in checked.worst(MOST_EDGES):
        grade = int(checked.grades[number])
        cells = (
            str(number),
            GRADES[grade] if grade >= 0 else "",
            f"{1e3 * joints.gap[number]:.3g}",
            f"{degrees(joints.angle[number]):.3g}\u00b0",
            f"{joints.difference[number]:.3g}",
        )
        for column, cell in zip(columns, cells, strict=True):
            column.append("" if cell.startswith("nan") else cell)
    row = layout.row(align=True)
    for column in columns:
        cells_below = row.column(align=True)
        for cell in column:
            cells_below.label(text=cell)


CLASSES = (CURVREFL_PT_inspection,)
