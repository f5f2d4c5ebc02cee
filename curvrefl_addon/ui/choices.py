# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The presets of the panel Quality."""

from __future__ import annotations

from typing import Any

PRESETS: dict[str, tuple[str, str, dict[str, Any]]] = {
    "FAST": (
        "Fast",
        "For large scenes and slow machines: coarse edges, and a quarter of the resolution while something moves",
        {"pixel_tolerance": 2.0, "samples": 2, "map_resolution": 64, "motion_resolution": "QUARTER"},
    ),
    "BALANCED": (
        "Balanced",
        "Errors under half a pixel, smooth edges when the view rests",
        {"pixel_tolerance": 0.5, "samples": 8, "map_resolution": 128, "motion_resolution": "AUTO"},
    ),
    "EXACT": (
        "Exact",
        "Errors under a fifth of a pixel and edges as in a final render, at full resolution all the time",
        {"pixel_tolerance": 0.2, "samples": 32, "map_resolution": 256, "motion_resolution": "FULL"},
    ),
}
"""Label, tooltip, and settings of `Scene.curvrefl`"""


def active_preset(settings: Any) -> str:
    """Name of the preset that the settings are at, or nothing."""
    for name, (_, _, values) in PRESETS.items():
        if all(
            abs(getattr(settings, key) - value) < 1e-5 if isinstance(value, float) else getattr(settings, key) == value
            for key, value in values.items()
        ):
            return name
    return ""
