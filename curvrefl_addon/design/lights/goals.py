# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a light belongs so that a picture shows what is asked for. float64, no bpy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import Float64Array
from .paths import MirrorPath

LEAST_TILT = 1e-6
"""Sine of the angle between a normal and the line of sight under which no edge is the nearest"""


@dataclass(frozen=True, slots=True)
class Goal:
    """Of one light. World space."""

    place: Float64Array
    """(3,) of its middle; a sun has only the direction"""
    shines: Float64Array
    """(3,) unit, from the light to the point that it is placed by"""
    distance: float
    """Between both, along the path"""
    mirrors: int = 0
    """On the way between both"""


def reflection(path: MirrorPath, distance: float) -> Goal:
    """So far from the first mirror of the path on which it is seen."""
    number, along = path.leg(distance)
    ray = path.rays[number]
    return Goal(ray.at(along), -ray.direction, distance, 1 + number)


def background(path: MirrorPath) -> Goal:
    """At no distance: what comes from this direction is seen on the path."""
    ray = path.rays[-1]
    return Goal(ray.point, -ray.direction, np.inf, len(path.rays))


def illumination(point: Float64Array, normal: Float64Array, distance: float) -> Goal:
    """So far over a point (3,) along its unit normal (3,): a small light gives a surface most where it is straight
    above it."""
    return Goal(point + distance * normal, -normal, distance)


def outward(sight: Float64Array, normal: Float64Array) -> Float64Array:
    """(3,) unit, across the unit line of sight `sight` (3,): the normal of the edge that is nearest by the normal (3,).

    Raises ValueError where the surface faces the eye.
    """
    across = normal - (normal @ sight) * sight
    if not np.linalg.norm(across) > LEAST_TILT * np.linalg.norm(normal):
        raise ValueError("a surface that faces the eye has no edge that is nearest")
    return unit(across)


def rim_direction(sight: Float64Array, normal: Float64Array, width: float) -> Float64Array:
    """(3,) unit, from an edge to the light that grazes it.

    On an edge the normal is square to the line of sight, which it reflects straight on: a light right behind shows
    there. One that stands out by the angle `width` (radians) lights normals up to so far from the edge's, most of all
    the edge itself: the cosine at an angle t from it is sin(width - t). Metal mirrors it at t = width / 2.
    """
    return np.cos(width) * sight + np.sin(width) * outward(sight, normal)


def rim(edge: Float64Array, sight: Float64Array, normal: Float64Array, width: float, distance: float) -> Goal:
    """So far behind the point (3,) on the edge."""
    direction = rim_direction(sight, normal, width)
    return Goal(edge + distance * direction, -direction, distance)


def upright(axis: Float64Array) -> Float64Array:
    """(3, 3) rotation whose last column is the unit vector `axis` (3,) and whose second one points up as far as it
    can; north where the axis is vertical."""
    up = np.array([0.0, 0.0, 1.0]) if np.hypot(axis[0], axis[1]) > LEAST_TILT else np.array([0.0, 1.0, 0.0])
    right = unit(np.cross(up, axis))
    return np.column_stack([right, np.cross(axis, right), axis])


def aimed(rotation: Float64Array, shines: Float64Array) -> Float64Array:
    """(3, 3) the rotation whose -Z is the unit vector `shines` (3,) and that is turned about it as `rotation` (3, 3)
    is turned about its own, as seen against the vertical."""
    return upright(-shines) @ upright(rotation[:, 2]).T @ rotation
