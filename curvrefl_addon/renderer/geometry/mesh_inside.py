# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh is closed, so that it has an inside, and what lies there. Pure numpy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float64Array, MeshArrays
from .solid import has_no_boundary

_DIRECTION = np.array([0.5377, 0.1834, 0.8230])
"""Any, along none of the usual planes"""


CELLS = 1 << 20
"""Places across a mesh that are told apart"""


def is_closed(mesh: MeshArrays) -> bool:
    """Whether every edge has as many triangles on one side as on the other; vertices at one place are one."""
    if len(mesh.triangles) == 0:
        return False
    return has_no_boundary(places(mesh)[mesh.corner_vertex[mesh.triangles]].astype(np.int32))


def places(mesh: MeshArrays) -> NDArray[np.int64]:
    """(vertices,) numbers of the places where the vertices are: those at one place have the same."""
    low, size = mesh.positions.min(axis=0), float(np.ptp(mesh.positions, axis=0).max())
    cells = np.rint((mesh.positions - low) * (CELLS / max(size, 1e-30))).astype(np.int64)
    return np.unique((cells[:, 0] * (CELLS + 1) + cells[:, 1]) * (CELLS + 1) + cells[:, 2], return_inverse=True)[1]


def holds_point(mesh: MeshArrays, point: Float64Array) -> bool:
    """Whether a point (3,), object space, is inside of a closed mesh: a ray leaves it once more than it enters."""
    corners = mesh.positions[mesh.corner_vertex[mesh.triangles]].astype(np.float64) - point
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    # Volumes with the ray say on which side of it each edge passes.
    sides = [np.cross(p, q) @ _DIRECTION for p, q in ((a, b), (b, c), (c, a))]
    outward = np.all([side > 0.0 for side in sides], axis=0)
    inward = np.all([side < 0.0 for side in sides], axis=0)
    ahead = np.einsum("ij,ij->i", a, np.cross(b - a, c - a)) * (sides[0] + sides[1] + sides[2]) > 0.0
    return int((outward & ahead).sum()) != int((inward & ahead).sum())
