# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh bounds a solid, so that from outside nobody sees the back of a triangle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import MeshArrays


def solid_side(mesh: MeshArrays) -> int:
    """1 where all triangles are counter-clockwise from outside of a solid, -1 where all are clockwise, 0: not known.

    Sufficient, not necessary: the surface has no boundary, and all its triangles turn the same side to the vertices'
    mean. The tetrahedra between that point and the triangles then all count with the same sign, so the surface winds at
    least zero times around any point, and a ray from outside meets a front face first.
    """
    triangles = mesh.corner_vertex[mesh.triangles]
    if len(triangles) == 0 or not has_no_boundary(triangles):
        return 0
    points = mesh.positions.astype(np.float64)
    points -= points[np.unique(triangles)].mean(axis=0)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c))
    if (volumes >= 0.0).all() and (volumes > 0.0).any():
        return 1
    return -1 if (volumes <= 0.0).all() and (volumes < 0.0).any() else 0


def has_no_boundary(triangles: NDArray[np.int32]) -> bool:
    """Whether triangles (n, 3) pass every edge as often one way as the other.

    Compares sums of hashes of all edges and of all reversed edges, modulo 2^64: unequal sets have equal sums by a
    chance of about 2^-64. Sorting the edges would take several times as long.
    """
    tails = triangles.astype(np.uint64)
    heads = np.roll(tails, -1, axis=1)
    shift = np.uint64(32)
    return bool(_hashes((tails << shift) | heads).sum() == _hashes((heads << shift) | tails).sum())


def _hashes(keys: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """The finalizer of splitmix64 (Steele, Lea and Flood 2014)."""
    keys = (keys ^ (keys >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    keys = (keys ^ (keys >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return keys ^ (keys >> np.uint64(31))
