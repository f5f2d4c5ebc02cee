# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of a chunk and their edges, as the shaders of footprints read them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.geometry.chunk import Chunk
from curvrefl.curvrefl_addon.scene.arrays import Int32Array, MeshArrays


@dataclass
class Topology:
    """Triangles of a chunk and their edges on the GPU; vertices may move."""

    members: list[tuple[Int32Array, Int32Array]]
    """(triangles, corner_vertex) of its meshes: the same objects while the topology is the same"""
    triangles: Any
    edges: Any
    triangle_count: int
    edge_count: int


def are_same(known: list[tuple[Int32Array, Int32Array]], members: list[tuple[Int32Array, Int32Array]]) -> bool:
    return len(known) == len(members) and all(a is c and b is d for (a, b), (c, d) in zip(known, members, strict=True))


def read_topology(chunk: Chunk, members: list[tuple[Int32Array, Int32Array]]) -> Topology:
    triangles, edges = [], []
    vertices = corners = 0
    edge_count = 0
    for item in chunk.placed:
        mesh = item.drawn
        ends = mesh.corner_vertex[mesh.triangles]
        pairs, numbers = _edges_of(ends)
        records = np.zeros((len(ends), 3, 4), np.float32)
        records[:, 0, :3] = ends + vertices
        records[:, 0, 3] = _materials_of(mesh, item.instance.materials)
        records[:, 1, :3] = numbers + edge_count
        records[:, 2, :3] = mesh.triangles + corners
        triangles.append(records.reshape(-1, 4))
        edges.append(np.pad((pairs + vertices).astype(np.float32), ((0, 0), (0, 2))))
        vertices += len(mesh.positions)
        corners += len(mesh.corner_vertex)
        edge_count += len(pairs)
    joined = np.concatenate(triangles)
    return Topology(
        members, record_texture(joined), record_texture(np.concatenate(edges)), len(joined) // 3, edge_count
    )


def _edges_of(ends: Int32Array) -> tuple[np.ndarray, np.ndarray]:
    """Edges (n, 2) of triangles (m, 3), each once, and (m, 3) the numbers of those after each corner."""
    following = ends[:, [1, 2, 0]]
    low, high = np.minimum(ends, following).astype(np.int64), np.maximum(ends, following).astype(np.int64)
    keys, numbers = np.unique(low << 32 | high, return_inverse=True)
    return np.column_stack([keys >> 32, keys & 0xFFFFFFFF]), numbers.reshape(-1, 3)


def _materials_of(mesh: MeshArrays, materials: tuple[int, ...]) -> np.ndarray:
    return np.asarray(materials, np.int32)[np.minimum(mesh.triangle_slot, len(materials) - 1)]
