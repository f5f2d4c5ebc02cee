# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One ray and its reflection: the forward way from a pixel to what it shows, and back. float64."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .surfaces.radial_surfaces import Float64Array


@dataclass(frozen=True, slots=True)
class ReflectedRay:
    """A line of sight at the mirror. World space, meters."""

    point: Float64Array
    """(3,) reflection point P"""
    normal: Float64Array
    """(3,) unit, on the side that the ray comes from"""
    direction: Float64Array
    """(3,) unit, away from P"""
    incidence: float
    """Angle between the incoming ray and the normal, radians"""

    def at(self, distance: float) -> Float64Array:
        """(3,) place on the reflected ray: a point there is seen at P."""
        return self.point + distance * self.direction


def reflect_ray(incoming: Float64Array, point: Float64Array, normal: Float64Array) -> ReflectedRay:
    """Reflect the line of sight along `incoming` (3,) at `point` with the shading normal `normal`, of any length.

    Raises ValueError for vectors without direction.
    """
    lengths = np.linalg.norm(incoming), np.linalg.norm(normal)
    if not all(np.isfinite(length) and length > 0.0 for length in lengths):
        raise ValueError("a ray and a normal need a direction")
    ray, outward = incoming / lengths[0], normal / lengths[1]
    if ray @ outward > 0.0:
        outward = -outward
    cosine = min(float(-ray @ outward), 1.0)
    return ReflectedRay(np.array(point, np.float64), outward, ray + 2.0 * cosine * outward, float(np.arccos(cosine)))
