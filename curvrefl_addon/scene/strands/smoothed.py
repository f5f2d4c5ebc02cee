# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands with more points, on the curve that Cycles draws through those there are. Pure numpy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import Float32Array
from .strands import Strands


def smoothed(strands: Strands, parts: int) -> Strands:
    """With each segment in so many parts, along a Catmull-Rom curve; attributes of points are linear between them."""
    count = len(strands.slots)
    if parts == 1 or count == 0:
        return strands
    lengths = (strands.lengths - 1) * parts + 1
    starts = np.concatenate([[0], np.cumsum(lengths)])
    number = np.arange(int(starts[-1])) - np.repeat(starts[:-1], lengths)
    first, last = np.repeat(strands.starts[:-1], lengths), np.repeat(strands.starts[1:] - 1, lengths)
    here = np.minimum(first + number // parts, last - 1)
    t = ((number - (here - first) * parts) / parts).astype(np.float32)[:, None]
    around = [np.maximum(here - 1, first), here, here + 1, np.minimum(here + 2, last)]
    weights = (
        -0.5 * t + t**2 - 0.5 * t**3,
        1.0 - 2.5 * t**2 + 1.5 * t**3,
        0.5 * t + 2.0 * t**2 - 1.5 * t**3,
        -0.5 * t**2 + 0.5 * t**3,
    )

    def between(values: Float32Array) -> Float32Array:
        return np.asarray(sum(w * values[rows] for w, rows in zip(weights, around, strict=True)), np.float32)

    radii = np.maximum(between(strands.radii[:, None])[:, 0], np.float32(0.0))
    layers = tuple(
        (item, values if len(values) == count else (1.0 - t) * values[here] + t * values[here + 1])
        for item, values in strands.layers
    )
    return replace(strands, points=between(strands.points), radii=radii, starts=starts, layers=layers)
