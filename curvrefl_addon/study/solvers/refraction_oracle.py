# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All points of a star-shaped surface of glass at which an eye sees a vertex beyond it, in float64.

The search of the oracle for reflection points, with Snell's law: the optical path |E-P| + index |P-V| is stationary,
the eye sees P from its side and the vertex is beyond the tangent plane there. Grid nodes are compared by how far the
tangential parts of both legs are from canceling. One surface alone: what else of it the way beyond P meets bends
nothing.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...optics.fermat import SurfaceSample, path_gradient
from ...optics.snell import is_refraction_side
from ...optics.solvers.pierce import pierce
from ...optics.surfaces.radial_surfaces import Float64Array, RadialSurface, unit
from .oracle import FACING, LARGEST_ERROR, Oracle, to_eye_length


class RefractionOracle(Oracle):
    """The surface, and its samples on the grid of directions."""

    def __init__(self, surface: RadialSurface, index: float, resolution: int = 16, side: float = 1.0) -> None:
        """`index` beyond the surface over that on the eye's side; `side` -1 for an eye inside."""
        super().__init__(surface, resolution, side)
        self.index = index

    def _may_show(self, vertex_cosine: Float64Array, eye_cosine: Float64Array) -> NDArray[np.bool_]:
        return (vertex_cosine < -FACING) & (eye_cosine > FACING)

    def _mismatch(self, vertex_cosine: Float64Array, eye_cosine: Float64Array, between: Float64Array) -> Float64Array:
        """Square of the tangential part of the half vector, over what it can be for the smaller index."""
        index = self.index
        square = 1.0 + index**2 + 2.0 * index * between - (eye_cosine + index * vertex_cosine) ** 2
        return LARGEST_ERROR * np.maximum(square, 0.0) / (1.0 + min(index, 1.0)) ** 2

    def _gradient(self, eyes: Float64Array, vertices: Float64Array, u: Float64Array, at: SurfaceSample) -> Float64Array:
        return path_gradient(eyes, vertices, u, at, self.index)

    def _lengths(self, eyes: Float64Array, vertices: Float64Array, points: Float64Array) -> Float64Array:
        return self.index * np.linalg.norm(vertices - points, axis=1) + to_eye_length(eyes, points)

    def _is_reflection(self, eyes: Float64Array, vertices: Float64Array, at: SurfaceSample) -> NDArray[np.bool_]:
        return is_refraction_side(eyes, vertices, at, self.side)

    def _is_visible(self, points: Float64Array, eyes: Float64Array, vertices: Float64Array) -> NDArray[np.bool_]:
        return self.is_free(points, eyes)

    def _between(self, eyes: Float64Array, vertices: Float64Array) -> list[Float64Array]:
        """Where the straight way enters, for an index near 1, and next to either end, for ends in contact."""
        if len(vertices) == 0:
            return []
        starts = [unit(vertices + 1e-9), unit(eyes[:, :3] + 1e-9), self.side * unit(eyes[:, :3] + 1e-9)]
        if len(np.unique(eyes, axis=0)) == 1:
            enters, point = pierce(self.surface, eyes[0], vertices)
            starts.append(np.where(enters[:, None], unit(point), starts[0]))
        return starts
