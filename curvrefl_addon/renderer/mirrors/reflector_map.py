# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A baked reflector: the star-shaped radial map that the solvers read, and what is known of its quality."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...scene.arrays import Float32Array, Float64Array
from ...scene.camera.view import View


@dataclass(frozen=True, slots=True)
class Spread:
    """Median, 95th percentile and maximum of a set of errors; zeros of an empty set."""

    median: float = 0.0
    p95: float = 0.0
    max: float = 0.0

    @staticmethod
    def of(values: Float64Array) -> Spread:
        """Of any number of finite values."""
        if values.size == 0:
            return Spread()
        median, p95 = np.percentile(values, [50.0, 95.0])
        return Spread(float(median), float(p95), float(values.max()))


@dataclass(frozen=True, slots=True)
class ReflectorMap:
    """Cube maps of one placed reflector about its star center.

    The *map frame* has the star center at its origin, the instance's rotation and the world's unit (meters), so the
    map stays valid when the object moves or turns without changing its size. Faces are in OpenGL order and layout
    (see `optics.surfaces.cube_map`).
    """

    object_name: str
    resolution: int
    """n, texels along an edge of a face"""
    world_to_map: Float64Array
    """(4, 4) rigid"""
    center_name: str
    """How the star center was found: which candidate of `optics.surfaces.star_center`, or "given\""""
    radial: Float32Array
    """(6, n, n, 4): radius r along the texel's direction in meters, and grad r on the unit sphere (tangential), such
    that r u - grad r points along the interpolated shading normal; filled in over holes"""
    positions: Float32Array
    """(6, n, n, 4): point of the surface in the map frame; w is 1 where the mesh was hit, 0 in a hole"""
    normals: Float32Array
    """(6, n, n, 4): unit shading normal in the map frame, turned outwards; w as in `positions`"""
    r_min: float
    r_max: float
    multiple_hits: float
    """Share of directions, by solid angle, that leave the mesh more than once"""
    holes: float
    """Share of directions, by solid angle, that meet nothing"""
    grazing: float
    """Share of directions, by solid angle, that meet the surface too flatly for its gradient, which is clamped"""
    radius_error: Spread
    """|radius of the map / radius of the mesh - 1| at points spread over the mesh's outside"""
    normal_error_degrees: Spread
    """Angle between the map's normal and the mesh's shading normal at these points"""
    error_points: Float32Array
    """(k, 4): these points on the mesh in the map frame, and the map's radius in their direction"""
    warnings: tuple[str, ...] = ()
    """One sentence each"""

    @property
    def center(self) -> Float64Array:
        """(3,) star center in world space."""
        return -self.world_to_map[:3, :3].T @ self.world_to_map[:3, 3]

    def describe(self) -> list[str]:
        """What a user wants to know of it, a line each."""
        x, y, z = self.center
        radius, angle = self.radius_error, self.normal_error_degrees
        return [
            f"{self.object_name}: star center ({x:.6g}, {y:.6g}, {z:.6g}), {self.center_name}",
            f"radius {self.r_min:.6g} to {self.r_max:.6g} m, {self.resolution} x {self.resolution} x 6 texels",
            f"directions that leave it more than once: {percent(self.multiple_hits)}, never: {percent(self.holes)}",
            f"radius error: median {percent(radius.median)}, 95 of 100 under {percent(radius.p95)}, "
            f"largest {percent(radius.max)}",
            f"normal error in degrees: median {angle.median:.3g}, 95 of 100 under {angle.p95:.3g}, "
            f"largest {angle.max:.3g}",
        ]

    def rows(self) -> list[tuple[str, str]]:
        """The same for a panel: label and value."""
        radius, angle = self.radius_error, self.normal_error_degrees
        return [
            ("Star Center", self.center_name.capitalize()),
            ("Radius", f"{self.r_min:.3g} to {self.r_max:.3g} m"),
            ("Map Size", f"{self.resolution} x {self.resolution} x 6"),
            ("Overhangs", percent(self.multiple_hits)),
            ("Holes", percent(self.holes)),
            ("Radius Error", f"{100.0 * radius.median:.1g}, 95th {100.0 * radius.p95:.1g} %"),
            ("Normal Error", f"{angle.median:.1g}, 95th {angle.p95:.1g}\u00b0"),
        ]


def percent(share: float) -> str:
    """A share as text."""
    return f"{100.0 * share:.3g} %"


def pixel_error(reflector: ReflectorMap, view: View) -> Spread:
    """How far the map's surface lies from the mesh's in the picture, in pixels, where it is in front of the eye."""
    true_points = reflector.error_points[:, :3].astype(np.float64)
    radii = np.linalg.norm(true_points, axis=1)
    map_points = true_points * (reflector.error_points[:, 3] / radii)[:, None]
    map_to_world = np.linalg.inv(reflector.world_to_map)

    def to_world(points: Float64Array) -> Float64Array:
        return points @ map_to_world[:3, :3].T + map_to_world[:3, 3]

    true_world, map_world = to_world(true_points), to_world(map_points)
    in_front = np.ones(len(true_world), bool)
    for points in (true_world, map_world):
        clip = points @ view.world_to_clip[:, :3].T + view.world_to_clip[:, 3]
        in_front &= (np.abs(clip) <= clip[:, 3:4]).all(axis=1)
    offsets = view.project(true_world[in_front]) - view.project(map_world[in_front])
    return Spread.of(np.linalg.norm(offsets, axis=1))
