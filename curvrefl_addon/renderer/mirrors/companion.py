# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The closed shape that goes with an open mirror (Estalella et al. 2006, section 5.1), out of its filled radial map."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...optics.fermat import sample
from ...optics.surfaces.cube_map import CubeMapSurface, directions_at
from ...scene.arrays import Float64Array, InstanceArrays, MeshArrays
from ..geometry.chunk import Batches, Chunk, Placed
from .reflector_map import ReflectorMap


def closed_companion(
    baked: ReflectorMap, instance: InstanceArrays, world_to_map: Float64Array
) -> tuple[Chunk, Batches]:
    """A mesh of the map, where the mirror is; its faces meet at the cube's edges without a gap."""
    count = baked.resolution + 1
    edge = np.linspace(-1.0, 1.0, count)
    face, t, s = np.meshgrid(np.arange(6), edge, edge, indexing="ij")
    at = sample(CubeMapSurface(baked.radial), directions_at(face, s, t).reshape(-1, 3))
    low = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    quads = np.stack([low, low + 1, low + 1 + count, low + count], axis=1)
    quads = (quads + np.arange(6)[:, None, None] * count * count).reshape(-1, 4)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32)
    positions = at.position.astype(np.float32)
    mesh = MeshArrays(
        name=baked.object_name,
        positions=positions,
        corner_vertex=np.arange(len(positions), dtype=np.int32),
        corner_normals=at.normal.astype(np.float32),
        corner_uv=None,
        triangles=triangles,
        triangle_slot=np.zeros(len(triangles), np.int32),
    )
    placed = Placed(
        replace(instance, matrix=np.linalg.inv(world_to_map)), mesh, mesh, np.zeros(len(triangles), np.int8), mirror=1
    )
    chunk = Chunk([placed])
    return chunk, chunk.batches(np.ones(1, bool))
