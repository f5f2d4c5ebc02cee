# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of one sample through the pixels' centers, where nothing is left to chance, in Cycles."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from .judged import cycles_picture

WRONG = 0.02
"""Difference of a channel, scene-linear, at which a pixel shows something else"""


def centers() -> np.ndarray:
    """(h, w, 4) of the open scene."""
    scene: Any = bpy.context.scene
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BLACKMAN_HARRIS", 0.01
    return cycles_picture(1, 1)


def wrong_pixels(ours: np.ndarray, cycles: np.ndarray) -> np.ndarray:
    """(h, w) whether the two show different things."""
    return (np.abs(ours[..., :3] - cycles[..., :3]) > WRONG).any(-1)
