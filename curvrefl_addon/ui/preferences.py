# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's preferences: what new scenes start with, a memory limit, and colors of diagnostic views."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from dataclasses import dataclass, field
from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, IntProperty

from ..diagnostic_colors import DiagnosticColors
from .choices import METHOD_ITEMS, MOTION_ITEMS

PACKAGE = __package__.removesuffix(".curvrefl_addon.ui")
"""The extension as Blender knows it, for instance bl_ext.user_default.curvrefl"""
_COLORS = DiagnosticColors()


@dataclass(frozen=True, slots=True)
class Preferences:
    """What the rest of the extension reads of them."""

    method: str = "secant_star"
    pixel_tolerance: float = 0.5
    samples: int = 8
    map_resolution: int = 128
    motion_resolution: str = "HALF"
    memory_cap: int = 2048
    """MB"""
    colors: DiagnosticColors = field(default_factory=DiagnosticColors)


def current() -> Preferences:
    """The user's, or the defaults where the extension runs without being installed."""
    addon = bpy.context.preferences.addons.get(PACKAGE)
    chosen: Any = None if addon is None else addon.preferences
    if chosen is None:
        return Preferences()
    ramp = _COLORS.ramp
    if not (_is_color(chosen.color_low, ramp[0]) and _is_color(chosen.color_high, ramp[-1])):
        # Of other ends the five stops of the default are not the way from one to the other.
        ramp = (_triple(chosen.color_low), _triple(chosen.color_high))
    return Preferences(
        method=chosen.method,
        pixel_tolerance=chosen.pixel_tolerance,
        samples=chosen.samples,
        map_resolution=chosen.map_resolution,
        motion_resolution=chosen.motion_resolution,
        memory_cap=chosen.memory_cap,
        colors=DiagnosticColors(
            converged=_triple(chosen.color_converged),
            hidden=_triple(chosen.color_hidden),
            failed=_triple(chosen.color_failed),
            ramp=ramp,
        ),
    )


def _triple(color: Any) -> tuple[float, float, float]:
    red, green, blue = color
    return red, green, blue


def _is_color(color: Any, other: tuple[float, float, float]) -> bool:
    """Up to what properties round to."""
    return all(abs(one - two) < 1e-6 for one, two in zip(color, other, strict=True))


def _is_changed(_self: Any, _context: bpy.types.Context | None) -> None:
    from .. import viewport

    viewport.mirrors_changed()


def _color(name: str, description: str, default: tuple[float, float, float]) -> Any:
    return FloatVectorProperty(
        name=name, description=description, subtype="COLOR", min=0.0, max=1.0, default=default, update=_is_changed
    )


class CurvreflPreferences(bpy.types.AddonPreferences):
    """Preferences of the extension"""

    bl_idname = PACKAGE

    method: EnumProperty(  # type: ignore[valid-type]
        name="Method", description="How reflections are found in new scenes", items=METHOD_ITEMS, default="secant_star"
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
    map_resolution: IntProperty(  # type: ignore[valid-type]
        name="Map Resolution",
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
        for name in ("method", "pixel_tolerance", "samples", "map_resolution", "motion_resolution"):
            column.prop(self, name)
        layout.prop(self, "memory_cap")
        column = layout.column(heading="Diagnostic Views")
        for name in ("color_converged", "color_hidden", "color_failed", "color_low", "color_high"):
            column.prop(self, name)


CLASSES = (CurvreflPreferences,)
