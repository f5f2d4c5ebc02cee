# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the node Geometry knows of a mesh's edges: pointiness and a number for each island, as Cycles. Pure numpy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..arrays import Float32Array, Float64Array, Int32Array
from .jenkins import hashed_to_unit

POINTINESS, ISLAND = ".pointiness", ".random_per_island"
"""Names of attributes"""


def pointiness(positions: Float32Array, normals: Float32Array, edges: Int32Array) -> Float32Array:
    """(vertices,) from 0 in pits to 1 on tips, 0.5 where it is flat: the angle between a vertex's normal and the mean
    direction of its edges, and then the mean of it and its neighbors. `positions` and `normals` (vertices, 3), `edges`
    (n, 2). Vertices in one place are one."""
    _, first, weld = np.unique(positions + np.float32(0.0), axis=0, return_index=True, return_inverse=True)
    weld = weld.reshape(-1)
    count = len(first)
    normal = _unit(_summed(weld, normals.astype(np.float64), count))
    ends = np.sort(weld[edges], axis=1)
    ends = np.unique(ends[ends[:, 0] != ends[:, 1]], axis=0)
    places = positions[first].astype(np.float64)
    along = _unit(places[ends[:, 1]] - places[ends[:, 0]])
    total = _summed(ends[:, 0], along, count) - _summed(ends[:, 1], along, count)
    neighbors = np.bincount(ends.reshape(-1), minlength=count)
    mean = total / np.maximum(neighbors, 1)[:, None]
    angle = np.arccos(np.clip(np.einsum("ij,ij->i", normal, mean), -1.0, 1.0)) / np.pi
    angle[neighbors == 0] = 0.0
    near = np.bincount(ends[:, 0], angle[ends[:, 1]], count) + np.bincount(ends[:, 1], angle[ends[:, 0]], count)
    return ((angle + near) / (neighbors + 1))[weld].astype(np.float32)


def island_numbers(vertices: int, edges: Int32Array) -> Float32Array:
    """(vertices,) a number from 0 to 1, the same in all that edges (n, 2) join."""
    roots = _roots(vertices, edges)
    return hashed_to_unit(roots.astype(np.uint32))


def _roots(vertices: int, edges: Int32Array) -> NDArray[np.int64]:
    """The vertex that stands for each island. (Which it is depends on the order of joining: Cycles' own.)"""
    parents = list(range(vertices))
    ranks = [0] * vertices

    def root_of(vertex: int) -> int:
        root = vertex
        while parents[root] != root:
            root = parents[root]
        while parents[vertex] != root:
            parents[vertex], vertex = root, parents[vertex]
        return root

    for one, other in edges.tolist():
        a, b = root_of(one), root_of(other)
        if a == b:
            continue
        if ranks[a] < ranks[b]:
            a, b = b, a
        parents[b] = a
        if ranks[a] == ranks[b]:
            ranks[a] += 1
    return np.array([root_of(vertex) for vertex in range(vertices)], np.int64)


def _summed(places: NDArray[np.int64], vectors: Float64Array, count: int) -> Float64Array:
    return np.column_stack([np.bincount(places, vectors[:, axis], count) for axis in range(3)])


def _unit(vectors: Float64Array) -> Float64Array:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0.0)
