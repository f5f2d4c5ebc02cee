# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Filling a parametric map where its UV map leaves texels without a surface."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float64Array


def joins_around(values: Float64Array, hit: NDArray[np.bool_], axis: int) -> bool:
    """Whether the map's first and last texels along u (0) or v (1) are neighbors on the surface."""
    first, last = ((slice(None), 0), (slice(None), -1)) if axis == 0 else ((0,), (-1,))
    both = hit[first] & hit[last]
    if both.mean() < 0.5:
        return False
    tangent = slice(6, 9) if axis == 0 else slice(9, 12)
    step = np.linalg.norm(values[first][both, tangent] + values[last][both, tangent], axis=-1) / (2 * len(hit))
    gap = np.linalg.norm(values[first][both, :3] - values[last][both, :3], axis=-1)
    return bool((gap <= 2.0 * step).mean() > 0.9)


def filled_texels(
    values: Float64Array, hit: NDArray[np.bool_], wraps: Sequence[bool], poles: Sequence[bool]
) -> Float64Array:
    """Values (rows, columns, n) with texels that no triangle covers taken from the nearest ones along u or along v.

    At a pole every second triangle of the map is missing: it has no extent on the surface, where two of its sides are
    one edge. What belongs there is what is on these sides, along the parameter that does not matter at the pole.
    """
    while not hit.all():
        along_u, distance_u = texels_between(values, hit, wraps[0])
        along_v, distance_v = texels_between(values.swapaxes(0, 1), hit.T, wraps[1])
        along_v, distance_v = along_v.swapaxes(0, 1), distance_v.T
        # What a whole line lacks is taken from the lines beside it when these are complete.
        if poles[0] and not poles[1] and (np.isfinite(distance_u) & ~hit).any():
            distance_v = np.full_like(distance_v, np.inf)
        if poles[1] and not poles[0] and (np.isfinite(distance_v) & ~hit).any():
            distance_u = np.full_like(distance_u, np.inf)
        by_v = distance_u > distance_v
        known = np.isfinite(np.minimum(distance_u, distance_v))
        values = np.where((known & ~hit)[..., None], np.where(by_v[..., None], along_v, along_u), values)
        hit = hit | known
    return values


def texels_between(values: Float64Array, hit: NDArray[np.bool_], wraps: bool) -> tuple[Float64Array, Float64Array]:
    """Per texel, the values (rows, columns, n) interpolated between the nearest hits to the left and right in its row,
    and the distance (rows, columns) of the nearer one in texels; infinite where there is none."""
    columns = hit.shape[1]
    copies = 3 if wraps else 1
    tiled = np.tile(hit, (1, copies))
    place = np.arange(copies * columns, dtype=np.float64)
    before = np.maximum.accumulate(np.where(tiled, place, -np.inf), axis=1)
    after = np.minimum.accumulate(np.where(tiled, place, np.inf)[:, ::-1], axis=1)[:, ::-1]
    middle = slice(columns, 2 * columns) if wraps else slice(None)
    left, right = (place - before)[:, middle], (after - place)[:, middle]
    # By the inverse distance: a side without a hit gets no weight.
    left_weight, right_weight = 1.0 / np.maximum(left, 1.0), 1.0 / np.maximum(right, 1.0)
    share = (right_weight / np.maximum(left_weight + right_weight, 1e-30))[..., None]
    rows, column = np.indices(hit.shape)
    from_left, from_right = (
        values[rows, (column + sign * np.where(np.isfinite(side), side, 0.0).astype(np.int64)) % columns]
        for sign, side in ((-1, left), (1, right))
    )
    return from_left * (1.0 - share) + from_right * share, np.minimum(left, right)
