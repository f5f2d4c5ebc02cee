# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles on the texels of an image, and which of a surface's triangles hang together there. Pure numpy."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...optics.meshes.components import components
from ...scene.arrays import Float64Array

AT_ONCE = 1 << 21
"""Pairs of a triangle and a texel that are looked at together"""
ROUNDING = 1e-9
"""Barycentric, by which triangles overlap: no texel is between two of them"""

type Indices = NDArray[np.int64]


def texels_of(corners: Float64Array, width: int, height: int) -> Iterator[tuple[Indices, Indices]]:
    """(triangle, texel) in pieces: all texels whose middles are in triangles with these corners (n, 3, 2), in texels
    from the image's lower left corner; a texel's number is column + row * width. Triangles come in their order."""
    low = np.ceil(np.clip(corners.min(axis=1), -1.0, (width + 1.0, height + 1.0)) - 0.5 - 1e-6).astype(np.int64)
    high = np.floor(np.clip(corners.max(axis=1), -1.0, (width + 1.0, height + 1.0)) - 0.5 + 1e-6).astype(np.int64)
    low, high = np.maximum(low, 0), np.minimum(high, (width - 1, height - 1))
    size = np.maximum(high - low + 1, 0)
    counts = size[:, 0] * size[:, 1]
    edges = corners[:, 1:] - corners[:, :1]
    area = edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
    used = np.flatnonzero((counts > 0) & np.isfinite(area) & (area != 0.0))
    ends = np.cumsum(counts[used])
    first = 0
    while first < len(used):
        done = ends[first - 1] if first else 0
        last = max(int(np.searchsorted(ends, done + AT_ONCE, side="right")), first + 1)
        yield from _texels_of(used[first:last], low, size, counts, corners, edges, area, width)
        first = last


def _texels_of(
    some: Indices,
    low: Indices,
    size: Indices,
    counts: Indices,
    corners: Float64Array,
    edges: Float64Array,
    area: Float64Array,
    width: int,
) -> Iterator[tuple[Indices, Indices]]:
    total = int(counts[some].sum())
    starts = np.cumsum(counts[some]) - counts[some]
    for begin in range(0, total, AT_ONCE):  # (one triangle may cover an image of any size)
        number = np.arange(begin, min(begin + AT_ONCE, total))
        which = np.searchsorted(starts, number, side="right") - 1
        triangle = some[which]
        row, column = np.divmod(number - starts[which], size[triangle, 0])
        column, row = column + low[triangle, 0], row + low[triangle, 1]
        offset = np.column_stack([column + 0.5, row + 0.5]) - corners[triangle, 0]
        one, other = edges[triangle, 0], edges[triangle, 1]
        second = (offset[:, 0] * other[:, 1] - offset[:, 1] * other[:, 0]) / area[triangle]
        third = (one[:, 0] * offset[:, 1] - one[:, 1] * offset[:, 0]) / area[triangle]
        inside = (second >= -ROUNDING) & (third >= -ROUNDING) & (second + third <= 1.0 + ROUNDING)
        yield triangle[inside], (column + row * width)[inside]


def affine_maps(corners: Float64Array, values: Float64Array) -> tuple[Float64Array, Float64Array]:
    """(n, 2, 2) and (n, 2): matrix and offset of the maps that take corners (n, 3, 2) to values (n, 3, 2). Triangles
    have an area."""
    edges = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
    steps = np.swapaxes(values[:, 1:] - values[:, :1], 1, 2)
    area = edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
    inverse = np.empty_like(edges)
    inverse[:, 0, 0], inverse[:, 1, 1] = edges[:, 1, 1], edges[:, 0, 0]
    inverse[:, 0, 1], inverse[:, 1, 0] = -edges[:, 0, 1], -edges[:, 1, 0]
    matrix = steps @ (inverse / area[:, None, None])
    return matrix, values[:, 0] - np.einsum("nij,nj->ni", matrix, corners[:, 0])


def islands_of(vertices: NDArray[np.integer], places: Float64Array) -> Indices:
    """(n,) a number for each of n triangles with these vertices (n, 3) at these places (n, 3, 2) of an image: the same
    where they hang together there, by corners of the same vertex at the same place."""
    keys = np.column_stack([vertices.ravel().astype(np.float64), places.reshape(-1, 2)])
    _, corner = np.unique(keys, axis=0, return_inverse=True)
    corner = corner.reshape(-1, 3)
    pairs = np.concatenate([corner[:, :2], corner[:, 1:]])
    return components(int(corner.max(initial=-1)) + 1, pairs)[corner[:, 0]]


def grown(owner: Indices, may_grow: NDArray[np.bool_]) -> Indices:
    """(h, w) of -1 or a number; texels without one that `may_grow` take that of a neighbor, one texel far."""
    padded = np.pad(owner, 1, constant_values=-1)
    height, width = owner.shape
    wanted = (owner < 0) & may_grow
    near = np.zeros_like(wanted)
    steps = [(0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)]
    for y, x in steps:
        near |= padded[1 + y : 1 + y + height, 1 + x : 1 + x + width] >= 0
    row, column = np.nonzero(wanted & near)
    result = owner.copy()
    for y, x in reversed(steps):  # (those beside it count before those across)
        value = padded[row + 1 + y, column + 1 + x]
        result[row, column] = np.where(value >= 0, value, result[row, column])
    return result
