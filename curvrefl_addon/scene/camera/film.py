# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene's film does to the light that falls on it."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ..arrays import Float32Array


def rendered_size(render: bpy.types.RenderSettings) -> tuple[int, int]:
    """Width and height in pixels of the pictures that a scene renders, its percentage counted in."""
    scale = render.resolution_percentage / 100.0
    return max(int(render.resolution_x * scale), 1), max(int(render.resolution_y * scale), 1)


def on_film(pixels: Float32Array, scene: bpy.types.Scene) -> Float32Array:
    """A scene-linear picture (h, w, 4) times the film exposure of Cycles, which alpha does not follow."""
    cycles: Any = getattr(scene, "cycles", None)
    if cycles is None or cycles.film_exposure == 1.0:
        return pixels
    return pixels * np.array([*[cycles.film_exposure] * 3, 1.0], np.float32)
