# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Normal and curvature of a surface at a vertex from vertices around it alone: a polynomial is laid through them.

Unlike normals averaged over faces this holds at borders, where all neighbors are on one side.

F. Cazals and M. Pouget, "Estimating differential quantities using polynomial fitting of osculating jets", Computer
Aided Geometric Design 22, 2005: a polynomial of degree d over neighbors at distances h has the normal to h^d and the
curvature to h^(d - 1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .curvature import Float64Array, tangent_axes

LEAST_POINTS = {3: 12, 2: 6, 1: 2}
"""Neighbors that a polynomial of each degree wants: more than it has coefficients, but for the plane"""
WORST_CONDITION = 1e4
"""Of the fit: neighbors that hardly spread over the plane say nothing of it"""
ROUNDS = 2
"""The polynomial's own normal is the axis of the next one"""


@dataclass(frozen=True, slots=True)
class Jet:
    """A surface at a point."""

    normal: Float64Array
    """(3,) unit"""
    tensor: Float64Array
    """(6,) curvature tensor (see `curvature`); NaN where there are too few points for one"""


def fit_jet(point: Float64Array, around: Float64Array, normal: Float64Array) -> Jet | None:
    """At `point` (3,) of a surface that goes on through points (n, 3); `normal` (3,) is about its unit normal.

    Of the highest degree up to 3 that the points are enough for; None where not even a plane goes through them.
    """
    for degree, least in LEAST_POINTS.items():
        if len(around) >= least:
            found = _fitted(point, around, normal, degree)
            if found is not None:
                return found
    return None


def _fitted(point: Float64Array, around: Float64Array, normal: Float64Array, degree: int) -> Jet | None:
    offsets = around - point
    scale = float(np.sqrt((offsets**2).sum(axis=1).max()))
    if not scale > 0.0:
        return None
    offsets = offsets / scale
    tensor = np.full(6, np.nan)
    for _ in range(ROUNDS):
        first, second = (axis[0] for axis in tangent_axes(normal[None]))
        x, y, z = offsets @ first, offsets @ second, offsets @ normal
        powers = [x, y]
        if degree >= 2:
            powers += [x * x / 2.0, x * y, y * y / 2.0]
        if degree == 3:
            powers += [x**3, x * x * y, x * y * y, y**3]
        # (Near points count more: the polynomial is only that of the surface at the point.)
        weight = 1.0 / (0.1 + np.sqrt(x * x + y * y))
        columns = np.column_stack(powers) * weight[:, None]
        lengths = np.linalg.norm(columns, axis=0).clip(1e-30)
        solution, _, _, singular = np.linalg.lstsq(columns / lengths, z * weight, rcond=None)
        if not singular[-1] * WORST_CONDITION > singular[0]:
            return None
        values = solution / lengths
        slope_x, slope_y = values[:2]
        if degree >= 2:
            tensor = _tensor(slope_x, slope_y, values[2:5], np.array([first, second, normal])) / scale
        turned = normal - slope_x * first - slope_y * second
        normal = turned / np.linalg.norm(turned)
    return Jet(normal, tensor)


def _tensor(slope_x: float, slope_y: float, second: Float64Array, axes: Float64Array) -> Float64Array:
    """(6,) of z = f(x, y) with its slopes and second derivatives (xx, xy, yy), in space by the rows of `axes` (3, 3).

    With P_i the tangents and II_ij = -f_ij / W the operator is S = sum of (g^-1 II g^-1)_ij P_i P_j.
    """
    tangents = np.array([[1.0, 0.0, slope_x], [0.0, 1.0, slope_y]])
    inverse = np.linalg.inv(tangents @ tangents.T)
    xx, xy, yy = second
    bending = -np.array([[xx, xy], [xy, yy]]) / np.sqrt(1.0 + slope_x**2 + slope_y**2)
    s = axes.T @ tangents.T @ inverse @ bending @ inverse @ tangents @ axes
    return np.array([s[0, 0], s[1, 1], s[2, 2], s[0, 1], s[0, 2], s[1, 2]])
