# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Looks things up in the table of GGX lobes, as `common/ggx_table.glsl`; what is in it says `renderer/lighting/ggx.py`.

Cosines are (n,), answers (n, 4); in between entries, linear in roughness and cosine.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["average_albedo", "glass_albedo", "lobe_entry", "multiple_scattering", "sheen_entry", "slice_of"]

type Array = NDArray[np.float64]


def _entry(table: Array, roughness: float, column: Array, place: int, first_row: int) -> Array:
    size = table.shape[0] // 4
    x = np.clip(column, 0.0, 1.0) * (size - 1)
    y = min(max(roughness, 0.0), 1.0) * (size - 1)
    left, top = np.minimum(x.astype(int), size - 2), min(int(y), size - 2)
    block = np.asarray(table, np.float64)[first_row : first_row + size, place * size : (place + 1) * size]
    x, y = (x - left)[:, None], y - top
    rows = [block[row, left] * (1.0 - x) + block[row, left + 1] * x for row in (top, top + 1)]
    return rows[0] * (1.0 - y) + rows[1] * y


def slice_of(table: Array, eta: float) -> tuple[int, float]:
    """The slice of an IOR and how far it is towards the next, which has the reflectance along the normal in common."""
    slices = table.shape[1] // (table.shape[0] // 4) - 1
    place = np.sqrt(abs((eta - 1.0) / (eta + 1.0))) * (slices - 1)
    below = min(int(place), slices - 2)
    return below, float(place - below)


def lobe_entry(table: Array, roughness: float, cosine: Array, place: int) -> Array:
    """Entries of reflecting lobes."""
    return _entry(table, roughness, cosine, place, 0)


def sheen_entry(table: Array, roughness: float, cosine: Array) -> Array:
    """Entries of fibers."""
    return _entry(table, roughness, cosine, 0, 3 * (table.shape[0] // 4))


def glass_albedo(table: Array, roughness: float, cosine: Array, eta: float) -> tuple[Array, float]:
    """(n,) albedo of single scattering at an interface that lets light through, and its mean over the hemisphere."""
    size = table.shape[0] // 4
    slices = table.shape[1] // size - 1
    below, between = slice_of(table, eta)
    here, after = (_entry(table, roughness, cosine, place, size) for place in (below, below + 1))
    average = _entry(table, roughness, np.array([(below + between) / (slices - 1)]), slices, size)[0]
    side = 2 if eta < 1.0 else 0
    # (A parabola through three steps.)
    t = between
    albedo = here[:, side] * (2.0 * t - 1.0) * (t - 1.0) + here[:, side + 1] * 4.0 * t * (1.0 - t)
    albedo = albedo + after[:, side] * t * (2.0 * t - 1.0)
    return np.minimum(albedo, 1.0), float(average[side])


def average_albedo(roughness: float) -> float:
    """Mean albedo over the hemisphere of a lobe with Fresnel 1; fitted, as in the shaders."""
    return 1.0 - roughness * roughness * (-0.26747 + roughness * (2.1086 - 1.25199 * roughness))


def multiple_scattering(fresnel: Array | float, average: float, missing: Array) -> Array:
    """(n, 3) or (n, 1): all scattering in parts of the single one.

    Kulla and Conty, "Revisiting Physically Based Shading at Imageworks" (2017): light that has met microfacets of mean
    reflectance f once gets out with probability `average`, else meets another: f^2 a + f^3 a (1 - a) + ... The lobe
    keeps its shape and is scaled (Turquin, "Practical multiple scattering compensation for microfacet models", 2019).
    `missing`: (n,), the share of light that single scattering loses over that it keeps.
    """
    f = np.asarray(fresnel, np.float64).reshape(-1)
    return 1.0 + (f * average / (1.0 - f * (1.0 - average)))[None, :] * missing[:, None]
