# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A line of sight over mirrors, unfolded: places on it by their distance along it. float64, no bpy."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...optics.ray import ReflectedRay

STOPS_AT = 0.95
"""Of the way to what is seen there: what is placed stays in front of it"""
LEAST_LEFT = 0.5
"""Of that way at least, however large it is"""


@dataclass(frozen=True, slots=True)
class MirrorPath:
    """What the eye sees in a mirror: one ray for each mirror on the way. World space."""

    rays: tuple[ReflectedRay, ...]
    """At least one; each starts where the one before ends"""
    length: float
    """Of the last ray, up to what is seen there; endless in the background"""
    seen: str = ""
    """Name of that object, nothing in the background"""
    mirror: str = ""
    """Name of the first mirror"""
    size: float = 1.0
    """Of the first mirror, meters"""

    @property
    def lengths(self) -> list[float]:
        """Of each ray, up to the next mirror or to what is seen."""
        points = [ray.point for ray in self.rays]
        between = [float(np.linalg.norm(b - a)) for a, b in pairwise(points)]
        return [*between, self.length]

    @property
    def reach(self) -> float:
        """From the first mirror to what is seen, along the path."""
        return sum(self.lengths)

    def leg(self, distance: float) -> tuple[int, float]:
        """Number of the ray that a place so far from the first mirror is on, and how far along that ray it is."""
        *others, _last = self.lengths
        for number, length in enumerate(others):
            if distance <= length:
                return number, distance
            distance -= length
        return len(others), distance


def limited(asked: float, way: float, extent: float) -> float:
    """So far along a way, or as far as a thing that reaches `extent` about its middle stays in front of its end."""
    return min(asked, max(STOPS_AT * way - extent, LEAST_LEFT * way))
