# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflectors in closed form to try methods on: round, flat, bent both ways, hollow and pointed.

Each is a radius over the unit sphere of directions (see `radial_surfaces`), about as large as the unit sphere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, Float64Array, RadialSurface, tangential
from .oracle import Oracle
from .refraction_oracle import RefractionOracle

Z = np.array([0.0, 0.0, 1.0])
NEWTON_STEPS = 12
ON_RIM = 1e-9
"""What rounding leaves of a direction to the rim itself, which is on the mirror"""
NODES, FINE_NODES = 16, 64
"""Of the oracle along an edge of a face: for mirrors that show a point once, and for those that may show it more often.
With 24 it missed a twelfth of the images in the torus section's caustics."""
GLASS_NODES = 32
"""The same for glass, which shows a point up to three times near a caustic"""
SETTLED = 1e-15
"""Share of a radius that a Newton step no longer changes"""


@dataclass(frozen=True)
class Revolved:
    """r = sum_k c_k cos^k(angle to the z axis): bodies of revolution such as a kettle's."""

    coefficients: tuple[float, ...]

    @property
    def bound(self) -> float:
        return float(np.polynomial.polynomial.polyval(np.linspace(-1.0, 1.0, 2001), self.coefficients).max()) * 1.0001

    def radius(self, u: Float64Array) -> tuple[Float64Array, Float64Array]:
        z = u[:, 2]
        radius = np.asarray(np.polynomial.polynomial.polyval(z, self.coefficients), np.float64)
        derivative = np.polynomial.polynomial.polyder(np.array(self.coefficients))
        slope = np.asarray(np.polynomial.polynomial.polyval(z, derivative), np.float64)
        return radius, slope[:, None] * tangential(np.tile(Z, (len(u), 1)), u)


@dataclass(frozen=True)
class Saddle:
    """r = 1 + a (x^2 - y^2): for a > 0.5 it bends outwards along x and inwards along y where it meets the z axis."""

    a: float = 0.7

    @property
    def bound(self) -> float:
        return 1.0 + abs(self.a)

    def radius(self, u: Float64Array) -> tuple[Float64Array, Float64Array]:
        slope = 2.0 * self.a * u * np.array([1.0, -1.0, 0.0])
        return 1.0 + self.a * (u[:, 0] ** 2 - u[:, 1] ** 2), tangential(slope, u)


@dataclass(frozen=True)
class TorusSection:
    """A piece of a ring, about a point in the middle of its tube; a ball cuts it off smoothly at both ends.

    The ring's center is at (-ring, 0, 0), its axis along z.
    """

    ring: float = 4.0
    tube: float = 1.0
    ball: float = 1.8
    sharpness: int = 16

    @property
    def bound(self) -> float:
        return self.ball

    def radius(self, u: Float64Array) -> tuple[Float64Array, Float64Array]:
        """The first exit from the tube, by bracketing and Newton; 1 / r^n = 1 / tube^n + 1 / ball^n."""
        far = 2.0 * self.ball
        marks = np.linspace(0.0, far, 17)[1:, None]
        across = np.hypot(marks * u[:, 0] + self.ring, marks * u[:, 1]) - self.ring
        outside = across**2 + (marks * u[:, 2]) ** 2 > self.tube**2
        leaves = outside.any(axis=0)
        high = np.where(leaves, marks[outside.argmax(axis=0), 0], far)
        # Along the tube the ball ends it long before.
        low = np.where(leaves, high - marks[0, 0], far)
        exit_radius = 0.5 * (low + high)
        for _ in range(NEWTON_STEPS):
            height, slope = self._height(exit_radius[:, None] * u)
            high, low = np.where(height > 0.0, exit_radius, high), np.where(height > 0.0, low, exit_radius)
            along = np.einsum("ij,ij->i", slope, u)
            newton = exit_radius - height / np.where(along > 1e-9, along, 1e-9)
            # Past the bracket Newton is wrong: halve it.
            newton = np.where((newton >= low) & (newton <= high), newton, 0.5 * (low + high))
            settled = (np.abs(newton - exit_radius) <= SETTLED * exit_radius).all()
            exit_radius = newton
            if settled:
                break
        _, slope = self._height(exit_radius[:, None] * u)
        along = np.einsum("ij,ij->i", slope, u)
        # F(r u) = 0: dr (slope . u) + r slope . du = 0.
        gradient = -tangential(slope, u) * (exit_radius / np.where(np.abs(along) < 1e-9, 1e-9, along))[:, None]
        n = self.sharpness
        radius = (exit_radius**-n + self.ball**-n) ** (-1.0 / n)
        return radius, gradient * ((radius / exit_radius) ** (n + 1))[:, None]

    def _height(self, p: Float64Array) -> tuple[Float64Array, Float64Array]:
        """(distance to the ring's middle line)^2 - tube^2, and its gradient."""
        from_axis = p[:, :2] + np.array([self.ring, 0.0])
        distance = np.linalg.norm(from_axis, axis=1)
        off = distance - self.ring
        slope = np.empty(p.shape)
        slope[:, :2] = 2.0 * (off / np.maximum(distance, 1e-12))[:, None] * from_axis
        slope[:, 2] = 2.0 * p[:, 2]
        return off**2 + p[:, 2] ** 2 - self.tube**2, slope


