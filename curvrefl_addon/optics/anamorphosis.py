# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirror anamorphoses in closed form: where a line of sight gets to by an upright cylinder or cone. float64.

The mirror stands on the floor z = 0 about the axis z. A line of sight meets it at a root of a quadratic equation, is
reflected about the normal there, and ends on the floor or on an upright cylindrical wall around the mirror, the root of
another. Hunt, Nickel & Gigault, "Anamorphic images", American Journal of Physics 68 (2000), section III, have the
cylinder and the cone on a floor; De Comite, "A general procedure for the construction of mirror anamorphoses", Bridges
2010, has the recipe for any mirror.
"""

from __future__ import annotations

import numpy as np

from .surfaces.radial_surfaces import Float64Array, unit

type Turned = tuple[Float64Array, Float64Array]
"""Reflection points (n, 3), and unit directions (n, 3) away from them; NaN where the mirror is missed"""


def off_cylinder(eye: Float64Array, directions: Float64Array, radius: float, height: float = np.inf) -> Turned:
    """Lines of sight from `eye` (3,) along `directions` (n, 3), off the outside of a cylinder, z from 0 to `height`."""
    ways = unit(directions)
    flat, start = ways[:, :2], eye[:2]
    squared = np.einsum("ij,ij->i", flat, flat)
    along = flat @ start
    with np.errstate(invalid="ignore", divide="ignore"):
        distance = (-along - np.sqrt(along**2 - squared * (start @ start - radius**2))) / squared
    points = eye + distance[:, None] * ways
    normals = np.column_stack([points[:, :2] / radius, np.zeros(len(points))])
    is_met = (distance > 0.0) & (points[:, 2] >= 0.0) & (points[:, 2] <= height)
    return _turned(points, ways, normals, is_met)


def off_cone(eye: Float64Array, directions: Float64Array, radius: float, height: float) -> Turned:
    """The same off the outside of a cone whose base of this radius is at z = 0 and whose tip is at `height`."""
    ways = unit(directions)
    # On it x^2 + y^2 = (slope (height - z))^2: with w below the tip, a quadratic form of signature (1, 1, -slope^2).
    slope = radius / height
    form = np.array([1.0, 1.0, -(slope**2)])
    start = np.asarray(eye, np.float64) - [0.0, 0.0, height]
    squared, along, rest = (ways**2) @ form, (ways * form) @ start, float((start * form) @ start)
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.sqrt(along**2 - squared * rest)
        both = np.stack([(-along - root) / squared, (-along + root) / squared])
        flat = np.abs(squared) < 1e-14
        both[:, flat] = (-rest / (2.0 * along))[flat]
    heights = eye[2] + both * ways[:, 2]
    both = np.where((both > 0.0) & (heights >= 0.0) & (heights <= height), both, np.inf)
    distance = both.min(axis=0)
    is_met = np.isfinite(distance)
    points = eye + np.where(is_met, distance, 0.0)[:, None] * ways
    across = np.hypot(points[:, 0], points[:, 1])
    is_met &= across > 0.0
    normals = np.column_stack(
        [points[:, :2] / np.where(across > 0.0, across, 1.0)[:, None], np.full(len(points), slope)]
    )
    return _turned(points, ways, unit(normals), is_met)


def to_floor(turned: Turned) -> Float64Array:
    """(n, 3) where reflected rays meet the floor z = 0; NaN where they do not."""
    points, ways = turned
    with np.errstate(invalid="ignore", divide="ignore"):
        distance = -points[:, 2] / ways[:, 2]
    found = points + distance[:, None] * ways
    found[~(distance >= 0.0)] = np.nan
    return found


def to_wall(turned: Turned, radius: float) -> Float64Array:
    """(n, 3) where they meet an upright cylindrical wall of this radius about the mirror; NaN where they do not."""
    points, ways = turned
    flat, start = ways[:, :2], points[:, :2]
    squared, along = np.einsum("ij,ij->i", flat, flat), np.einsum("ij,ij->i", flat, start)
    with np.errstate(invalid="ignore", divide="ignore"):
        inside = along**2 - squared * (np.einsum("ij,ij->i", start, start) - radius**2)
        distance = (-along + np.sqrt(inside)) / squared
    found = points + distance[:, None] * ways
    found[~(distance >= 0.0)] = np.nan
    return found


def _turned(points: Float64Array, ways: Float64Array, normals: Float64Array, is_met: Float64Array) -> Turned:
    """Reflect unit `ways` about unit `normals`, with NaN where nothing is met."""
    cosines = np.einsum("ij,ij->i", ways, normals)
    is_met = is_met & (cosines < 0.0)
    reflected = ways - 2.0 * cosines[:, None] * normals
    return np.where(is_met[:, None], points, np.nan), np.where(is_met[:, None], reflected, np.nan)
