# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Places on triangles by weights of their corners."""

from __future__ import annotations

import numpy as np

from .curvature import Float64Array


def barycentric(points: Float64Array, corners: Float64Array) -> Float64Array:
    """(n, 3) weights of triangles' corners (n, 3, 3) at the places nearest to points (n, 3) in their planes."""
    a, b, c = np.moveaxis(corners, 1, 0)
    normal = np.cross(b - a, c - a)
    squared = np.maximum(np.einsum("ij,ij->i", normal, normal), 1e-300)
    first = np.einsum("ij,ij->i", np.cross(c - b, points - b), normal) / squared
    second = np.einsum("ij,ij->i", np.cross(a - c, points - c), normal) / squared
    return np.column_stack([first, second, 1.0 - first - second])
