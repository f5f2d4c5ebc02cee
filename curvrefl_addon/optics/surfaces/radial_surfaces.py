# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Star-shaped surfaces P(u) = r(u) u about the origin, known in closed form.

A surface is a radius and its gradient on the unit sphere, the two things that Roger & Holzschuch 2006
(section 3.3.1) keep in a texture. The gradient is a 3D vector tangent to the sphere at u: moving u by a small
tangent step t changes r by grad . t.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

type Float64Array = NDArray[np.float64]


class RadialSurface(Protocol):
    """Anything that gives r and grad r for unit directions."""

    @property
    def bound(self) -> float:
        """No r is larger."""
        ...

    def radius(self, u: Float64Array) -> tuple[Float64Array, Float64Array]:
        """Radius (n,) and its tangential gradient (n, 3) for unit directions u (n, 3)."""
        ...


def tangential(vectors: Float64Array, u: Float64Array) -> Float64Array:
    """Part of `vectors` (n, 3) perpendicular to the unit vectors u (n, 3)."""
    return vectors - np.einsum("ij,ij->i", vectors, u)[:, None] * u


def unit(vectors: Float64Array) -> Float64Array:
    """Vectors (..., 3) scaled to length 1; a zero vector stays zero."""
    # numpy's norm is slow on rows of three.
    lengths = np.sqrt(np.einsum("...i,...i->...", vectors, vectors))[..., None]
    return vectors / np.where(lengths > 0.0, lengths, 1.0)


@dataclass(frozen=True)
class Ellipsoid:
    """Half axes a, b, c along x, y, z; a sphere when all are equal."""

    a: float = 1.0
    b: float = 1.0
    c: float = 1.0

    @property
    def bound(self) -> float:
        return max(self.a, self.b, self.c)

    def radius(self, u: Float64Array) -> tuple[Float64Array, Float64Array]:
        inverse_squares = np.array([self.a, self.b, self.c]) ** -2.0
        r = (u**2 @ inverse_squares) ** -0.5
        # r = q^-1/2 with q = sum u_i^2 / a_i^2, so dr = -r^3 sum u_i du_i / a_i^2.
        return r, tangential(-(r[:, None] ** 3) * u * inverse_squares, u)


@dataclass(frozen=True)
class Bumpy:
    """r = scale (1 + amplitude sum_k sin(f_k . u + p_k) / n) with n fixed wave vectors."""

    amplitude: float = 0.1
    scale: float = 1.0

    _WAVES = np.array(
        [[3.0, 0.5, -1.0], [-0.7, 2.8, 0.9], [1.1, -0.4, 3.2], [2.1, 2.2, 0.3], [-1.9, 0.8, 2.4], [0.6, -2.6, 1.7]]
    )
    _PHASES = np.array([0.3, 1.1, 2.0, 2.9, 4.1, 5.2])

    @property
    def bound(self) -> float:
        return self.scale * (1.0 + self.amplitude)

    def radius(self, u: Float64Array) -> tuple[Float64Array, Float64Array]:
        phases = u @ self._WAVES.T + self._PHASES
        weight = self.scale * self.amplitude / len(self._PHASES)
        r = self.scale + weight * np.sin(phases).sum(axis=1)
        return r, tangential(weight * np.cos(phases) @ self._WAVES, u)