@dataclass(frozen=True)
class Tip:
    """The unit ball with a cone that touches it all around, and a blunt apex on the z axis."""

    half_angle: float = 0.6
    bluntness: float = 0.15

    @property
    def bound(self) -> float:
        return 1.0001 / (self.bluntness * float(np.cos(self.half_angle)) + float(np.sin(self.half_angle)))

    def radius(self, u: Float64Array) -> tuple[Float64Array, Float64Array]:
        """1 / r = w cos a + z sin a on the cone, where w is the sine of the angle to the axis, rounded at the apex."""
        z = u[:, 2]
        squared, rim = 1.0 - z**2, np.cos(self.half_angle) ** 2
        flat = self.bluntness**2 * (1.0 - squared / rim)
        sine = np.sqrt(np.maximum(squared + flat * (1.0 - squared / rim), 1e-30))
        inverse = sine * np.cos(self.half_angle) + z * np.sin(self.half_angle)
        by_z = -z * (1.0 - 2.0 * flat / rim) / sine * np.cos(self.half_angle) + np.sin(self.half_angle)
        cone = z > np.sin(self.half_angle)
        radius = np.where(cone, 1.0 / np.where(cone, inverse, 1.0), 1.0)
        slope = np.where(cone, -(radius**2) * by_z, 0.0)
        return radius, slope[:, None] * tangential(np.tile(Z, (len(u), 1)), u)


@dataclass(frozen=True)
class Study:
    """A reflector, and from where to look at it."""

    surface: RadialSurface
    eye: tuple[float, float, float]
    """Relative to the star center"""
    side: float = 1.0
    """-1: it is hollow, and reflects on its inner side"""
    mixed: bool = False
    """It bends both ways somewhere: a vertex may have several images"""
    rim: float = 1.0
    """No mirror in directions whose z is greater: it is open there"""
    index: float = 0.0
    """Of glass: index of refraction beyond the surface over that on the eye's side, which is the inside where `side` is
    -1; 0 for a mirror"""

    @property
    def refracts(self) -> bool:
        """It is of glass."""
        return self.index > 0.0

    @property
    def is_convex(self) -> bool:
        """Closed and convex as seen from outside."""
        return self.side > 0.0 and not self.mixed and self.rim >= 1.0

    def cover(self, u: Float64Array) -> NDArray[np.bool_]:
        """(n,) which unit directions (n, 3) meet the mirror."""
        return u[:, 2] <= self.rim + ON_RIM

    def oracle(self) -> Oracle:
        """The oracle of this reflector."""
        if self.refracts:
            return RefractionOracle(self.surface, self.index, GLASS_NODES, self.side)
        several = self.mixed or self.side < 0.0
        nodes = FINE_NODES if several else NODES
        return Oracle(self.surface, nodes, self.side, self.cover if self.rim < 1.0 else None)


STUDIES: dict[str, Study] = {
    "sphere": Study(Ellipsoid(), (2.3, -2.9, 1.8)),
    "ellipsoid": Study(Ellipsoid(1.0, 0.5, 0.25), (2.3, -2.9, 1.8)),
    "bumpy": Study(Bumpy(0.15), (2.3, -2.9, 1.8), mixed=True),
    "strongly bumpy": Study(Bumpy(0.6), (2.3, -2.9, 1.8), mixed=True),
    "kettle": Study(Revolved((0.85, -0.1, -0.2, 0.0, 0.0, 0.0, 0.0, 0.25, 0.25)), (2.3, -2.9, 1.2), mixed=True),
    "bowl": Study(Ellipsoid(1.0, 1.0, 0.8), (0.4, -0.3, 2.6), side=-1.0, rim=0.0),
    "saddle": Study(Saddle(), (0.6, -0.5, 3.6), mixed=True),
    "torus section": Study(TorusSection(), (-2.6, -0.6, 1.6), mixed=True),
    "tip": Study(Tip(), (2.0, -2.6, 2.2), mixed=True),
}

GLASS_STUDIES: dict[str, Study] = {
    "glass sphere": Study(Ellipsoid(), (2.3, -2.9, 1.8), index=1.5),
    "glass ellipsoid": Study(Ellipsoid(1.0, 0.5, 0.25), (2.3, -2.9, 1.8), index=1.5),
    "bumpy glass": Study(Bumpy(0.15), (2.3, -2.9, 1.8), mixed=True, index=1.5),
    "diamond sphere": Study(Ellipsoid(), (2.3, -2.9, 1.8), index=2.4),
    "bubble": Study(Ellipsoid(), (2.3, -2.9, 1.8), index=1.0 / 1.33),
    "glass from inside": Study(Ellipsoid(1.0, 0.8, 0.6), (0.2, -0.25, 0.15), side=-1.0, index=1.0 / 1.5),
}
"""Surfaces of glass, for methods that refract"""

ALL_STUDIES = STUDIES | GLASS_STUDIES
