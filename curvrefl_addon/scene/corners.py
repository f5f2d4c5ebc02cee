# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners of faces, merged where they do not differ. Pure numpy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .arrays import Float32Array, Int32Array


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
    keys = [_bits(layer) for layer in layers]
    merged = np.empty(len(corner_vertex), np.int32)
    models: list[NDArray[np.int32]] = []
    model_of_vertex = np.empty(vertex_count, np.int32)
    number_of_vertex = np.empty(vertex_count, np.int32)
    remaining: NDArray[np.int32] = np.arange(len(corner_vertex), dtype=np.int32)
    count = 0
    while remaining.size:
        first_round = count == 0
        vertex = corner_vertex if first_round else corner_vertex[remaining]
        model_of_vertex[vertex] = remaining
        model = model_of_vertex[vertex]
        alike = np.ones(len(remaining), bool)
        for key in keys:
            for column in key:
                alike &= column[model] == (column if first_round else column[remaining])
        if first_round:
            new_models = model_of_vertex.copy()
            number_of_vertex[:] = np.arange(vertex_count, dtype=np.int32)
        else:
            new_models = remaining[model == remaining]
            number_of_vertex[corner_vertex[new_models]] = count + np.arange(len(new_models), dtype=np.int32)
        models.append(new_models)
        count += len(new_models)
        if alike.all():
            merged[remaining] = number_of_vertex[vertex]
            break
        merged[remaining[alike]] = number_of_vertex[vertex[alike]]
        remaining = remaining[~alike]
    return merged, np.concatenate(models) if models else np.empty(0, np.int32)


def _bits(layer: Float32Array) -> list[NDArray[np.int64] | NDArray[np.int32]]:
    """Columns of a (n, k) layer as integers, two floats in one where k is even: NaN equals itself."""
    layer = np.ascontiguousarray(layer, np.float32)
    bits = layer.view(np.int64) if layer.shape[1] % 2 == 0 else layer.view(np.int32)
    return [bits[:, column] for column in range(bits.shape[1])]
