# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a surface does to a path that meets it, as `paths/scatter.glsl`, in double precision.

One decision for each of n samples by four random numbers: the fourth says whether anything is there (alpha), the third
chooses a layer by its albedo, and in glass whether it reflects; the first two a microfacet. A rough sample's weight is
the value of *all* rough lobes at its direction over the density with which *any* layer would have chosen it (Veach and
Guibas, "Optimally Combining Sampling Techniques", 1995, the balance heuristic in one sample), a sharp one's the lobe's
share over the layer's chance. The diffuse base takes no part.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .fresnel import fresnel_dielectric
from .glass import STRAIGHT_THROUGH, Pane, pane_shares, reflected_chance, refracted, refracted_density
from .layers import Layers, coat_of, layers_of, specular_fresnel
from .material import Material
from .microfacet import (
    SHARP_ALPHA,
    cap_bound,
    reflected,
    reflected_density,
    reflected_value,
    shadowing,
    surface_frame,
    visible_normal,
)

__all__ = ["ENDS", "PASSES", "REFLECTS", "TRANSMITS", "Scatter", "base_share", "coat_passes", "scatter", "scattered"]

type Array = NDArray[np.float64]

ENDS, REFLECTS, TRANSMITS, PASSES = 0, 1, 2, 3
"""Kinds of decisions"""


@dataclass(frozen=True, slots=True)
class Scatter:
    """Of n samples."""

    direction: Array
    """(n, 3) unit"""
    weight: Array
    """(n, 3) that throughput is multiplied by"""
    pdf: Array
    """(n,) per solid angle; 0 of sharp lobes"""
    kind: NDArray[np.int64]


def _frame(m: Material, normal: Array, tangent: Array) -> Array:
    frame = surface_frame(normal, tangent)
    turn = 2.0 * np.pi * m.anisotropic_rotation
    x = frame[:, 0] * np.cos(turn) + frame[:, 1] * np.sin(turn)
    return np.stack([x, np.cross(normal, x), normal], axis=1)


def _viewer_in(frame: Array, to_viewer: Array) -> Array:
    local = to_viewer @ frame
    local[:, 2] = np.maximum(local[:, 2], 1e-4)
    return local / np.linalg.norm(local, axis=1, keepdims=True)


def _middle(first: Array, second: Array) -> Array:
    """Unit, the normal where they are opposite."""
    h = first + second
    length = np.linalg.norm(h, axis=1, keepdims=True)
    return np.where(length > 1e-150, h / np.maximum(length, 1e-150), [0.0, 0.0, 1.0])


def layer_chances(layers: Layers) -> Array:
    """(n, 3): of the coat, of metal and dielectric, of glass."""
    shares = np.zeros((len(layers.cos_viewer), 3))
    shares[:, 0] = layers.coat.albedo
    shares[:, 1] = layers.specular_albedo.mean(axis=1)
    if layers.glass is not None:
        shares[:, 2] = (layers.glass.reflected + layers.glass.transmitted).mean(axis=1)
    total = shares.sum(axis=1, keepdims=True)
    return np.where(total > 0.0, shares / np.where(total > 0.0, total, 1.0), 0.0)


