# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh is convex: then no part of it can hide another, and nothing needs to check."""

from __future__ import annotations

import numpy as np

from ...scene.arrays import MeshArrays

DENT = 1e-3
"""Relative to the size: what stands out less far over a tangent plane hides nothing that can be seen"""
TANGENT_PLANES = 256


def is_convex(mesh: MeshArrays) -> bool:
    """Whether all vertices lie below the tangent planes (place and shading normal) of evenly chosen ones.

    Edges would be the exact test, but the diagonals of a fine mesh's bent quads fold inwards on convex shapes too. In
    object space: no placement makes a convex shape another.
    """
    used = np.unique(mesh.triangles)
    if len(used) == 0:
        return True
    chosen = used[:: max(len(used) // TANGENT_PLANES, 1)]
    points = mesh.positions[np.unique(mesh.corner_vertex[used])]
    size = float(np.ptp(points, axis=0).max())
    normals = mesh.corner_normals[chosen]
    heights = np.einsum("ij,ij->i", mesh.positions[mesh.corner_vertex[chosen]], normals)
    highest = (points @ normals.T).max(axis=0)
    return bool((highest - heights <= DENT * size).all())
