# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's preferences: what new scenes start with, a memory limit, and colors of diagnostic views."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, IntProperty

from ..diagnostic_colors import DiagnosticColors
from ..options import PACKAGE, QUALITY
from .choices import METHOD_ITEMS, MOTION_ITEMS

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

    method: EnumProperty(  # type: ignore[valid-type]
        name="Method", description="How reflections are found in new scenes", items=METHOD_ITEMS, default="auto"
    )
    pixel_tolerance: FloatProperty(  # type: ignore[valid-type]
        name="Tolerance",
        description="Largest error of a reflected edge in new scenes",
        subtype="PIXEL",
        default=0.5,
        min=0.05,
        max=20.0,
    )
    samples: IntProperty(  # type: ignore[valid-type]
        name="Samples", description="Pictures that are averaged in new scenes", default=8, min=1, max=64
    )
    bounces: IntProperty(  # type: ignore[valid-type]
        name="Bounces", description="Mirrors seen in mirrors in new scenes", default=4, min=1, max=32
    )
    map_resolution: IntProperty(  # type: ignore[valid-type]
        name="Map Size",
        description="Texels along an edge of a mirror's cube map in new scenes",
        default=128,
        min=16,
        max=1024,
    )
    motion_resolution: EnumProperty(  # type: ignore[valid-type]
        name="While Moving",
        description="Resolution while something moves in new scenes",
        items=MOTION_ITEMS,
        default="HALF",
    )
    memory_cap: IntProperty(  # type: ignore[valid-type]
        name="Memory Limit",
        description="GPU memory in MB that a scene's meshes may take; larger scenes are not drawn",
        default=2048,
        min=64,
        max=1 << 20,
        update=_is_changed,
    )
    color_converged: _color("Reflected", "Vertices whose reflection was found", _COLORS.converged)  # type: ignore[valid-type]
    color_hidden: _color("Hidden", "Vertices that the mirror itself hides", _COLORS.hidden)  # type: ignore[valid-type]
    color_failed: _color("Not Found", "Vertices without a solution", _COLORS.failed)  # type: ignore[valid-type]
    color_low: _color("Least", "Low end of the ramp of iterations and errors", _COLORS.ramp[0])  # type: ignore[valid-type]
    color_high: _color("Most", "High end of the ramp of iterations and errors", _COLORS.ramp[-1])  # type: ignore[valid-type]

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        column = layout.column(heading="New Scenes")
        for name in QUALITY:
            column.prop(self, name)
        layout.prop(self, "memory_cap")
        column = layout.column(heading="Diagnostic Views")
        for name in ("color_converged", "color_hidden", "color_failed", "color_low", "color_high"):
            column.prop(self, name)


CLASSES = (CurvreflPreferences,)