def _rough_lobes(layers: Layers, chances: Array, viewer: Array, light: Array, bent: Array) -> tuple[Array, Array]:
    """(n, 3) values of all rough lobes times the cosine to the light, and (n,) their density.

    `bent`: (n, 3) normals that refract from one to the other, where the light is on the far side.
    """
    value, pdf = np.zeros((len(viewer), 3)), np.zeros(len(viewer))
    above = light[:, 2] > 0.0
    h = _middle(viewer, light)
    cosine = np.clip((viewer * h).sum(axis=1), 0.0, 1.0)

    def add(where: NDArray[np.bool_], chance: Array, fresnel: Array, alpha: Array, bound: Array | float) -> None:
        nonlocal value, pdf
        pdf = pdf + np.where(where, chance * reflected_density(viewer, h, alpha, bound), 0.0)
        lobe = fresnel * reflected_value(viewer, light, h, alpha)[:, None]
        value = value + np.where(where[:, None], lobe, 0.0)

    coat, glass = layers.coat, layers.glass
    if coat.alpha > SHARP_ALPHA:
        alpha = np.full(2, coat.alpha)
        fresnel = (coat.weight * fresnel_dielectric(cosine, coat.eta))[:, None]
        add(above & (chances[:, 0] > 0.0), chances[:, 0], fresnel, alpha, cap_bound(viewer, alpha))
    if not layers.is_sharp:
        bound = cap_bound(viewer, layers.alpha)
        add(above & (chances[:, 1] > 0.0), chances[:, 1], specular_fresnel(layers, cosine), layers.alpha, bound)
    if glass is not None and not glass.is_sharp:
        alpha = np.full(2, glass.alpha)
        reflects, transmits = pane_shares(glass, cosine)
        chance = chances[:, 2] * reflected_chance(reflects, transmits)
        add(above & (chances[:, 2] > 0.0), chance, reflects, alpha, cap_bound(viewer, alpha) if glass.is_thin else 1.0)
    if glass is not None and not glass.is_far_sharp:
        density, lobe = _far_lobe(glass, viewer, light, bent)
        far = (light[:, 2] < 0.0) & (chances[:, 2] > 0.0)
        pdf = pdf + np.where(far, chances[:, 2] * density, 0.0)
        value = value + np.where(far[:, None], lobe, 0.0)
    return value, pdf


def _far_lobe(glass: Pane, viewer: Array, light: Array, bent: Array) -> tuple[Array, Array]:
    """(n,) density and (n, 3) value of what goes to the far side."""
    alpha = np.full(2, glass.far_alpha)
    if glass.is_thin:
        # The reflected lobe, turned through the wall.
        turned = light * [1.0, 1.0, -1.0]
        h = _middle(viewer, turned)
        density = reflected_density(viewer, h, alpha, cap_bound(viewer, alpha))
        lobe = reflected_value(viewer, turned, h, alpha)
    else:
        h = bent
        faces = ((viewer * h).sum(axis=1) > 0.0) & ((light * h).sum(axis=1) < 0.0)
        density = np.where(faces, refracted_density(viewer, light, h, glass.far_alpha, glass.eta), 0.0)
        lobe = density * shadowing(viewer, light, alpha)
    reflects, transmits = pane_shares(glass, np.clip((viewer * h).sum(axis=1), 0.0, 1.0))
    return density * (1.0 - reflected_chance(reflects, transmits)), transmits * lobe[:, None]


