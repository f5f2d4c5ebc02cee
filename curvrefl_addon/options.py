# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user has chosen in the preferences, and how a scene's settings are to be taken."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import bpy

from .diagnostic_colors import DiagnosticColors

SETTINGS_VERSION = 1
"""Of `Scene.curvrefl`; a scene with a greater one was saved by a newer extension"""
PACKAGE = __package__.removesuffix(".curvrefl_addon")
"""The extension as Blender knows it, for instance bl_ext.user_default.curvrefl"""
_DEFAULTS = DiagnosticColors()


@dataclass(frozen=True, slots=True)
class Options:
    """What the rest of the extension reads of them."""

    method: str = "secant_star"
    pixel_tolerance: float = 0.5
    samples: int = 8
    map_resolution: int = 128
    motion_resolution: str = "HALF"
    memory_cap: int = 2048
    """MB"""
    colors: DiagnosticColors = field(default_factory=DiagnosticColors)


def current_options() -> Options:
    """The user's, or the defaults where the extension runs without being installed."""
    addon = bpy.context.preferences.addons.get(PACKAGE)
    chosen: Any = None if addon is None else addon.preferences
    if chosen is None:
        return Options()
    ramp = _DEFAULTS.ramp
    if not (_is_color(chosen.color_low, ramp[0]) and _is_color(chosen.color_high, ramp[-1])):
        # Of other ends the five stops of the default are not the way from one to the other.
        ramp = (_triple(chosen.color_low), _triple(chosen.color_high))
    return Options(
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


def newer_settings(scene: bpy.types.Scene) -> str:
    """A sentence for the user where the scene was saved by a newer extension, or nothing."""
    if scene.curvrefl.version <= SETTINGS_VERSION:
        return ""
    return "The file was saved with a newer Curvrefl: settings that this one does not know are left out. Update it."
