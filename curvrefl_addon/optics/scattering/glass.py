# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An interface that lets light through, solid or thin, as `scattering/glass.glsl`, in double precision.

Refraction by a microfacet with normal h takes the viewer's direction v to l with h along -(v + eta l); the Jacobian of
that is eta^2 |l.h| / (v.h + eta l.h)^2, so visible normals become directions of the density
D G1 |v.h| |l.h| eta^2 / (vz (v.h + eta l.h)^2): Walter et al. (2007), eq. 17, 21. Paths carry radiance, of which Cycles
leaves the factor 1 / eta^2 out, as it comes back where light leaves the glass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .film import NO_FILM, film_on_dielectric, film_or_dielectric
from .fresnel import normal_reflectance, refracted_cosine
from .material import PRINCIPLED, REFRACTION, Material
from .microfacet import SHARP_ALPHA, reflected_density
from .tables import average_albedo, glass_albedo, lobe_entry, multiple_scattering

__all__ = ["STRAIGHT_THROUGH", "Pane", "pane_of", "pane_shares", "reflected_chance", "refracted", "refracted_density"]

type Array = NDArray[np.float64]

STRAIGHT_THROUGH = 1e-4
"""Refractive indices this close to 1 bend nothing, as in Cycles"""
SMALLEST_ALPHA = 1e-4


@dataclass(frozen=True, slots=True)
class Pane:
    """The interface towards n viewers."""

    eta: float
    """Index of the far side over that of the near one; of a thin wall that of its inside"""
    alpha: float
    far_alpha: float
    """Width of the lobe on the far side"""
    is_thin: bool
    is_refraction: bool
    """A Refraction BSDF: reflects nothing"""
    is_sharp: bool
    is_far_sharp: bool
    film: float
    """Nanometers"""
    film_ior: float
    """Over that of the near side"""
    f0: Array
    """(3,)"""
    reflected: Array
    """(n, 3) share times tint times multiple scattering; of a thin wall times its reflectance"""
    transmitted: Array
    """(n, 3)"""


def thin_shares(film: tuple[float, float], f0: Array, tint: Array, eta: float, cosine: Array) -> tuple[Array, Array]:
    """(n, 3) reflectance and transmittance of a pane whose inside lets `tint` through along its normal.

    With r of each interface and c = tint^(1 / cos inside) of each way through (Beer's law), the transmitted light is
    the series c (1-r)^2 (1 + (r c)^2 + (r c)^4 + ...), the reflected r + c (1-r)^2 (r c) (1 + (r c)^2 + ...): OpenPBR
    1.1, "Thin-walled case". A `film` (thickness, index) on the outsides reflects another r from within.
    """
    reflects = film_or_dielectric(*film, f0, eta, cosine)
    inside = refracted_cosine(cosine, eta)[:, None]
    within = reflects
    if film[0] > NO_FILM:
        within = film_on_dielectric(film[0], film[1] / eta, f0, 1.0 / eta, inside[:, 0])
    way = np.where(inside > 0.0, np.maximum(tint, 1e-10) ** (1.0 / np.maximum(inside, 1e-10)), 0.0)
    again = within * way
    transmittance = way * (1.0 - reflects) * (1.0 - within) / np.maximum(1.0 - again * again, 1e-6)
    return reflects + transmittance * again, transmittance


