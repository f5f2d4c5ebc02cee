# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Environment lookups in float64: the sphere (disk) map and its inverse, and the finite-radius correction.

Sphere map: the picture of a mirror ball that an infinite eye takes along an axis (McGill COMP 557, lecture 18; OpenGL's
GL_SPHERE_MAP). Finite radius: the environment is put on a ball about the map's center (Bjorke 2004; Roger & Holzschuch
2006, section 2).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .surfaces.radial_surfaces import Float64Array

SINGULAR = 1e-12
"""Directions nearer than this to the one away from the eye, in radians, are on the rim wherever one likes"""


def axis_frame(axis: Float64Array) -> Float64Array:
    """(3, 3) rows right, up and axis of a right-handed frame about a unit direction (3,); up leans to world Z."""
    helper = np.array([0.0, 0.0, 1.0]) if abs(axis[2]) < 0.999 else np.array([0.0, 1.0, 0.0])
    right = np.cross(helper, axis)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(axis, right), axis])


def sphere_map_places(directions: Float64Array) -> Float64Array:
    """(m, 2) places s, t in the unit disk of unit directions (m, 3) in the frame whose z axis points to the eye.

    The mirror ball's normal that reflects the eye there. The direction (0, 0, -1) is all of the rim: it gets (1, 0).
    """
    halves = directions + np.array([0.0, 0.0, 1.0])
    size = np.linalg.norm(halves, axis=-1, keepdims=True)
    return np.where(size > SINGULAR, halves[..., :2] / np.maximum(size, SINGULAR), [1.0, 0.0])


def sphere_map_directions(places: Float64Array) -> Float64Array:
    """(m, 3) unit directions of places s, t (m, 2); outside of the disk that of the rim."""
    height = np.sqrt(np.maximum(1.0 - (places**2).sum(axis=-1), 0.0))[..., None]
    directions = 2.0 * height * np.concatenate([places, height], axis=-1)
    directions[..., 2] -= 1.0
    return directions


def parallax_directions(points: Float64Array, rays: Float64Array, radius: float) -> Float64Array:
    """Directions (m, 3), not unit, from the map's center to where rays meet the ball of `radius` about it.

    `points` (m, 3) are where the rays start, from the center, inside of the ball; `rays` (m, 3) are unit.
    """
    along = np.einsum("mi,mi->m", points, rays)
    root = along**2 + radius**2 - np.einsum("mi,mi->m", points, points)
    return points + (np.sqrt(np.maximum(root, 0.0)) - along)[:, None] * rays


def texel_solid_angles(resolution: int) -> Float64Array:
    """(n, n) solid angles of the texels of a cube map's face, but for a common factor, taken at their centers."""
    centers = (2.0 * np.arange(resolution) + 1.0) / resolution - 1.0
    return (1.0 + centers[:, None] ** 2 + centers[None] ** 2) ** -1.5


def environment_radius(faces: NDArray[np.floating], center: Float64Array, least: float) -> float:
    """Radius of the ball that stands for what a cube map sees: the median distance, weighed by solid angle.

    `faces` (6, n, n, 4) have a world position and an object_id (0: nothing) per texel, `center` (3,) is where they were
    seen from. Never less than `least`; 0 where nothing is seen.
    """
    seen = faces[..., 3] > 0.0
    if not seen.any():
        return 0.0
    distances = np.linalg.norm(faces[seen][:, :3] - center, axis=1)
    weights = np.broadcast_to(texel_solid_angles(faces.shape[1]), seen.shape)[seen]
    order = np.argsort(distances)
    summed = np.cumsum(weights[order])
    median = distances[order[np.searchsorted(summed, 0.5 * summed[-1])]]
    return max(float(median), least)
