# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's preferences: what new scenes start with, a memory limit, and colors of diagnostic views."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import FloatVectorProperty

from ..diagnostics.colors import DiagnosticColors
from ..options import PACKAGE
from ..settings_table import OF_NEW_SCENES, OF_PREFERENCES
from .messages import draw_message, draw_rows
from .table_properties import properties_of

_COLORS = DiagnosticColors()


def _is_changed(_self: Any, _context: bpy.types.Context | None) -> None:
    from ..viewport import handlers as viewport

    viewport.mirrors_changed()


def _color(name: str, description: str, default: tuple[float, float, float]) -> Any:
    return FloatVectorProperty(
        name=name, description=description, subtype="COLOR", min=0.0, max=1.0, default=default, update=_is_changed
    )


class CurvreflPreferences(bpy.types.AddonPreferences):
    """Preferences of the extension"""

    bl_idname = PACKAGE

    __annotations__ = {
        **properties_of(OF_NEW_SCENES, of_new_scenes=True),
        **properties_of(OF_PREFERENCES, _is_changed),
        "color_converged": _color("Reflected", "Vertices whose reflection was found", _COLORS.converged),
        "color_hidden": _color("Hidden", "Vertices that the mirror itself hides", _COLORS.hidden),
        "color_failed": _color("Not Found", "Vertices without a solution", _COLORS.failed),
        "color_low": _color("Least", "Low end of the ramp of iterations and errors", _COLORS.ramp[0]),
        "color_high": _color("Most", "High end of the ramp of iterations and errors", _COLORS.ramp[-1]),
    }

    def draw(self, context: bpy.types.Context) -> None:
        from ..viewport import device_run

        layout = self.layout
        layout.use_property_split = True
        column = layout.column(heading="New Scenes")
        for item in OF_NEW_SCENES:
            column.prop(self, item.name)
        for item in OF_PREFERENCES:
            layout.prop(self, item.name)
        box = layout.box()
        draw_rows(box, device_run.rows())
        for message in device_run.messages():
            draw_message(box, message, context)
        row = box.row()
        row.operator("curvrefl.measure_device")
        row.operator("curvrefl.forget_device")
        row.operator("curvrefl.copy_report")
        column = layout.column(heading="Diagnostic Views")
        for name in ("color_converged", "color_hidden", "color_failed", "color_low", "color_high"):
            column.prop(self, name)


CLASSES = (CurvreflPreferences,)
