# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fermat's principle on a star-shaped surface: path length, its gradient, and what makes a point a reflection.

A leg in glass counts its length times the index of refraction: with `index`, that of the vertex's side over that of
the eye's, a zero of the gradient is a refraction (`snell.py`); with 1 it is a reflection.

The eye E is homogeneous, (x, y, z, 1) for a point and (x, y, z, 0) for the unit direction towards an eye at
infinity (orthographic view). Positions are relative to the star center.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .surfaces.radial_surfaces import Float64Array, RadialSurface, tangential, unit


@dataclass(frozen=True)
class SurfaceSample:
    """The reflector at n directions."""

    position: Float64Array
    """(n, 3) P = r u"""
    normal: Float64Array
    """(n, 3) outward unit shading normal, r u - grad r normalized"""
    radius: Float64Array
    """(n,)"""
    gradient: Float64Array
    """(n, 3) tangential gradient of r"""


def sample(surface: RadialSurface, u: Float64Array) -> SurfaceSample:
    """The surface at unit directions u (n, 3)."""
    radius, gradient = surface.radius(u)
    return SurfaceSample(radius[:, None] * u, unit(radius[:, None] * u - gradient), radius, gradient)


def towards_eye(eye: Float64Array, points: Float64Array) -> Float64Array:
    """Unit vectors (n, 3) from points (n, 3) to the homogeneous eye (4,) or eyes (n, 4)."""
    return unit(eye[..., :3] - points * eye[..., 3:4])


def half_vector(eye: Float64Array, vertices: Float64Array, points: Float64Array, index: float = 1.0) -> Float64Array:
    """h = (E-P)/|E-P| + index (V-P)/|V-P|, (n, 3): not normalized, parallel to the normal where P shows V."""
    return towards_eye(eye, points) + index * unit(vertices - points)


def path_gradient(
    eye: Float64Array, vertices: Float64Array, u: Float64Array, at: SurfaceSample, index: float = 1.0
) -> Float64Array:
    """Gradient (n, 3) on the unit sphere of the path length |E-P| + index |P-V| (Roger & Holzschuch 2006, equation 1).

    dP = u (grad r . du) + r du and dl = -h . dP, written as one tangent vector at u.
    """
    h = half_vector(eye, vertices, at.position, index)
    radial = np.einsum("ij,ij->i", h, u)
    return -(radial[:, None] * at.gradient + at.radius[:, None] * tangential(h, u))


def is_reflection_side(eye: Float64Array, vertices: Float64Array, at: SurfaceSample, side: float = 1.0) -> np.ndarray:
    """(n,) whether eye and vertex both see the outer side of the surface at P; the inner one where `side` is -1.

    The gradient also vanishes where the segment E-V pierces the reflector: without this test every hidden
    vertex looks solved.
    """
    sees_eye = side * np.einsum("ij,ij->i", at.normal, towards_eye(eye, at.position)) > 0.0
    sees_vertex = side * np.einsum("ij,ij->i", at.normal, vertices - at.position) > 0.0
    return sees_eye & sees_vertex


def mirror_error(eye: Float64Array, vertices: Float64Array, at: SurfaceSample) -> Float64Array:
    """(n,) angle in radians between the half vector and the normal."""
    h = half_vector(eye, vertices, at.position)
    sine = np.linalg.norm(np.cross(h, at.normal), axis=1)
    return np.arctan2(sine, np.einsum("ij,ij->i", h, at.normal))
