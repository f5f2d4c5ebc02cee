# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixed surfaces, meshes and views that proofs are about. Nothing is random: every device gets the same."""

from __future__ import annotations

import numpy as np

from ...optics.surfaces.cube_map import texel_directions
from ...optics.surfaces.radial_surfaces import RadialSurface
from ...scene.arrays import Float32Array, Float64Array, MeshArrays
from ...scene.camera.looking import look_at
from ...scene.camera.view import View
from ...scene.meshes.made import quad_mesh, smooth_mesh

EYE = np.array([2.3, -2.9, 1.8])
ANGLE = np.radians(40.0)
NAME = "of a proof"
"""Of meshes"""


def view_of_origin(eye: Float64Array, width: int, height: int) -> View:
    """From an eye (3,) to the origin, z up."""
    return look_at(eye, np.zeros(3), width, height, ANGLE)


def lines_of_sight(view: View) -> Float64Array:
    """(h, w, 3) unit directions from the eye through the pixels' centers."""
    _, directions = view.lines_of_sight(view.pixel_centers)
    return directions.reshape(view.height, view.width, 3)


def radial_map(surface: RadialSurface, resolution: int) -> Float32Array:
    """(6, n, n, 4) radius and gradient at the texels of a cube map."""
    radius, gradient = surface.radius(texel_directions(resolution).reshape(-1, 3))
    return np.column_stack([radius, gradient]).reshape(6, resolution, resolution, 4).astype(np.float32)


def directions(count: int) -> Float64Array:
    """(n, 3) unit vectors that fill the sphere evenly, on a spiral of golden angles."""
    z = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = np.arange(count) * np.pi * (3.0 - np.sqrt(5.0))
    sine = np.sqrt(1.0 - z * z)
    return np.column_stack([sine * np.cos(turn), sine * np.sin(turn), z])


def vertices_around(surface: RadialSurface, count: int, farthest: float = 10.0) -> Float64Array:
    """(n, 3) outside of a surface, from a hundredth of a radius to `farthest` away; as single precision holds them."""
    u = directions(count)
    away = 0.01 * (100.0 * farthest) ** ((np.arange(count) * 0.6180339887) % 1.0)
    return as_stored(u * (surface.radius(u)[0] + away)[:, None])


def as_stored(values: Float64Array) -> Float64Array:
    """With no more digits than textures hold."""
    return values.astype(np.float32).astype(np.float64)


def records_of(points: Float64Array) -> Float32Array:
    """(n, 4) of positions (n, 3)."""
    return np.column_stack([points, np.ones(len(points))]).astype(np.float32)


def ball(rings: int) -> MeshArrays:
    """The unit ball as longitudes and latitudes, smooth."""
    segments = 2 * rings
    theta = np.linspace(0.0, np.pi, rings + 1)[:, None]
    phi = np.arange(segments) * (2.0 * np.pi / segments)
    ring = np.ones(segments)
    points = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta) * ring], axis=-1)
    a = (np.arange(rings)[:, None] * segments + np.arange(segments)).ravel()
    b = (np.arange(rings)[:, None] * segments + (np.arange(segments) + 1) % segments).ravel()
    lower, upper = np.column_stack([a, a + segments, b + segments]), np.column_stack([a, b + segments, b])
    triangles = np.concatenate([lower[:-segments], upper[segments:]])
    return smooth_mesh(NAME, points.reshape(-1, 3), points.reshape(-1, 3), triangles)


def square(half: float, height: float) -> MeshArrays:
    """A square across z, seen from above."""
    corners = np.array([[-half, -half, height], [half, -half, height], [half, half, height], [-half, half, height]])
    return quad_mesh(NAME, corners, (0.0, 0.0, 1.0))
