# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners of faces, merged where they do not differ. Pure numpy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..arrays import Float32Array, Int32Array

BLOCK = 1 << 16
"""Corners at a time: temporary arrays of that many stay in the cache, and few new pages are asked for"""


def merge_corners(
    corner_vertex: Int32Array, vertex_count: int, layers: Sequence[Float32Array]
) -> tuple[Int32Array, Int32Array]:
    """Find the corners that share a vertex and all values.

    `corner_vertex`: (corners,) vertex of every corner; every vertex has at least one. `layers`: (corners, k) values,
    compared bit by bit. Returns (corners,) the merged corner of each corner, and (merged,) one of the corners that
    each stands for. Merged corner i < `vertex_count` is at vertex i; what differs from it follows after.

    Works in rounds: in each, every vertex has one of its remaining corners as a model, and those like it join it. A
    vertex needs as many rounds as it has distinct corners, and each round looks only at what is left.
    """
    columns = [column for layer in layers for column in _bits(layer)]
    count = len(corner_vertex)
    model_of_vertex = np.empty(vertex_count, np.intp)
    for start in range(0, count, BLOCK):
        stop = min(start + BLOCK, count)
        model_of_vertex[corner_vertex[start:stop]] = np.arange(start, stop)
    models = [model_of_vertex.astype(np.int32)]
    alike = np.ones(count, bool)
    for column in columns:
        of_model = column[model_of_vertex]
        for start in range(0, count, BLOCK):
            block = slice(start, start + BLOCK)
            alike[block] &= of_model.take(corner_vertex[block]) == column[block]
    if alike.all():
        return corner_vertex, models[0]

    vertex = corner_vertex.astype(np.intp)
    merged = corner_vertex.copy()
    number_of_vertex = np.empty(vertex_count, np.int32)
    count = vertex_count
    remaining = np.flatnonzero(~alike)
    while remaining.size:
        vertex_left = vertex[remaining]
        model_of_vertex[vertex_left] = remaining
        model = model_of_vertex[vertex_left]
        alike = np.ones(len(remaining), bool)
        for column in columns:
            alike &= column[model] == column[remaining]
        new_models = remaining[model == remaining]
        number_of_vertex[vertex[new_models]] = count + np.arange(len(new_models), dtype=np.int32)
        merged[remaining[alike]] = number_of_vertex[vertex_left[alike]]
        models.append(new_models.astype(np.int32))
        count += len(new_models)
        remaining = remaining[~alike]
    return merged, np.concatenate(models)


def _bits(layer: Float32Array) -> list[NDArray[np.int64] | NDArray[np.int32]]:
    """Columns of a (n, k) layer as integers, two floats in one where k is even: NaN equals itself."""
    layer = np.ascontiguousarray(layer, np.float32)
    bits = layer.view(np.int64) if layer.shape[1] % 2 == 0 else layer.view(np.int32)
    return [bits[:, column] for column in range(bits.shape[1])]
