# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflectance under a thin film, as `scattering/film.glsl`, in double precision.

Belcour and Barla, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence" (ACM TOG 36(4),
2017): light that a film of thickness d and index n has led to its bottom and back m times is behind by m times the
optical path 2 n d cos t, and by m times the phases of both reflections. Of the reflectance, whose Fourier series in
those phases is that of an Airy sum, remains for a color c the sum over m of C_m Re(exp(i m phase) S_c(m path)), with
S_c(path) the mean of exp(-i 2 pi path / wavelength) over the color's matching function: paths many wavelengths long
mean nothing. Cycles does the same and stops at m = 3.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from .fresnel import normal_reflectance, tinted_dielectric, tinted_metal

__all__ = [
    "FILM_STEPS",
    "LONGEST_PATH",
    "NO_FILM",
    "film_on_dielectric",
    "film_on_metal",
    "film_or_dielectric",
    "film_sensitivity",
]

type Array = NDArray[np.float64]
type ComplexArray = NDArray[np.complex128]

FILM_STEPS = 512
"""Of the table of sensitivities"""
LONGEST_PATH = 9549.0
"""Nanometers: beyond, colors have averaged out"""
NO_FILM = 0.1
"""Nanometers up to which there is no film"""
XYZ_TO_REC709 = np.array(
    [[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]]
)
# CIE 1931 color matching functions as sums of Gaussians with a width on either side: Wyman, Sloan and Shirley, "Simple
# Analytic Approximations to the CIE XYZ Color Matching Functions" (JCGT 2(2), 2013): height, middle, both widths.
LOBES = (
    ((1.056, 599.8, 37.9, 31.0), (0.362, 442.0, 16.0, 26.7), (-0.065, 501.1, 20.4, 26.2)),
    ((0.821, 568.8, 46.9, 40.5), (0.286, 530.9, 16.3, 31.1)),
    ((1.217, 437.0, 11.8, 36.0), (0.681, 459.0, 26.0, 13.8)),
)


def _matching(wavelength: Array) -> Array:
    """(3, n) of red, green and blue of Rec.709."""
    xyz = [
        sum(h * np.exp(-0.5 * ((wavelength - m) / np.where(wavelength < m, a, b)) ** 2) for h, m, a, b in lobes)
        for lobes in LOBES
    ]
    return XYZ_TO_REC709 @ np.array(xyz)


@cache
def film_sensitivity() -> ComplexArray:
    """(FILM_STEPS, 3) S_c at paths of 0 to LONGEST_PATH."""
    wavelength = np.linspace(360.0, 830.0, 1200)
    matching = _matching(wavelength)
    paths = np.linspace(0.0, LONGEST_PATH, FILM_STEPS)
    turned = np.exp(-2j * np.pi * paths[:, None] / wavelength)
    return np.asarray((turned @ matching.T) / matching.sum(axis=1), np.complex128)


def _sensitivity(path: Array) -> ComplexArray:
    """(n, 3)"""
    table = film_sensitivity()
    place = np.clip(path / LONGEST_PATH, 0.0, 1.0) * (FILM_STEPS - 1)
    below = np.minimum(place.astype(int), FILM_STEPS - 2)
    between = (place - below)[:, None]
    return np.asarray(table[below] * (1.0 - between) + table[below + 1] * between, np.complex128)


def polarized_dielectric(cosine: Array, eta: Array | float) -> tuple[Array, Array, Array]:
    """(n, 2) reflectances across and along the plane of incidence, the signs of both amplitudes, and (n,) the cosine
    behind, 0 where all is reflected."""
    cosine = np.abs(cosine)
    inner = np.sqrt(np.maximum(1.0 - (1.0 - cosine * cosine) / (eta * eta), 0.0))
    across = (cosine - eta * inner) / np.maximum(cosine + eta * inner, 1e-300)
    along = (eta * cosine - inner) / np.maximum(eta * cosine + inner, 1e-300)
    amplitudes = np.where((inner > 0.0)[:, None], np.stack([across, along], axis=1), 1.0)
    return amplitudes**2, np.where(amplitudes >= 0.0, 1.0, -1.0), inner


def _airy(r12: Array, r23: Array, path: Array, phase: ComplexArray, channel: int) -> Array:
    """(n,) of one polarization and color."""
    through = 1.0 - r12
    both = np.minimum(r12 * r23, 1.0 - 1e-9)
    bottom = through * through * r23 / (1.0 - both)
    total = bottom + r12
    share = bottom - through
    turned = phase
    for m in (1, 2, 3):
        share = share * np.sqrt(both)
        total = total + 2.0 * share * (turned * np.conj(_sensitivity(m * path)[:, channel])).real
        turned = turned * phase
    return total


