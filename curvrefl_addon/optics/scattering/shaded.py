# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All that an opaque surface sends to n viewers of the light of lamps, as `lighting/ggx.glsl` and
`lighting/lamps.glsl`, in double precision.

Directions are (n, 3) in a frame whose z is the normal on the viewers' side. Rough layers alone: what is sharp, lamps do
not meet.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .fresnel import fresnel_dielectric
from .layers import layers_of, specular_fresnel
from .material import Material
from .microfacet import reflected_value
from .oren_nayar import oren_nayar_value
from .sheen import sheen_lobe, sheen_value

__all__ = ["shaded_value"]

type Array = NDArray[np.float64]


def shaded_value(m: Material, to_viewer: Array, to_light: Array, table: Array) -> Array:
    """(n, 3) from light to viewer, per solid angle, times the light's cosine; lights may be behind the surface."""
    layers = layers_of(m, False, to_viewer[:, 2], table)
    cos_viewer, cos_light = layers.cos_viewer, to_light[:, 2]
    half = to_viewer + to_light
    half /= np.maximum(np.linalg.norm(half, axis=1, keepdims=True), 1e-12)
    between = np.clip((to_viewer * half).sum(axis=1), 0.0, 1.0)
    value = specular_fresnel(layers, between) * reflected_value(to_viewer, to_light, half, layers.alpha)[:, None]
    coat = layers.coat
    coat_alpha = np.full(2, max(coat.alpha, 1e-4))
    coat_lobe = coat.weight * fresnel_dielectric(between, coat.eta)
    value = value + (coat_lobe * reflected_value(to_viewer, to_light, half, coat_alpha))[:, None]
    through = min(max(m.translucency, 0.0), 1.0)
    lambert = np.maximum(cos_light, 0.0)[:, None] / np.pi
    rough = oren_nayar_value(
        m.base_color, m.diffuse_roughness, cos_viewer, cos_light, (to_viewer * to_light).sum(axis=1)
    )
    base = rough + (lambert - rough) * m.subsurface
    transform, albedo = sheen_lobe(table, m.sheen_roughness, cos_viewer)
    sheen = max(m.sheen_weight, 0.0) * np.maximum(np.array(m.sheen_tint), 0.0) * albedo[:, None]
    fibers = sheen * sheen_value(transform, in_viewers_plane(to_viewer, to_light))[:, None]
    behind = through * layers.base * np.maximum(-cos_light, 0.0)[:, None] / np.pi
    front = value + (1.0 - through) * layers.base * base + fibers
    return np.where(cos_light[:, None] > 0.0, front, 0.0) + behind


def in_viewers_plane(to_viewer: Array, directions: Array) -> Array:
    """(n, 3) in the frames whose x are towards the viewers."""
    along = to_viewer[:, :2] / np.maximum(np.linalg.norm(to_viewer[:, :2], axis=1, keepdims=True), 1e-12)
    x = (directions[:, :2] * along).sum(axis=1)
    y = directions[:, 1] * along[:, 0] - directions[:, 0] * along[:, 1]
    return np.stack([x, y, directions[:, 2]], axis=1)