def pane_of(m: Material, is_back: bool, cosine: Array, share: Array, table: Array) -> Pane:
    """`cosine`: (n,) of viewers; `share`: (n, 3) of the light that gets to the interface."""
    ior = max(m.ior, 1e-5)
    roughness = min(max(m.roughness, 0.0), 1.0)
    alpha = roughness * roughness
    eta = 1.0 / ior if is_back and not m.thin_wall else ior
    is_sharp = alpha <= SHARP_ALPHA
    is_far_sharp = is_sharp or abs(eta - 1.0) < STRAIGHT_THROUGH
    base, f0 = np.array(m.base_color), np.full(3, normal_reflectance(eta))
    through, off = base, base
    if m.glass == PRINCIPLED:
        through = np.clip(base, 0.0, 1.0) if m.thin_wall else np.sqrt(np.clip(base, 0.0, 1.0))
        off = np.ones(3)
        f0 = np.clip(f0 * np.array(m.specular_tint), 0.0, 1.0)
    far_alpha = alpha
    film = m.film_thickness, m.film_ior / ior if is_back and not m.thin_wall else m.film_ior
    if m.glass == REFRACTION:
        widths = max(alpha, SMALLEST_ALPHA), max(alpha, SMALLEST_ALPHA)
        none = np.zeros_like(share)
        return Pane(eta, *widths, m.thin_wall, True, is_sharp, is_far_sharp, 0.0, 1.0, f0, none, share * base)
    if m.thin_wall:
        reflectance, transmittance = thin_shares(film, f0, through, eta, cosine)
        # As wide as two refractions: Kulla and Conty (2017), page 40.
        far_alpha = min(alpha * np.sqrt(3.4 * max(eta - 1.0, 0.0) * (eta - 0.5) ** 2 / eta**3), 1.0)
        is_far_sharp = far_alpha <= SHARP_ALPHA
        if not is_sharp:
            near = np.maximum(lobe_entry(table, roughness, cosine, 0)[:, 0], 1e-4)
            tint = np.clip(np.array(m.specular_tint), 0.0, 1.0)
            reflectance = reflectance * multiple_scattering(tint, average_albedo(roughness), (1.0 - near) / near)
        if not is_far_sharp:
            far = np.maximum(lobe_entry(table, np.sqrt(far_alpha), cosine, 0)[:, 0], 1e-4)
            transmittance = transmittance / far[:, None]
        reflected, transmitted = share * reflectance, share * transmittance
    else:
        scattering = np.ones((len(cosine), 3))
        if not is_sharp:
            albedo, average = glass_albedo(table, roughness, cosine, eta)
            albedo = np.maximum(albedo, 1e-4)
            scattering = multiple_scattering(np.clip(through, 0.0, 1.0), average, (1.0 - albedo) / albedo)
        reflected = share * off * scattering
        transmitted = share * through * (1.0 if is_far_sharp else scattering)
    widths = max(alpha, SMALLEST_ALPHA), max(far_alpha, SMALLEST_ALPHA)
    return Pane(eta, *widths, m.thin_wall, False, is_sharp, is_far_sharp, *film, f0, reflected, transmitted)


def pane_shares(pane: Pane, cosine: Array) -> tuple[Array, Array]:
    """(n, 3) that a microfacet reflects and transmits, seen at these cosines; of a thin wall every one alike."""
    if pane.is_thin:
        return pane.reflected, pane.transmitted
    if pane.is_refraction:
        return np.zeros_like(pane.transmitted), pane.transmitted * (refracted_cosine(cosine, pane.eta) > 0.0)[:, None]
    fresnel = film_or_dielectric(pane.film, pane.film_ior, pane.f0, pane.eta, cosine)
    return pane.reflected * fresnel, pane.transmitted * (1.0 - fresnel)


def reflected_chance(reflects: Array, transmits: Array) -> Array:
    """(n,) share of samples that a microfacet reflects."""
    reflected, transmitted = reflects.mean(axis=1), transmits.mean(axis=1)
    total = reflected + transmitted
    return np.where(total > 0.0, reflected / np.where(total > 0.0, total, 1.0), 0.0)


def refracted(to_viewer: Array, h: Array, eta: float) -> Array:
    """Where microfacets with normals `h` refract what the viewer sees: Snell's law."""
    cosine = (to_viewer * h).sum(axis=1)
    light = (cosine / eta - refracted_cosine(cosine, eta))[:, None] * h - to_viewer / eta
    return light / np.linalg.norm(light, axis=1, keepdims=True)


def refracted_density(to_viewer: Array, to_light: Array, h: Array, alpha: float, eta: float) -> Array:
    """Density of `refracted` per solid angle, by normals that the viewer sees."""
    cos_viewer, cos_light = (to_viewer * h).sum(axis=1), (to_light * h).sum(axis=1)
    root = cos_viewer + eta * cos_light
    solid_angle = eta * eta * np.abs(cos_viewer * cos_light) / np.maximum(root * root, 1e-20)
    return 4.0 * reflected_density(to_viewer, h, np.array([alpha, alpha]), 1.0) * solid_angle
