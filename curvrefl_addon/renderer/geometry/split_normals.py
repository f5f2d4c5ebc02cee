# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the shading normals of a mesh jump at its edges, or turn far within a triangle. Pure numpy."""

from __future__ import annotations

import numpy as np

from ...scene.arrays import MeshArrays
from .mesh_inside import places

SLIVER_SHARE = 1e-12
"""A triangle with this share of the largest one's area shows nothing"""


def sharpest_split(mesh: MeshArrays) -> float:
    """Largest angle, radians, between a normal that a corner has in some place and the mean of those there.

    Twice the mean's for two normals; corners of triangles without area do not count.
    """
    corners = mesh.positions[mesh.corner_vertex[mesh.triangles]].astype(np.float64)
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.einsum("ij,ij->i", crossed, crossed)
    used = np.unique(mesh.triangles[areas > SLIVER_SHARE * areas.max(initial=0.0)])
    if len(used) == 0:
        return 0.0
    place = places(mesh)[mesh.corner_vertex[used]]
    normals = mesh.corner_normals[used].astype(np.float64)
    count = int(place.max()) + 1
    total = np.column_stack([np.bincount(place, normals[:, axis], count) for axis in range(3)])
    mean = total[place]
    lengths = np.maximum(np.linalg.norm(mean, axis=1), 1e-30)
    # By the sine, which small angles keep: an arc cosine would round them off.
    sines = np.linalg.norm(np.cross(normals, mean), axis=1) / lengths
    cosines = np.einsum("ij,ij->i", normals, mean) / lengths
    return 2.0 * float(np.arctan2(sines, cosines).max())


def sharpest_bend(mesh: MeshArrays) -> float:
    """Largest angle, radians, between the shading normals of two corners of one triangle."""
    normals = mesh.corner_normals[mesh.triangles].astype(np.float64)
    largest = 0.0
    for k in range(3):
        one, other = normals[:, k], normals[:, (k + 1) % 3]
        sines = np.linalg.norm(np.cross(one, other), axis=1)
        angles = np.arctan2(sines, np.einsum("ij,ij->i", one, other))
        largest = max(largest, float(angles.max(initial=0.0)))
    return largest
