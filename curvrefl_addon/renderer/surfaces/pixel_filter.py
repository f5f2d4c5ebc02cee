# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where in a pixel the sub-frames of an anti-aliased picture look.

Sub-frames have equal weights; their offsets are spread as Cycles' pixel filter is, a Blackman-Harris window, so that
the average converges to the same picture.
"""

from __future__ import annotations

import numpy as np

from ...scene.arrays import Float64Array
from ...scene.camera.sampling import hammersley, is_progressive, progressive_points

WIDTH = 3.0
"""Pixels from end to end: Cycles' default filter width of 1.5 is half of a Blackman-Harris window's"""
_SEED = 1510
_COEFFICIENTS = (0.35875, -0.48829, 0.14128, -0.01168)


def offsets(samples: int) -> Float64Array:
    """(samples, 2) pixel offsets, mean zero; one sample looks through the pixel's center."""
    if samples == 1:
        return np.zeros((1, 2))
    points = progressive_points(samples, _SEED) if is_progressive(samples) else hammersley(samples)
    position = np.linspace(-0.5, 0.5, 1025)
    window = np.cos(2 * np.pi * np.outer(position + 0.5, np.arange(4))) @ np.array(_COEFFICIENTS)
    cumulative = np.concatenate([[0.0], np.cumsum(0.5 * (window[1:] + window[:-1]))])
    spread = np.interp(points, cumulative / cumulative[-1], position) * WIDTH
    return spread - spread.mean(axis=0)
