# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The GGX microfacet surface, as `scattering/microfacet.glsl`, in double precision.

Directions are (n, 3) unit vectors in the surface's frame: z is the normal, x the tangent. `alpha`: (2,) widths along x
and y. The distribution is Walter et al., "Microfacet Models for Refraction through Rough Surfaces" (EGSR 2007), eq. 33,
stretched along x and y; masking is Smith's, and where it is of viewer and light together height-correlated: Heitz,
"Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs" (JCGT 2014), eq. 72, 99.

With L(w) = |(ax wx, ay wy, wz)|, the length of a direction stretched by the widths, Smith's lambda is
(L / |wz| - 1) / 2, so 1 + lambda = (|wz| + L) / (2 |wz|). The visible normals D G1 max(v.h, 0) / vz, mapped to
reflected directions by the Jacobian 1 / (4 v.h), have the density D / (4 vz (1 + lambda)) = D / (2 (vz + L)).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "SHARP_ALPHA",
    "cap_bound",
    "ggx_density",
    "reflected",
    "reflected_density",
    "reflected_value",
    "shadowing",
    "surface_frame",
    "visible_normal",
]

type Array = NDArray[np.float64]

SHARP_ALPHA = 7e-4
"""Widths (squared roughness) up to this are followed as single directions, which no sample of a lamp can meet"""


def surface_frame(normal: Array, tangent: Array) -> Array:
    """(3, 3) with the columns x, y, z of the surface's frame: x towards the tangent, z the normal, both (3,) unit."""
    y = np.cross(normal, tangent)
    if y @ y <= 1e-8:
        # Duff et al., "Building an Orthonormal Basis, Revisited" (JCGT 2017).
        side = -1.0 if normal[2] < 0.0 else 1.0
        a = -1.0 / (side + normal[2])
        y = np.array([normal[0] * normal[1] * a, side + normal[1] * normal[1] * a, -normal[1]])
    y = y / np.linalg.norm(y)
    return np.stack([np.cross(y, normal), y, normal], axis=1)


def ggx_density(h: Array, alpha: Array) -> Array:
    """Density of microfacet normals: times their cosine it integrates to 1 over the hemisphere."""
    stretched = h / np.array([alpha[0], alpha[1], 1.0])
    return 1.0 / (np.pi * alpha[0] * alpha[1] * (stretched * stretched).sum(axis=1) ** 2)


def _stretched_length(w: Array, alpha: Array) -> Array:
    return np.sqrt((alpha[0] * w[:, 0]) ** 2 + (alpha[1] * w[:, 1]) ** 2 + w[:, 2] ** 2)


def shadowing(to_viewer: Array, to_light: Array, alpha: Array) -> Array:
    """G2 / G1: (1 + lambda(viewer)) / (1 + lambda(viewer) + lambda(light)); the light may be on the far side."""
    viewer = _stretched_length(to_viewer, alpha) / to_viewer[:, 2]
    light = _stretched_length(to_light, alpha) / np.maximum(np.abs(to_light[:, 2]), 1e-7)
    return (1.0 + viewer) / (viewer + light)


def cap_bound(to_viewer: Array, alpha: Array) -> Array:
    """How far down the spherical cap reaches that holds all normals whose reflections stay above the surface.

    Tokuyoshi and Eto, "Bounded VNDF Sampling for the Smith-GGX BRDF" (2024), eq. 5: of the cap's lower end -vz (in the
    stretched frame) this share is sampled. 1 samples all visible normals.
    """
    a2 = min(float(np.min(alpha)), 1.0) ** 2
    s2 = (1.0 + np.hypot(to_viewer[:, 0], to_viewer[:, 1])) ** 2
    return (1.0 - a2) * s2 / (s2 + a2 * to_viewer[:, 2] ** 2)


def visible_normal(to_viewer: Array, alpha: Array, bound: Array | float, random: Array) -> Array:
    """Microfacet normals out of those that the viewer sees, by (n, 2) random numbers.

    Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps" (HPG 2023): where the stretched viewer is v, a
    uniform direction of the cap z >= -v.z plus v is along a visible normal of the hemisphere.
    """
    stretched = to_viewer * np.array([alpha[0], alpha[1], 1.0])
    stretched /= np.linalg.norm(stretched, axis=1, keepdims=True)
    phi = 2.0 * np.pi * random[:, 0]
    b = bound * stretched[:, 2]
    z = (1.0 - random[:, 1]) * (1.0 + b) - b
    sine = np.sqrt(np.clip(1.0 - z * z, 0.0, 1.0))
    h = np.stack([sine * np.cos(phi), sine * np.sin(phi), z], axis=1) + stretched
    h = np.stack([alpha[0] * h[:, 0], alpha[1] * h[:, 1], np.maximum(h[:, 2], 0.0)], axis=1)
    length = np.linalg.norm(h, axis=1, keepdims=True)
    return np.where(length > 1e-10, h / np.maximum(length, 1e-10), np.array([0.0, 0.0, 1.0]))


def reflected(to_viewer: Array, h: Array) -> Array:
    """Where mirrors with these normals see."""
    return 2.0 * (to_viewer * h).sum(axis=1, keepdims=True) * h - to_viewer


def reflected_density(to_viewer: Array, h: Array, alpha: Array, bound: Array | float) -> Array:
    """Density, per solid angle, of `reflected` by `visible_normal`.

    The sampled cap is (1 + bound vz') / (1 + vz') of the whole, vz' = vz / L: of the D / (2 (vz + L)) above remains
    D / (2 (bound vz + L)).
    """
    length = _stretched_length(to_viewer, alpha)
    return ggx_density(h, alpha) / (2.0 * (bound * to_viewer[:, 2] + length))


def reflected_value(to_viewer: Array, to_light: Array, h: Array, alpha: Array) -> Array:
    """BRDF D G2 / (4 vz lz) times the cosine lz: the full density of normals times G2 / G1."""
    return reflected_density(to_viewer, h, alpha, 1.0) * shadowing(to_viewer, to_light, alpha)
