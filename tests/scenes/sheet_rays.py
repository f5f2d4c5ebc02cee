# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Rays of a case's pixels, followed in float64 to what they show."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .sheets import BLACK, LENS, SIZE, Case, Color, Float64Array, Sheet


@dataclass(frozen=True, slots=True)
class Seen:
    """What `trace` found at a pixel's center."""

    color: Color
    shows: str
    in_mirror: bool


def pixel_ray(case: Case, column: float, row: float) -> tuple[Float64Array, Float64Array]:
    """(origin, unit direction) of the ray through the center of a pixel; the camera looks along +Y, Z is up."""
    x = (column + 0.5) / SIZE - 0.5
    z = (row + 0.5) / SIZE - 0.5
    eye = np.asarray(case.eye, float)
    if case.orthographic_width is not None:
        return eye + case.orthographic_width * np.array([x, 0.0, z]), np.array([0.0, 1.0, 0.0])
    direction = np.array([36.0 / LENS * x, 1.0, 36.0 / LENS * z])
    return eye, direction / np.linalg.norm(direction)


def hit_mirror(case: Case, origin: Float64Array, direction: Float64Array) -> float:
    """Distance to the mirror along a ray from outside, inf when it misses; marched in small steps, then bisected."""
    reach = 1.0 + (case.lobe.height if case.lobe else 0.0)
    middle = -origin @ direction
    half2 = reach**2 - (origin @ origin - middle**2)
    if half2 <= 0.0 or middle + np.sqrt(half2) <= 0.0:
        return np.inf
    steps = np.linspace(max(0.0, middle - np.sqrt(half2)), middle + np.sqrt(half2), 4000)
    inside = mirror_level(case, origin + steps[:, None] * direction) < 0.0
    if not inside.any():
        return np.inf
    first = int(np.argmax(inside))
    if first == 0:
        return float(steps[0])
    near, far = steps[first - 1], steps[first]
    for _ in range(60):
        half = 0.5 * (near + far)
        if mirror_level(case, (origin + half * direction)[None])[0] < 0.0:
            far = half
        else:
            near = half
    return float(near)


def mirror_level(case: Case, points: Float64Array) -> Float64Array:
    """(n,) distance from the origin minus the mirror's in that direction."""
    distance = np.linalg.norm(points, axis=1)
    return distance - case.radius(points / distance[:, None])


def mirror_normal(case: Case, point: Float64Array) -> Float64Array:
    """(3,) unit normal of the mirror at a point of it."""
    step = 1e-5 * np.eye(3)
    gradient = mirror_level(case, point + step) - mirror_level(case, point - step)
    return gradient / np.linalg.norm(gradient)


def hit_sheet(sheet: Sheet, origin: Float64Array, direction: Float64Array) -> float:
    """Distance to a sheet along a ray, inf when it misses."""
    a, b, c = sheet.corners[:3]
    normal = np.cross(b - a, c - a)
    slope = float(normal @ direction)
    if slope == 0.0:
        return np.inf
    distance = float(normal @ (a - origin)) / slope
    point = origin + distance * direction
    edges = np.roll(sheet.corners, -1, axis=0) - sheet.corners
    sides = np.cross(edges, point - sheet.corners) @ normal
    return distance if distance > 1e-6 and (sides >= 0.0).all() else np.inf


def mirror_ray(case: Case, column: float, row: float) -> tuple[Float64Array, Float64Array]:
    """(origin, unit direction) of the ray that a pixel's ray becomes at the mirror."""
    origin, direction = pixel_ray(case, column, row)
    point = origin + hit_mirror(case, origin, direction) * direction
    if not np.isfinite(point).all():
        raise ValueError(f"Pixel ({column}, {row}) does not see the mirror.")
    normal = mirror_normal(case, point)
    return point, direction - 2.0 * (direction @ normal) * normal


def trace(case: Case, column: float, row: float) -> Seen:
    """What a pixel's center shows, one reflection deep. Raises ValueError where the mirror would reflect itself."""
    origin, direction = pixel_ray(case, column, row)
    to_mirror = hit_mirror(case, origin, direction)
    sheet, distance = _first(tuple(s for s in case.sheets if s.visible_camera), origin, direction)
    if sheet is not None and distance < to_mirror:
        color = BLACK if sheet.holdout else _radiance(case, sheet, origin + distance * direction)
        return Seen(color, sheet.name, False)
    if not np.isfinite(to_mirror):
        return Seen(case.world, "", False)
    point, way = mirror_ray(case, column, row)
    if np.isfinite(hit_mirror(case, point + 1e-3 * mirror_normal(case, point), way)):
        raise ValueError(f"Pixel ({column}, {row}) shows the mirror in the mirror.")
    sheet, distance = _first(tuple(s for s in case.sheets if s.visible_glossy), point, way)
    if sheet is None:
        return Seen(case.world, "", True)
    return Seen(_radiance(case, sheet, point + distance * way), sheet.name, True)


def _first(sheets: tuple[Sheet, ...], origin: Float64Array, direction: Float64Array) -> tuple[Sheet | None, float]:
    found, nearest = None, np.inf
    for sheet in sheets:
        distance = hit_sheet(sheet, origin, direction)
        if distance < nearest:
            found, nearest = sheet, distance
    return found, nearest


def _radiance(case: Case, sheet: Sheet, point: Float64Array) -> Color:
    """A diffuse sheet sends on reflectance / pi of the sun's irradiance, nothing in shadow. The world must be black."""
    if not sheet.diffuse:
        return sheet.color
    assert case.sun_toward is not None
    toward = np.asarray(case.sun_toward) / np.linalg.norm(case.sun_toward)
    normal = np.cross(sheet.corners[1] - sheet.corners[0], sheet.corners[2] - sheet.corners[0])
    normal /= np.linalg.norm(normal)
    start = point + 1e-4 * toward
    blocked = np.isfinite(hit_mirror(case, start, toward)) or _first(case.sheets, start, toward)[0] is not None
    value = 0.0 if blocked else case.sun_strength * abs(float(normal @ toward)) / np.pi
    return (sheet.color[0] * value, sheet.color[1] * value, sheet.color[2] * value)
