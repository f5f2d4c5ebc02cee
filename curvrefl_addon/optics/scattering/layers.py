# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The layers of a material towards n viewers, as `scattering/layers.glsl`, in double precision.

In the order of Cycles' Principled BSDF (Blender 5.2): sheen over a coat over metal; of what is no metal, glass; of what
is no glass, a dielectric over the diffuse base. Metal and glass take their shares, sheen, coat and dielectric take
their albedo off what is below them, so that a white material reflects all light.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .film import NO_FILM, film_on_dielectric, film_on_metal, film_or_dielectric
from .fresnel import (
    edge_dip,
    leveled_ior,
    mean_dielectric,
    normal_reflectance,
    refracted_cosine,
    tinted_metal,
)
from .glass import SMALLEST_ALPHA, Pane, pane_of
from .material import Material
from .microfacet import SHARP_ALPHA
from .sheen import sheen_lobe
from .tables import average_albedo, lobe_entry, multiple_scattering, slice_of

__all__ = ["Layers", "base_alpha", "coat_of", "layers_of", "specular_fresnel"]

type Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Coat:
    """What is above all else but sheen."""

    weight: Array
    """(n,) share times multiple scattering"""
    alpha: float
    eta: float
    albedo: Array
    """(n,)"""
    passes: Array
    """(n, 3) that gets through it, and through the sheen, to what is below"""


@dataclass(frozen=True, slots=True)
class Layers:
    """Towards n viewers."""

    cos_viewer: Array
    """(n,)"""
    coat: Coat
    alpha: Array
    """(2,) widths of the base's microfacets"""
    is_sharp: bool
    metal: Array
    """(n, 3) share of the metal times its multiple scattering"""
    metal_f0: Array
    metal_dip: Array
    is_constant: bool
    """The metal reflects alike at every angle: a Glossy BSDF"""
    dielectric: Array
    """(n, 3) as `metal`"""
    dielectric_f0: Array
    eta: float
    film: tuple[float, float]
    """Thickness in nanometers, index"""
    specular_albedo: Array
    """(n, 3) of metal and dielectric"""
    glass: Pane | None
    base: Array
    """(n, 3) albedo of the diffuse base"""


def dielectric_albedo(table: Array, roughness: float, cosine: Array, eta: float, f0: Array) -> tuple[Array, Array]:
    """(n, 3) albedo of a dielectric's lobe, and its multiple scattering in parts of the single one."""
    real = normal_reflectance(eta)
    below, between = slice_of(table, eta)
    entry = lobe_entry(table, roughness, cosine, below)
    albedo = np.maximum(entry[:, 0], 1e-4)
    mean_share = min(max((mean_dielectric(eta) - real) / max(1.0 - real, 1e-6), 0.0), 1.0)
    mean = f0 + (1.0 - f0) * mean_share
    scattering = multiple_scattering(mean, average_albedo(roughness), (1.0 - entry[:, 0]) / albedo)
    share = (entry[:, 2] * (1.0 - between) + entry[:, 3] * between)[:, None]
    return entry[:, :1] * scattering * (f0 + (1.0 - f0) * share), scattering


def base_alpha(m: Material) -> Array:
    """(2,) widths along the turned tangent and across it, as Cycles: of a Glossy BSDF otherwise than of the others."""
    alpha = min(max(m.roughness, 0.0), 1.0) ** 2 * np.ones(2)
    if m.glossy_only:
        stretch = 1.0 - min(abs(m.anisotropy), 0.99)
        alpha = alpha * ([1.0 / stretch, stretch] if m.anisotropy < 0.0 else [stretch, 1.0 / stretch])
    else:
        aspect = np.sqrt(1.0 - 0.9 * min(max(m.anisotropy, 0.0), 1.0))
        alpha = alpha * [1.0 / aspect, aspect]
    return np.minimum(alpha, 1.0)


def coat_of(m: Material, cos_viewer: Array, table: Array) -> Coat:
    """Its tint is of light that goes straight through: tint^(1 / cos) within, by Beer's law."""
    weight = max(m.coat_weight, 0.0)
    sheen = max(m.sheen_weight, 0.0) * max(*m.sheen_tint, 0.0) * sheen_lobe(table, m.sheen_roughness, cos_viewer)[1]
    above = np.clip(1.0 - sheen, 0.0, 1.0)
    roughness = min(max(m.coat_roughness, 0.0), 1.0)
    eta = max(m.coat_ior, 1.0)
    f0 = np.full(3, normal_reflectance(eta))
    albedo, scattering = dielectric_albedo(table, roughness, cos_viewer, eta, f0)
    way = 1.0 / np.maximum(refracted_cosine(cos_viewer, eta), 1e-4)
    tint = np.maximum(np.array(m.coat_tint), 1e-10) ** way[:, None]
    share = min(weight, 1.0)
    passes = np.clip(1.0 - weight * albedo[:, :1], 0.0, 1.0) * (1.0 - share + share * tint) * above[:, None]
    reflects = above * weight
    return Coat(reflects * scattering[:, 0], roughness * roughness, eta, reflects * albedo[:, 0], passes)


