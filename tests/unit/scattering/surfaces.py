# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials and directions that tests of `scatter` share."""

from __future__ import annotations

from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.renderer.lighting.ggx import ggx_table
from curvrefl.curvrefl_addon.scene.arrays import Glass, MaterialArrays

TABLE = ggx_table().astype(np.float64)
UP = np.array([0.0, 0.0, 1.0])
EAST = np.array([1.0, 0.0, 0.0])


def material(**fields: Any) -> MaterialArrays:
    return MaterialArrays("of a test", **fields)


MATERIALS = {
    "metal": material(base_color=(0.8, 0.4, 0.1), metallic=1.0, specular_tint=(0.3, 0.9, 0.6)),
    "glossy": material(base_color=(0.8, 0.4, 0.1), glossy_only=True),
    "plastic": material(base_color=(0.8, 0.4, 0.1), specular_tint=(0.3, 0.9, 0.6), specular_level=0.8),
    "half metal": material(base_color=(0.8, 0.4, 0.1), metallic=0.4),
    "glass": material(base_color=(0.8, 0.4, 0.1), transmission=1.0),
    "glass of its own": material(base_color=(0.8, 0.4, 0.1), transmission=1.0, glass=Glass.GLASS, ior=1.9),
    "refraction": material(base_color=(0.8, 0.4, 0.1), transmission=1.0, glass=Glass.REFRACTION),
    "half glass": material(base_color=(0.8, 0.4, 0.1), transmission=0.5, metallic=0.3, ior=0.7),
    "pane": material(base_color=(0.8, 0.4, 0.1), transmission=0.9, thin_wall=True, specular_tint=(0.3, 0.9, 0.6)),
    "lacquer": material(
        base_color=(0.8, 0.4, 0.1), coat_weight=0.8, coat_roughness=0.2, coat_ior=1.8, coat_tint=(0.4, 0.9, 0.6)
    ),
    "brushed": material(base_color=(0.8, 0.4, 0.1), metallic=1.0, anisotropy=0.7, anisotropic_rotation=0.1),
    "brushed glossy": material(base_color=(0.8, 0.4, 0.1), glossy_only=True, anisotropy=-0.6),
    "heated metal": material(
        base_color=(0.8, 0.4, 0.1), metallic=1.0, specular_tint=(0.5, 0.9, 0.6), film_thickness=400.0, film_ior=1.8
    ),
    "soap": material(base_color=(1.0, 1.0, 1.0), transmission=1.0, thin_wall=True, ior=1.1, film_thickness=500.0),
    "filmed glass": material(transmission=0.6, film_thickness=300.0, film_ior=2.0),
    "velvet": material(
        base_color=(0.8, 0.4, 0.1),
        sheen_weight=0.9,
        sheen_roughness=0.3,
        sheen_tint=(0.9, 0.5, 0.7),
        coat_weight=0.5,
        coat_roughness=0.2,
    ),
    "all at once": material(
        base_color=(0.8, 0.4, 0.1),
        metallic=0.3,
        transmission=0.4,
        coat_weight=0.6,
        coat_roughness=0.3,
        anisotropy=0.5,
        alpha=0.7,
        transparent_tint=(0.9, 0.8, 0.7),
    ),
}


def viewer_at(cosine: float, azimuth: float = 0.4) -> np.ndarray:
    sine = np.sqrt(1.0 - cosine * cosine)
    return np.array([sine * np.cos(azimuth), sine * np.sin(azimuth), cosine])


def spread(count: int) -> np.ndarray:
    """(n, 4) numbers that fill the unit cube evenly: the additive sequence of Roberts (2018)."""
    g = 1.1673039782614187
    return (0.5 + np.arange(1, count + 1)[:, None] / g ** np.arange(1.0, 5.0)) % 1.0
