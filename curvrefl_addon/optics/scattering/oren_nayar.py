# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough diffuse surface, as `scattering/oren_nayar.glsl`, in double precision.

Fujii's form (2012) of Oren and Nayar, "Generalization of Lambert's Reflectance Model" (SIGGRAPH 1994), which loses
light, and what scatters more than once as in OpenPBR: light that single scattering leaves over comes out evenly, with
the color of its further bounces; so a white surface reflects all light. Cosines are (n,), values (n, 3) over the
surface's color.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["oren_nayar_albedo", "oren_nayar_share", "oren_nayar_tilt", "oren_nayar_value"]

type Array = NDArray[np.float64]

MEAN_SHARE = (2.0 * np.pi - 5.6) / 3.0
"""Mean over the hemisphere of `oren_nayar_share`, as Cycles has it"""


def oren_nayar_share(cosine: Array) -> Array:
    """Albedo of the part that goes back to where the light comes from."""
    c = np.clip(cosine, 1e-6, 1.0)
    sine = np.sqrt(np.maximum(1.0 - c * c, 0.0))
    share = sine * (np.arccos(c) - 2.0 / 3.0 - sine * c) + 2.0 / 3.0 * (sine / c) * (1.0 - sine**3)
    return np.where(cosine < 1e-6, 0.5 * np.pi - 2.0 / 3.0 - cosine, share)


def _parts(color: tuple[float, float, float], roughness: float, cos_viewer: Array) -> tuple[float, float, Array, float]:
    """Even part, rough part, (n, 3) what scatters more than once, and the mean albedo of single scattering."""
    sigma = min(max(roughness, 0.0), 1.0)
    level = 1.0 / (np.pi + sigma * (0.5 * np.pi - 2.0 / 3.0))
    rough = sigma * level
    albedo = np.clip(np.array(color), 0.0, 1.0)
    mean = level * np.pi + MEAN_SHARE * rough
    once = level * np.pi + rough * oren_nayar_share(np.maximum(cos_viewer, 0.0))
    again = albedo * albedo * mean / (np.pi * max(1.0 - mean, 1e-6)) / (1.0 - albedo * (1.0 - mean))
    return level, rough, again[None, :] * (1.0 - once)[:, None] * (sigma >= 1e-5), mean


def oren_nayar_value(
    color: tuple[float, float, float], roughness: float, cos_viewer: Array, cos_light: Array, cos_between: Array
) -> Array:
    """From light to viewer, per solid angle, times the light's cosine. `cos_between`: of the angle between both."""
    level, rough, again, _ = _parts(color, roughness, cos_viewer)
    light, viewer = np.maximum(cos_light, 0.0), np.maximum(cos_viewer, 0.0)
    back = cos_between - light * viewer
    back = np.where(back > 0.0, back / np.maximum(np.maximum(light, viewer), 1e-6), back)
    once = level * np.pi + rough * oren_nayar_share(light)
    return light[:, None] * ((level + rough * back)[:, None] + again * (1.0 - once)[:, None])


def oren_nayar_albedo(color: tuple[float, float, float], roughness: float, cos_viewer: Array) -> Array:
    """What the surface shows in an evenly lit room."""
    level, rough, again, mean = _parts(color, roughness, cos_viewer)
    once = level * np.pi + rough * oren_nayar_share(np.maximum(cos_viewer, 0.0))
    return once[:, None] + again * (np.pi * (1.0 - mean))


def oren_nayar_tilt(color: tuple[float, float, float], roughness: float, cos_viewer: Array) -> Array:
    """(n, 2) mean direction of what the surface shows: its part towards the viewer along the surface, and along the
    normal; a vector that is 2/3 of the albedo long for an even surface.

    The rough part's own was integrated: along the surface it is a polynomial, along the normal it is fitted to 1e-4.
    """
    level, rough, again, _ = _parts(color, roughness, cos_viewer)
    c = np.clip(cos_viewer, 0.0, 1.0)
    sine = np.sqrt(1.0 - c * c)
    along = np.pi / 24.0 * sine * (11.0 - 6.0 * c + c**3)
    up = sine * (0.274037 + c * (-0.002556 + c * (-0.314822 + c * (-0.045698 + c * 0.088027))))
    twice = 2.0 / 3.0 * np.pi * (1.0 - level * np.pi) - rough * 0.321012
    return np.stack([rough * along, level * np.pi * 2.0 / 3.0 + rough * up + again.mean(axis=1) * twice], axis=1)
