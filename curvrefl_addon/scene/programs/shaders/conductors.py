# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Metals by their complex index of refraction, as a color and a tint of their edges.

The tint is that of the F82 model: Kutz, Hasan, Edmondson, "Novel aspects of the Adobe Standard Material" (2021), after
Hoffman, "Fresnel equations considered harmful" (2019).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Float64Array

EDGE = 1.0 / 7.0
"""Cosine of the angle at which the tint counts, about 82 degrees"""
CLOSE = 0.06
"""Of the reflectance, at any angle"""


@dataclass(frozen=True, slots=True)
class FittedConductor:
    """A metal of the F82 model."""

    color: tuple[float, float, float]
    """Reflectance as seen from straight ahead"""
    edge_tint: tuple[float, float, float]
    is_close: bool
    """It reflects nearly what the conductor does, at all angles"""


def fitted_conductor(ior: tuple[float, float, float], extinction: tuple[float, float, float]) -> FittedConductor:
    """Of the real and the imaginary part of the index, per channel; negative ones count as 0."""
    n, k = np.maximum(ior, 0.0), np.maximum(extinction, 0.0)
    head_on, edge = reflectances(n, k, np.array([1.0, EDGE]))
    tint = np.minimum(edge / _schlick(head_on, np.array([EDGE]))[0], 1.0)
    cosines = np.linspace(0.02, 1.0, 50)
    error = np.abs(f82_reflectances(head_on, tint, cosines) - reflectances(n, k, cosines)).max()
    return FittedConductor(_triple(head_on), _triple(tint), bool(error < CLOSE))


def reflectances(n: Float64Array, k: Float64Array, cosines: Float64Array) -> Float64Array:
    """(m, 3) of unpolarized light in vacuum on a conductor (n, k: (3,)) at angles of these cosines (m,)."""
    cosine = cosines[:, None]
    squared = cosine**2
    sine = 1.0 - squared
    difference = n**2 - k**2 - sine
    a2b2 = np.sqrt(difference**2 + 4.0 * n**2 * k**2)
    a = np.sqrt(np.maximum(0.5 * (a2b2 + difference), 0.0))
    across = a2b2 + squared
    senkrecht = (across - 2.0 * cosine * a) / (across + 2.0 * cosine * a)
    along = squared * a2b2 + sine**2
    parallel = senkrecht * (along - 2.0 * cosine * a * sine) / (along + 2.0 * cosine * a * sine)
    result: Float64Array = 0.5 * (senkrecht + parallel)
    return result


def f82_reflectances(color: Float64Array, edge_tint: Float64Array, cosines: Float64Array) -> Float64Array:
    """(m, 3) of the F82 model (color, tint: (3,)) at angles of these cosines (m,)."""
    grazing = (1.0 - cosines[:, None]) ** 6
    at_edge = _schlick(color, np.array([EDGE])) * (1.0 - edge_tint) / (EDGE * (1.0 - EDGE) ** 6)
    result: Float64Array = np.clip(_schlick(color, cosines) - at_edge * cosines[:, None] * grazing, 0.0, 1.0)
    return result


def _schlick(color: Float64Array, cosines: Float64Array) -> Float64Array:
    """(m, 3)"""
    result: Float64Array = color + (1.0 - color) * (1.0 - cosines[:, None]) ** 5
    return result


def _triple(values: Float64Array) -> tuple[float, float, float]:
    r, g, b = values.tolist()
    return r, g, b
