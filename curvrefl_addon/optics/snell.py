# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Snell's law at a star-shaped surface: what makes a zero of the optical path's gradient a refraction.

`index` is the index of refraction beyond the surface over that on the eye's side, positive. `side` is 1 where the eye
is outside of the surface and -1 where it is inside.
"""

from __future__ import annotations

import numpy as np

from .fermat import SurfaceSample, towards_eye
from .surfaces.radial_surfaces import Float64Array, unit

SMALLEST_INDEX, LARGEST_INDEX = 1e-3, 1e3
"""Beyond them glass is a mirror, or shows nothing but its middle: single precision finds no refraction points"""


def index_in_range(index: float) -> float:
    """The index, or the end of the range that single precision serves. Raises ValueError for what is no number."""
    if np.isnan(index):
        raise ValueError("an index of refraction has to be a number")
    return float(np.clip(index, SMALLEST_INDEX, LARGEST_INDEX))


def refracted(to_eye: Float64Array, normal: Float64Array, index: float | Float64Array) -> Float64Array:
    """Unit directions (n, 3) beyond the surface of lines of sight; NaN where they are reflected totally.

    `to_eye` and `normal` (n, 3) unit, on the same side; `index` a number or (n, 1).
    """
    cosine = np.einsum("ij,ij->i", to_eye, normal)[:, None]
    inner = 1.0 - (1.0 - cosine**2) / np.square(index)
    bent = np.where(inner >= 0.0, np.sqrt(np.maximum(inner, 0.0)), np.nan)
    return (cosine / index - bent) * normal - to_eye / index


def is_refraction_side(eye: Float64Array, vertices: Float64Array, at: SurfaceSample, side: float = 1.0) -> np.ndarray:
    """(n,) whether the eye sees P from its side, and the vertex is beyond the tangent plane there.

    The gradient also vanishes where both are on one side and the sines of their angles have the index as their ratio,
    which is no path of light, and where the eye's way to P leads through the glass.
    """
    normal = side * at.normal
    sees_eye = np.einsum("ij,ij->i", normal, towards_eye(eye, at.position)) > 0.0
    return sees_eye & (np.einsum("ij,ij->i", normal, vertices - at.position) < 0.0)


def snell_error(
    eye: Float64Array, vertices: Float64Array, at: SurfaceSample, index: float, side: float = 1.0
) -> Float64Array:
    """(n,) angle in radians between the refracted line of sight and the way to the vertex.

    Pi where the eye does not see P or its light is reflected totally.
    """
    to_eye, normal = towards_eye(eye, at.position), side * at.normal
    ray, to_vertex = refracted(to_eye, normal, index), unit(vertices - at.position)
    angle = np.arctan2(np.linalg.norm(np.cross(ray, to_vertex), axis=1), np.einsum("ij,ij->i", ray, to_vertex))
    return np.where((np.einsum("ij,ij->i", to_eye, normal) > 0.0) & np.isfinite(angle), angle, np.pi)


def transmittance(cosine: Float64Array, index: float | Float64Array) -> Float64Array:
    """(n,) share of unpolarized light that a sharp surface lets through, by the cosine (n,) of incidence; Fresnel."""
    c = np.clip(np.abs(cosine), 0.0, 1.0)
    squared = np.square(index) - 1.0 + c**2
    g = np.sqrt(np.maximum(squared, 0.0))
    first = (g - c) / np.maximum(g + c, 1e-300)
    second = (c * (g + c) - 1.0) / (c * (g - c) + 1.0)
    return np.where(squared > 0.0, 1.0 - 0.5 * first**2 * (1.0 + second**2), 0.0)
