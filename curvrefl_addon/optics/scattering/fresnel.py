# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fresnel terms, as `lighting/fresnel.glsl` and `scattering/fresnel_layers.glsl`, in double precision.

Cosines are (n,) between a direction and a microfacet's normal; colors (3,), reflectances (n, 3).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "edge_dip",
    "fresnel_dielectric",
    "leveled_ior",
    "mean_dielectric",
    "normal_reflectance",
    "refracted_cosine",
    "tinted_dielectric",
    "tinted_metal",
]

type Array = NDArray[np.float64]


def normal_reflectance(eta: float) -> float:
    """Of a smooth dielectric seen along its normal."""
    return ((eta - 1.0) / (eta + 1.0)) ** 2


def fresnel_dielectric(cosine: Array, eta: float) -> Array:
    """Unpolarized reflectance where `eta` is the far side's index over the near one's; 1 beyond the critical angle.

    The mean of Fresnel's two terms by g^2 = eta^2 - 1 + cos^2: Walter et al. (2007), eq. 22.
    """
    c = np.abs(cosine)
    square = eta * eta - 1.0 + c * c
    g = np.sqrt(np.maximum(square, 1e-300))
    a = (g - c) / (g + c)
    b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0)
    return np.where(square > 0.0, 0.5 * a * a * (1.0 + b * b), 1.0)


def leveled_ior(ior: float, level: float) -> float:
    """IOR whose reflectance along the normal is that of `ior` times 2 `level`, at most 0.99."""
    if level == 0.5:
        return ior
    root = np.sqrt(min(normal_reflectance(ior) * 2.0 * max(level, 0.0), 0.99))
    eta = float((1.0 + root) / (1.0 - root))
    return 1.0 / eta if ior < 1.0 else eta


def tinted_dielectric(f0: Array, eta: float, cosine: Array) -> Array:
    """From `f0` to white as far as the true term gets from its own reflectance along the normal to 1, as Cycles."""
    real = normal_reflectance(eta)
    share = np.clip((fresnel_dielectric(cosine, eta) - real) / max(1.0 - real, 1e-6), 0.0, 1.0)
    return f0 + (1.0 - f0) * share[:, None]


def edge_dip(f0: Array, tint: Array) -> Array:
    """What `tinted_metal` takes off at the edge: at the cosine 1/7 the term is `tint` times Schlick's.

    Kutz, Hasan and Edmondson, "Novel aspects of the Adobe Standard Material" (2021): Schlick - dip cos (1 - cos)^6, and
    cos (1 - cos)^6 is largest at 1/7.
    """
    s = 6.0 / 7.0
    return (f0 + (1.0 - f0) * s**5) * (1.0 - tint) * (7.0 / s**6)


def tinted_metal(f0: Array, dip: Array, cosine: Array) -> Array:
    """Schlick's term from `f0` to white less the dip."""
    s = np.clip(1.0 - cosine, 0.0, 1.0)[:, None]
    return np.clip(f0 + (1.0 - f0) * s**5 - dip * (cosine[:, None] * s**6), 0.0, 1.0)


def mean_dielectric(eta: float) -> float:
    """Cosine-weighted mean of `fresnel_dielectric` over the hemisphere, fitted: Kulla and Conty (2017)."""
    if eta < 1.0:
        fit = 0.997118 + eta * (0.1014 - eta * (0.965241 + eta * 0.130607))
    else:
        fit = (eta - 1.0) / (4.08567 + 1.00071 * eta)
    return min(max(fit, 0.0), 1.0)


def refracted_cosine(cosine: Array, eta: float) -> Array:
    """Of the refracted ray to the other side of the normal, by Snell's law; 0 where nothing is refracted."""
    return np.sqrt(np.maximum(1.0 - np.maximum(1.0 - cosine * cosine, 0.0) / (eta * eta), 0.0))
