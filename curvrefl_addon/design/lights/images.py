# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where in mirrors things show: all images of a place, and the outlines of lamps. float64, no bpy.

A corner of the mirror's mesh reflects a ray; whether it meets a lamp, and how far it misses the lamp's middle, changes
almost evenly over a small triangle. So each triangle is asked by itself, and mirrors of any shape have as many images
as there are; a Newton search on the triangle, with the normals interpolated as they are drawn, puts an image in its
place. (`optics/surfaces/mesh_reflections.py` leaves none out, by a tree that takes seconds to make for a large mesh:
here what is dragged is looked for in milliseconds, on the pieces that outlines need anyway.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import Float64Array, LightArrays
from .reflecting import Reflecting, reflected

SLACK = 0.02
"""Barycentric, within which an image on an edge belongs to both triangles"""
GUESS_SLACK = 2.0
"""The same of the place to search from, by a change that is taken to be even"""
NEWTON_STEPS = 6
STEP = 1e-4
"""Barycentric, of differences"""
MOST_MISSED = 1e-5
"""Radians by which a ray may miss the place after all"""
SAME = 0.1
"""Pixels between images that are one"""
OUTSIDE = 1e3
"""Level of rays that go away from a lamp"""


@dataclass(frozen=True, slots=True)
class Images:
    """Of one place in one mirror."""

    points: Float64Array
    """(k, 3) on the mirror, world space"""
    pixels: Float64Array
    """(k, 2) from the bottom left"""


def place_of(light: LightArrays) -> Float64Array:
    """(4,) homogeneous middle of a lamp; the direction to a sun."""
    if light.kind == "SUN":
        return np.append(light.matrix[:3, 2], 0.0)
    return np.append(light.matrix[:3, 3], 1.0)


def images(mirror: Reflecting, place: Float64Array) -> Images:
    """All images of the homogeneous place (4,) that the mirror may show, whatever is in the way."""
    missed, ahead = _missed(mirror.points, mirror.directions, place)
    triangles = mirror.triangles[(ahead[mirror.triangles] > 0.0).any(axis=1)]
    # The part of what a ray misses across the way to the place, in two directions for each triangle.
    way = unit(place[:3] - mirror.points[triangles[:, 0]] * place[3])
    first, second = _across(way)
    miss = missed[triangles]
    u, v = np.einsum("tkc,tc->tk", miss, first), np.einsum("tkc,tc->tk", miss, second)
    weights = _zero_of(u, v)
    found = (weights >= -GUESS_SLACK).all(axis=1)
    triangles, weights = triangles[found], weights[found]
    points, residual, weights = _settled(mirror, triangles, weights, place)
    is_one = (residual < MOST_MISSED) & (weights >= -SLACK).all(axis=1)
    points = points[is_one]
    pixels = mirror.view.project(points)
    kept: list[int] = []
    for number, pixel in enumerate(pixels):
        if all(np.linalg.norm(pixel - pixels[other]) > SAME for other in kept):
            kept.append(number)
    return Images(points[kept], pixels[kept])


def outline(mirror: Reflecting, light: LightArrays) -> tuple[Float64Array, Float64Array]:
    """What a lamp's edge looks like: segments in pixels (s, 2, 2), and their middles (s, 3) in the world."""
    level = _level(mirror.points, mirror.directions, light)
    triangles = mirror.triangles
    inside = level[triangles] < 0.0
    triangles = triangles[inside.any(axis=1) & ~inside.all(axis=1)]
    if len(triangles) == 0:
        return np.zeros((0, 2, 2)), np.zeros((0, 3))
    levels = level[triangles]
    # The corner that is alone on its side comes first.
    alone = np.where((levels < 0.0).sum(axis=1) == 1, (levels < 0.0).argmax(axis=1), (levels >= 0.0).argmax(axis=1))
    turned = np.take_along_axis(triangles, (alone[:, None] + np.arange(3)) % 3, axis=1)
    levels = level[turned]
    ends, places = [], []
    for other in (1, 2):
        share = levels[:, 0] / (levels[:, 0] - levels[:, other])
        places.append(_between(mirror.points[turned[:, 0]], mirror.points[turned[:, other]], share))
        ends.append(_between(mirror.pixels[turned[:, 0]], mirror.pixels[turned[:, other]], share))
    return np.stack(ends, axis=1), 0.5 * (places[0] + places[1])


def is_met(light: LightArrays, origin: Float64Array, direction: Float64Array, length: float) -> bool:
    """Whether a ray from (3,) along the unit direction (3,) meets the lamp before it ends."""
    if _level(origin[None], direction[None], light)[0] >= 0.0:
        return False
    if light.kind == "SUN":
        return not np.isfinite(length)
    return float((light.matrix[:3, 3] - origin) @ direction) <= length + max(light.radius, 0.5 * max(light.size))


def _level(points: Float64Array, directions: Float64Array, light: LightArrays) -> Float64Array:
    """(n,) below 0 where a ray meets the lamp, 0 on its edge, 1 as far from that as its middle is."""
    x, y, back, center = (light.matrix[:3, column] for column in range(4))
    if light.kind == "SUN":
        cosine = directions @ back
        level = np.arccos(np.clip(cosine, -1.0, 1.0)) / max(0.5 * light.angle, 1e-9) - 1.0
        return np.minimum(level, OUTSIDE)
    away = center - points
    if light.kind == "AREA":
        slope = directions @ back
        along = np.einsum("ij,j->i", away, back) / np.where(slope == 0.0, 1e-300, slope)
        offset = along[:, None] * directions - away
        half = 0.5 * np.maximum(light.size, 1e-12)
        a, b = offset @ x / half[0], offset @ y / half[1]
        level = (np.hypot(a, b) if light.ellipse else np.maximum(np.abs(a), np.abs(b))) - 1.0
        is_ahead = along > 0.0
    else:
        along = np.einsum("ij,ij->i", away, directions)
        offset = away - along[:, None] * directions
        level = np.sqrt(np.einsum("ij,ij->i", offset, offset)) / max(light.radius, 1e-12) - 1.0
        is_ahead = along > 0.0
    return np.where(is_ahead, np.minimum(level, OUTSIDE), OUTSIDE)


def _missed(points: Float64Array, directions: Float64Array, place: Float64Array) -> tuple[Float64Array, Float64Array]:
    """(n, 3) differences of the unit directions of rays and of those to the place, and (n,) cosines between both."""
    to_place = unit(place[:3] - points * place[3])
    return directions - to_place, np.einsum("ij,ij->i", directions, to_place)


def _across(ways: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Two unit directions (n, 3) square to the ways (n, 3) and to each other."""
    helper = np.eye(3)[np.abs(ways).argmin(axis=1)]
    first = unit(np.cross(helper, ways))
    return first, np.cross(ways, first)


def _zero_of(u: Float64Array, v: Float64Array) -> Float64Array:
    """(t, 3) barycentric places where two even changes over triangles, by their values at corners (t, 3), are 0."""
    cross = np.stack([u[:, k - 2] * v[:, k - 1] - u[:, k - 1] * v[:, k - 2] for k in range(3)], axis=1)
    total = cross.sum(axis=1)
    return cross / np.where(np.abs(total) > 1e-300, total, np.nan)[:, None]


def _settled(
    mirror: Reflecting, triangles: NDArray[np.int64], weights: Float64Array, place: Float64Array
) -> tuple[Float64Array, Float64Array, Float64Array]:
    """Newton steps on the triangles: points (n, 3), by how many radians they miss, and weights (n, 3)."""
    corners, normals = mirror.points[triangles], mirror.normals[triangles]

    def at(weights: Float64Array) -> tuple[Float64Array, Float64Array]:
        points = np.einsum("nk,nkc->nc", weights, corners)
        normal = np.einsum("nk,nkc->nc", weights, normals)
        return points, _missed(points, reflected(points, normal, mirror.view), place)[0]

    points, miss = at(weights)
    for _ in range(NEWTON_STEPS):
        first, second = _across(unit(place[:3] - points * place[3]))
        steps = [np.array([-1.0, 1.0, 0.0]), np.array([-1.0, 0.0, 1.0])]
        slopes = [(at(weights + STEP * step)[1] - miss) / STEP for step in steps]
        a, b = (np.einsum("nc,nc->n", slope, first) for slope in slopes)
        c, d = (np.einsum("nc,nc->n", slope, second) for slope in slopes)
        p, q = np.einsum("nc,nc->n", miss, first), np.einsum("nc,nc->n", miss, second)
        determinant = a * d - b * c
        determinant = np.where(np.abs(determinant) > 1e-300, determinant, np.inf)
        moved = np.stack([(b * q - d * p) / determinant, (c * p - a * q) / determinant], axis=1).clip(-0.5, 0.5)
        weights = weights + moved[:, :1] * steps[0] + moved[:, 1:] * steps[1]
        points, miss = at(weights)
    return points, np.linalg.norm(miss, axis=1), weights


def _between(start: Float64Array, end: Float64Array, share: Float64Array) -> Float64Array:
    return start + share[:, None] * (end - start)
