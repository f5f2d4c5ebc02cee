# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustics of a sun in closed form, in double precision: what a parallel beam lays on a plane off a sphere, a
paraboloid or a ring. Light is conserved along a beam, so that irradiance goes as the area of a piece of the beam over
the area that it lands on; where a plane is reached more than once the pieces add up (Nye, "Natural Focusing and Fine
Structure of Light", 1999, chapter 2).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

type Float64Array = NDArray[np.float64]

BISECTIONS = 60
SCANNED = 8192
"""Places along a profile between which a landing radius is passed at most once"""


@dataclass(frozen=True, slots=True)
class RoundMirror:
    """A mirror that is round about the z axis, under a beam that comes down along it."""

    kind: str
    """'OUTSIDE' of a sphere, 'INSIDE' of its lower half, or 'PARABOLOID' with its vertex in the origin, open above"""
    radius: float
    """Of the sphere in meters; of a paraboloid twice its focal length: the radius of curvature at its vertex"""
    rim: float
    """Distance from the axis to which it reaches, in meters"""

    def landing(self, distance: Float64Array, plane: float) -> tuple[Float64Array, Float64Array, Float64Array]:
        """Of rays that come down at these distances from the axis (n,): distance from it at which they meet the plane
        z = `plane`, signed (below 0: beyond the axis), its derivative, and how far they go (below 0: never there)."""
        height, slope, bend = self._profile(distance)
        # The direction (0, -1) mirrored by the normal (-slope, 1) over its length.
        length2 = 1.0 + slope**2
        across, up = -2.0 * slope / length2, 2.0 / length2 - 1.0
        turn = 2.0 * bend / length2
        with np.errstate(divide="ignore", invalid="ignore"):
            way = (plane - height) / up
            place = distance + way * across
            # (across, up) turns by `turn` counter-clockwise with the distance.
            way_change = (-slope + way * turn * -across) / up
            change = 1.0 + way_change * across - way * turn * up
        return place, change, way

    def irradiance(self, radii: Float64Array, plane: float) -> Float64Array:
        """(n,) at these distances from the axis on the plane z = `plane`, under a beam of irradiance 1 straight on."""
        least = 1e-9 * self.rim
        distances = np.linspace(least, self.rim, SCANNED)
        return _summed(np.asarray(radii, np.float64), distances, lambda rho: self._laid(rho, plane))

    def _laid(self, distance: Float64Array, plane: float) -> tuple[Float64Array, Float64Array]:
        place, change, way = self.landing(distance, plane)
        with np.errstate(divide="ignore", invalid="ignore"):
            light = distance / np.abs(place * change)
        return np.where(way > 0.0, np.abs(place), np.nan), np.where(way > 0.0, light, 0.0)

    def _profile(self, rho: Float64Array) -> tuple[Float64Array, Float64Array, Float64Array]:
        """Height, slope and second derivative at distances from the axis."""
        if self.kind == "PARABOLOID":
            curvature = 1.0 / self.radius
            return 0.5 * curvature * rho**2, curvature * rho, np.full_like(rho, curvature)
        # (At the equator the slope has no end.)
        root = np.sqrt(np.maximum(self.radius**2 - rho**2, 1e-24 * self.radius**2))
        sign = 1.0 if self.kind == "OUTSIDE" else -1.0
        return sign * root, -sign * rho / root, -sign * self.radius**2 / root**3


def sphere_caustic(radius: float, angles: Float64Array) -> Float64Array:
    """(n, 2) distances from the axis and heights of the caustic inside a sphere about the origin, under a beam that
    comes down along z, of rays that meet it at these angles (n,) from the axis: a nephroid turned about its axis, whose
    cusp is half the radius below the middle (Holditch 1858)."""
    sine, cosine = np.sin(angles), np.cos(angles)
    return radius * np.column_stack([sine**3, -0.5 * cosine * (1.0 + 2.0 * sine**2)])


def ring_irradiance(points: Float64Array, radius: float, height: float, sun: Float64Array) -> Float64Array:
    """(n,) irradiance that the inner side of a ring sends to places (n, 2) on the floor inside, z = 0, which its
    cylinder about the z axis stands on; `sun`: unit direction (3,) in which light comes down, of irradiance 1 straight
    on.

    All rays keep their slope, so that the floor shows the section's caustic, a nephroid's half, cut off where the
    ring's upper edge lands. A piece of the wall of length L lands spread over L |1 - 2 s / (radius cos a)|, with s how
    far it goes along the floor and a the angle at which it meets the wall.
    """
    points = np.asarray(points, np.float64)
    along = np.asarray(sun[:2], np.float64) / np.hypot(sun[0], sun[1])
    reach = height * np.hypot(sun[0], sun[1]) / -sun[2]
    facing = np.arctan2(along[1], along[0])
    turns = np.linspace(-0.5 * np.pi, 0.5 * np.pi, SCANNED)[1:-1]

    def misses(turn: Float64Array, at: Float64Array) -> tuple[Float64Array, Float64Array, Float64Array]:
        """How far rays off the wall at these turns pass the places by, how far they have gone there, and cos a."""
        wall = facing + turn
        outward = np.stack([np.cos(wall), np.sin(wall)], axis=-1)
        cosine = np.cos(turn)
        way = along - 2.0 * cosine[..., None] * outward
        away = at - radius * outward
        return way[..., 0] * away[..., 1] - way[..., 1] * away[..., 0], (way * away).sum(axis=-1), cosine

    total = np.zeros(len(points))
    for index, point in enumerate(points):
        miss, _, _ = misses(turns, point)
        crossing = np.flatnonzero(miss[1:] * miss[:-1] < 0.0)
        low, high = turns[crossing], turns[crossing + 1]
        sign = np.sign(miss[crossing])
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            is_low = np.sign(misses(middle, point)[0]) == sign
            low, high = np.where(is_low, middle, low), np.where(is_low, high, middle)
        _, gone, cosine = misses(low, point)
        is_there = (gone > 0.0) & (gone <= reach)
        spread = np.abs(1.0 - 2.0 * gone / (radius * cosine))
        total[index] = -sun[2] * float((is_there / np.maximum(spread, 1e-300)).sum())
    return total


def _summed(
    wanted: Float64Array, scanned: Float64Array, laid: Callable[[Float64Array], tuple[Float64Array, Float64Array]]
) -> Float64Array:
    """Sum over all places of a beam that land at each of the `wanted` radii (n,); `laid`: (radius, light) of places."""
    radii, _ = laid(scanned)
    total = np.zeros(len(wanted))
    for index, radius in enumerate(wanted):
        off = radii - radius
        crossing = np.flatnonzero(off[1:] * off[:-1] < 0.0)
        low, high = scanned[crossing], scanned[crossing + 1]
        sign = np.sign(off[crossing])
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            is_low = np.sign(laid(middle)[0] - radius) == sign
            low, high = np.where(is_low, middle, low), np.where(is_low, high, middle)
        total[index] = float(laid(low)[1].sum())
    return total