def scatter(
    m: Material, normal: Array, tangent: Array, is_back: bool, to_viewer: Array, random: Array, table: Array
) -> Scatter:
    """`normal`, `tangent`: (3,) unit, the normal on the viewers' side; `to_viewer`: (n, 3); `random`: (n, 4).

    `table`: `ggx_table()` of renderer/lighting/ggx.py.
    """
    count = len(to_viewer)
    layers = layers_of(m, is_back, to_viewer @ normal, table)
    chances = layer_chances(layers)
    frame = _frame(m, normal, tangent)
    viewer = _viewer_in(frame, to_viewer)
    up = np.tile([0.0, 0.0, 1.0], (count, 1))
    mirrored = 2.0 * (to_viewer @ normal)[:, None] * normal - to_viewer
    # What the layers below answer: the light's direction, sharp samples and their direction, weight; refracted by.
    light, direction = np.zeros((count, 3)), mirrored.copy()
    weight, bent = np.zeros((count, 3)), up.copy()
    kind = np.full(count, REFLECTS)
    in_coat = random[:, 2] < chances[:, 0]
    in_glass = ~in_coat & (random[:, 2] >= 1.0 - chances[:, 2])
    in_specular = ~in_coat & ~in_glass
    is_sharp = np.full(count, layers.is_sharp)

    coat = layers.coat
    is_sharp[in_coat] = coat.alpha <= SHARP_ALPHA
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = coat.weight * fresnel_dielectric(layers.cos_viewer, coat.eta) / chances[:, 0]
        weight[in_coat] = shares[in_coat, None]
        weight[in_specular] = (specular_fresnel(layers, layers.cos_viewer) / chances[:, 1:2])[in_specular]
    for where, alpha in ((in_coat, np.full(2, max(coat.alpha, 1e-4))), (in_specular, layers.alpha)):
        h = visible_normal(viewer, alpha, cap_bound(viewer, alpha), random[:, :2])
        light[where] = reflected(viewer, h)[where]

    if (glass := layers.glass) is not None and in_glass.any():
        choice = (random[:, 2] - (1.0 - chances[:, 2])) / np.maximum(chances[:, 2], 1e-300)
        near, far = (np.full(2, alpha) for alpha in (glass.alpha, glass.far_alpha))
        h = up if glass.is_sharp or glass.is_thin else visible_normal(viewer, near, 1.0, random[:, :2])
        reflects, transmits = pane_shares(glass, np.clip((viewer * h).sum(axis=1), 0.0, 1.0))
        chance = reflected_chance(reflects, transmits)
        goes_off, goes_in = in_glass & (choice < chance), in_glass & (choice >= chance)
        kind[goes_in] = TRANSMITS
        is_sharp[goes_off], is_sharp[goes_in] = glass.is_sharp, glass.is_far_sharp
        off = reflects / (chances[:, 2] * np.maximum(chance, 1e-12))[:, None].clip(1e-300)
        through = transmits / (chances[:, 2] * np.maximum(1.0 - chance, 1e-12))[:, None].clip(1e-300)
        weight[goes_off], weight[goes_in] = off[goes_off], through[goes_in]
        if glass.is_thin:
            h = visible_normal(viewer, near, cap_bound(viewer, near), random[:, :2])
            light[goes_off] = reflected(viewer, h)[goes_off]
            h = visible_normal(viewer, far, cap_bound(viewer, far), random[:, :2])
            light[goes_in] = (reflected(viewer, h) * [1.0, 1.0, -1.0])[goes_in]
        else:
            light[goes_off] = reflected(viewer, h)[goes_off]
            light[goes_in] = refracted(viewer, h, glass.eta)[goes_in]
            bent[goes_in] = h[goes_in]
        is_straight = glass.is_thin or abs(glass.eta - 1.0) < STRAIGHT_THROUGH
        straight = -to_viewer if is_straight else refracted(to_viewer, np.tile(normal, (count, 1)), glass.eta)
        direction[goes_in] = straight[goes_in]

    value, pdf = _rough_lobes(layers, chances, viewer, light, bent)
    rough = ~is_sharp & (pdf > 0.0) & ((light[:, 2] > 0.0) == (kind == REFLECTS))
    weight = np.where(
        is_sharp[:, None], weight, np.where(rough[:, None], value / np.where(rough, pdf, 1.0)[:, None], 0.0)
    )
    direction = np.where(is_sharp[:, None], direction, light @ frame.T)
    pdf = np.where(is_sharp, 0.0, pdf)
    largest = weight.max(axis=1)
    ends = ~((largest > 0.0) & (largest < 1e30))
    passes = random[:, 3] >= min(max(m.alpha, 0.0), 1.0)
    direction = np.where((ends | passes)[:, None], -to_viewer, direction)
    weight = np.where(passes[:, None], np.array(m.transparent_tint), np.where(ends[:, None], 0.0, weight))
    pdf = np.where(ends | passes, 0.0, pdf)
    return Scatter(direction, weight, pdf, np.where(passes, PASSES, np.where(ends, ENDS, kind)))


def scattered(
    m: Material, normal: Array, tangent: Array, is_back: bool, to_viewer: Array, to_light: Array, table: Array
) -> tuple[Array, Array]:
    """(n, 3) value of the rough lobes that `scatter` chooses among times the cosine to the light, and (n,) its pdf."""
    layers = layers_of(m, is_back, to_viewer @ normal, table)
    frame = _frame(m, normal, tangent)
    viewer, light = _viewer_in(frame, to_viewer), to_light @ frame
    bent = np.tile([0.0, 0.0, 1.0], (len(light), 1))
    if layers.glass is not None:
        bent = _middle(viewer, layers.glass.eta * light)
        bent = np.where(bent[:, 2:] < 0.0, -bent, bent)
    return _rough_lobes(layers, layer_chances(layers), viewer, light, bent)


def base_share(m: Material, is_back: bool, cos_viewer: Array, table: Array) -> Array:
    """(n, 3) albedo of the diffuse base under all lobes."""
    return layers_of(m, is_back, cos_viewer, table).base


def coat_passes(m: Material, cos_viewer: Array, table: Array) -> Array:
    """(n, 3) that the coat lets through of what is below it, as of emission."""
    return coat_of(m, np.clip(cos_viewer, 1e-4, 1.0), table).passes
