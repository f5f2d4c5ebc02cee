# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fills holes of a radial cube map smoothly, so that searches that stray into them stay sane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .cube_map import directions_at, nearest_texel, texel_directions
from .radial_surfaces import Float64Array, tangential

MAX_RIM = 512
"""Of a longer rim, an even spread of about so many texels is used."""
_CHUNK = 4096


def fill_holes(radial: Float64Array, hit: NDArray[np.bool_]) -> Float64Array:
    """Copy of the map `radial` (6, n, n, 4) with r and its exact gradient continued where `hit` (6, n, n) is false.

    r is the mean over the texels around the holes, weighted by the inverse fourth power of their distance on the
    chord (Shepard's interpolation). At least one texel must have been hit.
    """
    resolution = radial.shape[1]
    directions = texel_directions(resolution)
    rim = _rim(hit)
    stride = -(-int(rim.sum()) // MAX_RIM)
    rim_directions, rim_radii = directions[rim][::stride], radial[rim][::stride, 0]
    filled = radial.copy()
    holes = np.argwhere(~hit)
    for start in range(0, len(holes), _CHUNK):
        chunk = tuple(holes[start : start + _CHUNK].T)
        u = directions[chunk]
        # |u - v|^2 = 2 - 2 u . v; a hundredth of a texel keeps it from 0.
        squared = 2.0 - 2.0 * u @ rim_directions.T + (0.02 / resolution) ** 2
        inverse = 1.0 / squared
        weights = inverse * inverse
        total = weights.sum(axis=1, keepdims=True)
        r = weights @ rim_radii[:, None] / total
        # d weight / d u = 4 v / squared^3
        slopes = (4.0 * weights * inverse) * (rim_radii - r)
        filled[chunk] = np.column_stack([r, tangential(slopes @ rim_directions / total, u)])
    return filled


def _rim(hit: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Texels (6, n, n) that were hit and touch a hole, over the faces' edges too."""
    resolution = hit.shape[1]
    face, row, column = np.nonzero(~hit)
    rim = np.zeros_like(hit)
    step = 2.0 / resolution
    s, t = (2 * column + 1) / resolution - 1.0, (2 * row + 1) / resolution - 1.0
    for ds in (-step, 0.0, step):
        for dt in (-step, 0.0, step):
            rim[nearest_texel(resolution, directions_at(face, s + ds, t + dt))] = True
    return rim & hit
