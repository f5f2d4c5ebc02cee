# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes out of numbers, without Blender: for what is proven, measured and tested."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Float32Array, Float64Array, Int32Array, MeshArrays


def smooth_mesh(
    name: str, positions: Float64Array | Float32Array, normals: Float64Array | Float32Array, triangles: Int32Array
) -> MeshArrays:
    """A mesh whose corners are its vertices: positions and unit normals (n, 3), triangles (m, 3)."""
    return MeshArrays(
        name,
        np.ascontiguousarray(positions, np.float32),
        np.arange(len(positions), dtype=np.int32),
        np.ascontiguousarray(normals, np.float32),
        None,
        np.ascontiguousarray(triangles, np.int32),
        np.zeros(len(triangles), np.int32),
    )


def quad_mesh(name: str, corners: Float64Array, normal: Sequence[float] | Float64Array) -> MeshArrays:
    """Two triangles: `corners` (4, 3) counter-clockwise as seen from where the unit `normal` points."""
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    return smooth_mesh(name, corners, np.tile(np.asarray(normal, np.float64), (4, 1)), triangles)
