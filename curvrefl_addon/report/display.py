# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The display transform that pictures are compared and saved through."""

from __future__ import annotations

import numpy as np

from ..scene.arrays import Float32Array
from ..scene.camera.srgb import linear_to_srgb, srgb_to_linear


def display_transform(linear: Float32Array) -> Float32Array:
    """Blender's "Standard" view of scene-linear Rec.709 on an sRGB screen: clipped to 0..1, then the sRGB curve.

    `linear`: any shape, color only (no alpha). Not-a-number becomes 0, as a screen would show it.
    """
    clipped = np.clip(np.nan_to_num(linear, nan=0.0, posinf=1.0, neginf=0.0), 0.0, 1.0)
    return linear_to_srgb(clipped).astype(np.float32)


def inverse_display_transform(encoded: Float32Array) -> Float32Array:
    """Scene-linear colors that the display transform shows as `encoded` (in 0..1)."""
    return srgb_to_linear(encoded).astype(np.float32)