def _film_index(thickness: float, index: float) -> float:
    """Films under 1 nm fade out."""
    s = min(max(thickness, 0.0), 1.0)
    return 1.0 + (max(index, 1e-5) - 1.0) * s * s * (3.0 - 2.0 * s)


def film_on_dielectric(thickness: float, index: float, f0: Array, eta: float, cosine: Array) -> Array:
    """(n, 3) of a dielectric of index `eta` under a film; scaled towards `f0` where it is low, as Cycles."""
    index = _film_index(thickness, index)
    top, top_signs, inner = polarized_dielectric(cosine, index)
    bottom, bottom_signs, inmost = polarized_dielectric(inner, eta / index)
    path = 2.0 * index * thickness * inner
    phases = (-top_signs * bottom_signs).astype(complex)
    result = np.empty((len(cosine), 3))
    for channel in range(3):
        parts = [_airy(top[:, p], bottom[:, p], path, phases[:, p], channel) for p in (0, 1)]
        result[:, channel] = np.clip(0.5 * (parts[0] + parts[1]), 0.0, 1.0)
    whole = (inner <= 0.0) | (inmost <= 0.0)
    result[whole] = 1.0
    real = normal_reflectance(eta)
    if real > 1e-5:
        share = np.clip((1.0 - result) / (1.0 - real), 0.0, 1.0)
        result = result * (1.0 + (f0 / real - 1.0) * share)
    return result


def film_or_dielectric(thickness: float, index: float, f0: Array, eta: float, cosine: Array) -> Array:
    """`film_on_dielectric`, or without a film `tinted_dielectric`."""
    if thickness > NO_FILM:
        return film_on_dielectric(thickness, index, f0, eta, cosine)
    return tinted_dielectric(f0, eta, cosine)


def film_on_metal(thickness: float, index: float, f0: Array, dip: Array, cosine: Array) -> Array:
    """(n, 3) of a metal under a film.

    Its index n + i k is guessed from its reflectances along the normal and at a cosine of 1/7: Gulbrandsen, "Artist
    Friendly Metallic Fresnel" (JCGT 2014). The bottom reflects as much as `tinted_metal` would, in the phases of the
    complex index: Born and Wolf, "Principles of Optics", 14.4.1.
    """
    index = _film_index(thickness, index)
    top, top_signs, inner = polarized_dielectric(cosine, index)
    path = 2.0 * index * thickness * inner
    edge = tinted_metal(f0, dip, np.array([1.0 / 7.0]))[0]
    result = np.empty((len(cosine), 3))
    for channel in range(3):
        r, g = min(f0[channel], 0.999), edge[channel]
        root = np.sqrt(r)
        n = (1.0 + root) / (1.0 - root) * (1.0 - g) + (1.0 - r) / (1.0 + r) * g
        k = np.sqrt(max((r * (n + 1.0) ** 2 - (n - 1.0) ** 2) / (1.0 - r), 0.0))
        inside = ((n / index - 1.0) ** 2 + (k / index) ** 2) / ((n / index + 1.0) ** 2 + (k / index) ** 2)
        s = 6.0 / 7.0
        inside_dip = (inside + (1.0 - inside) * s**5 - g) * (7.0 / s**6)
        bottom = tinted_metal(np.array([inside]), np.array([inside_dip]), inner)[:, 0]
        phases = _metal_phases(inner, index, n, k)
        parts = [_airy(top[:, p], bottom, path, -top_signs[:, p] * phases[p], channel) for p in (0, 1)]
        result[:, channel] = np.clip(0.5 * (parts[0] + parts[1]), 0.0, 1.0)
    result[inner <= 0.0] = 1.0
    return result


def _metal_phases(cosine: Array, index: float, n: float, k: float) -> tuple[ComplexArray, ComplexArray]:
    """exp(i phase) of light reflected by a metal within a medium of `index`, across and along."""
    squares = n * n - k * k
    a = squares - index * index * (1.0 - cosine * cosine)
    b = 2.0 * n * k
    size = np.sqrt(a * a + b * b)
    u2, v2 = np.maximum(0.5 * (size + a), 0.0), np.maximum(0.5 * (size - a), 0.0)
    u, v = np.sqrt(u2), np.sqrt(v2)
    ic = index * cosine
    across = ic * ic - u2 - v2 - 2j * ic * v
    along = ((n * n + k * k) * cosine) ** 2 - index * index * (u2 + v2)
    along = along + 2j * index * cosine * (b * u - squares * v)
    result = []
    for value in (across, along):
        length = np.abs(value)
        result.append(np.where(length > 0.0, value / np.where(length > 0.0, length, 1.0), 1.0))
    return result[0], result[1]
