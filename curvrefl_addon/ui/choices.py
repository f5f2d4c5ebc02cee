# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Items of the extension's menus, and its presets."""

from __future__ import annotations

from typing import Any

from ..diagnostic_colors import MODES
from ..optics.catalogue import METHODS

METHOD_ITEMS = [(name, method.label, f"{method.source}. Assumes: {method.assumes}") for name, method in METHODS.items()]
MOTION_ITEMS = [
    ("FULL", "Full", "Every pixel, also while something moves"),
    ("HALF", "Half", "A quarter of the pixels while something moves"),
    ("QUARTER", "Quarter", "A sixteenth of the pixels while something moves"),
]
ENVIRONMENT_ITEMS = [
    (
        "VIEWPORT",
        "As the Viewport",
        "The studio light in Material Preview where it is on, else the scene's world and lights",
    ),
    ("SCENE", "Scene", "The scene's world and lights, however the viewport is shaded"),
    ("IMAGE", "Image", "An equirectangular image in place of the world, and the scene's lights"),
]
SHOW_ITEMS = [
    ("REFLECTION", "Reflection", "What the mirrors reflect"),
    *((name, label, description) for name, (label, description) in MODES.items()),
]
FRESNEL_ITEMS = [
    ("METAL", "Metal", "Reflects the tint face on, and white at grazing angles"),
    ("DIELECTRIC", "Dielectric", "Reflects little face on and all at grazing angles, by the index of refraction"),
    ("CONSTANT", "Constant", "Reflects the tint at every angle"),
]

PRESETS: dict[str, tuple[str, str, dict[str, Any]]] = {
    "FAST": (
        "Fast",
        "For large scenes and slow machines: coarse edges, and a quarter of the resolution while something moves",
        {"pixel_tolerance": 2.0, "samples": 2, "map_resolution": 64, "motion_resolution": "QUARTER"},
    ),
    "BALANCED": (
        "Balanced",
        "Errors under half a pixel, smooth edges when the view rests",
        {"pixel_tolerance": 0.5, "samples": 8, "map_resolution": 128, "motion_resolution": "HALF"},
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
