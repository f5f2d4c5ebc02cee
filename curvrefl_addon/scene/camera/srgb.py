# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The curve of sRGB (IEC 61966-2-1), any shape. Pure numpy."""

from __future__ import annotations

from typing import Any

import numpy as np

LINEAR_END, ENCODED_END = 0.0031308, 0.04045
"""Below them the curve is straight"""
SLOPE = 12.92


def linear_to_srgb(values: Any) -> Any:
    """What a screen is sent, in the precision of `values`; numbers above 1 and below 0 go on."""
    curve = 1.055 * np.maximum(values, LINEAR_END) ** (1.0 / 2.4) - 0.055
    return np.where(values <= LINEAR_END, SLOPE * values, curve)


def srgb_to_linear(values: Any) -> Any:
    """The inverse."""
    curve = ((np.maximum(values, 0.0) + 0.055) / 1.055) ** 2.4
    return np.where(values <= ENCODED_END, values / SLOPE, curve)