def layers_of(m: Material, is_back: bool, cos_viewer: Array, table: Array) -> Layers:
    """`cos_viewer`: (n,) to the normal; `table`: `ggx_table()` of renderer/lighting/ggx.py."""
    cosine = np.clip(cos_viewer, 1e-4, 1.0)
    coat = coat_of(m, cosine, table)
    alpha = base_alpha(m)
    roughness = float((alpha[0] * alpha[1]) ** 0.25)
    is_sharp = bool(np.sqrt(alpha[0] * alpha[1]) <= SHARP_ALPHA)
    alpha = np.maximum(alpha, SMALLEST_ALPHA)
    entry = lobe_entry(table, roughness, cosine, 0)
    missing = np.zeros(len(cosine)) if is_sharp else (1.0 - entry[:, 0]) / np.maximum(entry[:, 0], 1e-4)
    average = average_albedo(roughness)
    share, black = coat.passes, np.zeros(3)
    f0 = np.maximum(np.array(m.base_color), 0.0)
    none = np.zeros_like(share)
    if m.glossy_only:
        metal = share * multiple_scattering(np.minimum(f0, 1.0), average, missing)
        albedo = entry[:, :1] * metal * f0
        return Layers(
            cosine, coat, alpha, is_sharp, metal, f0, black, True, none, black, 1.0, (0.0, 1.0), albedo, None, none
        )
    metallic = min(max(m.metallic, 0.0), 1.0)
    f0 = np.minimum(f0, 1.0)
    dip = edge_dip(f0, np.clip(np.array(m.specular_tint), 0.0, 1.0))
    mean_metal = f0 + (1.0 - f0) / 21.0 - dip / 126.0
    metal = share * metallic * multiple_scattering(mean_metal, average, missing)
    film = m.film_thickness, m.film_ior
    has_film = m.film_thickness > NO_FILM
    # (Under a film as a smooth surface, as Cycles.)
    mean = film_on_metal(*film, f0, dip, cosine) if has_film else f0 + (1.0 - f0) * entry[:, 1:2]
    specular_albedo = entry[:, :1] * metal * mean
    share = share * (1.0 - metallic)
    transmission = min(max(m.transmission, 0.0), 1.0)
    glass = pane_of(m, is_back, cosine, share * transmission, table)
    share = share * (1.0 - transmission)
    eta = leveled_ior(max(m.ior, 1e-5), m.specular_level)
    dielectric, dielectric_f0 = none, black
    if metallic < 1.0 and (eta != 1.0 or has_film):
        dielectric_f0 = np.clip(normal_reflectance(eta) * np.array(m.specular_tint), 0.0, 1.0)
        albedo, scattering = dielectric_albedo(table, roughness, cosine, eta, dielectric_f0)
        if has_film:
            albedo = entry[:, :1] * scattering * film_on_dielectric(*film, dielectric_f0, eta, cosine)
        dielectric = share * (1.0 if is_sharp else scattering)
        specular_albedo = specular_albedo + share * albedo
        share = share * np.clip(1.0 - albedo.max(axis=1, keepdims=True), 0.0, 1.0)
    base = share * np.maximum(np.array(m.base_color), 0.0)
    return Layers(
        cosine,
        coat,
        alpha,
        is_sharp,
        metal,
        f0,
        dip,
        False,
        dielectric,
        dielectric_f0,
        eta,
        film,
        specular_albedo,
        glass,
        base,
    )


def specular_fresnel(layers: Layers, cosine: Array) -> Array:
    """(n, 3) reflectance of metal and dielectric at microfacets seen at these cosines."""
    if layers.is_constant:
        return layers.metal * layers.metal_f0
    if layers.film[0] > NO_FILM:
        metal = film_on_metal(*layers.film, layers.metal_f0, layers.metal_dip, cosine)
    else:
        metal = tinted_metal(layers.metal_f0, layers.metal_dip, cosine)
    dielectric = film_or_dielectric(*layers.film, layers.dielectric_f0, layers.eta, cosine)
    return layers.metal * metal + layers.dielectric * dielectric
