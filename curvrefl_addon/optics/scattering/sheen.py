# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fibers on a surface, as `scattering/sheen.glsl`, in double precision.

Zeltner, Burley and Chiang, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines" (SIGGRAPH Talks
2022): what a layer of fibers reflects towards a viewer is a clamped cosine whose directions are transformed by the
matrix ((1, 0, -b), (0, 1, 0), (0, 0, a)); a, b and the albedo are tabulated over roughness and the viewer's cosine.
Directions are (n, 3) in a frame whose z is the normal and whose x is towards the viewer.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .tables import sheen_entry

__all__ = ["sheen_direction", "sheen_lobe", "sheen_table", "sheen_value"]

type Array = NDArray[np.float64]


@cache
def sheen_table() -> NDArray[np.float32]:
    """(32, 32, 3) over roughness and the viewer's cosine: a, b and the albedo, as they come with Cycles."""
    return np.asarray(np.load(Path(__file__).with_name("sheen_table.npy")), np.float32)


def sheen_lobe(table: Array, roughness: float, cosine: Array) -> tuple[Array, Array]:
    """(n, 2) transform and (n,) albedo of white fibers that cover the surface, towards viewers at these cosines."""
    entry = sheen_entry(table, min(max(roughness, 1e-3), 1.0), cosine)
    is_none = (np.abs(entry[:, 0]) < 1e-5) | (entry[:, 2] < 1e-5)
    return np.where(is_none[:, None], [1.0, 0.0], entry[:, :2]), np.where(is_none, 0.0, entry[:, 2])


def sheen_value(transform: Array, light: Array) -> Array:
    """(n,) the share of the albedo that goes to directions, per solid angle, times their cosines."""
    a, b = transform[:, 0], transform[:, 1]
    length = (a * light[:, 0] + b * light[:, 2]) ** 2 + (a * light[:, 1]) ** 2 + light[:, 2] ** 2
    share = a / np.maximum(length, 1e-12)
    return np.maximum(light[:, 2], 0.0) * share * share / np.pi


def sheen_direction(transform: Array, disk: Array) -> Array:
    """(n, 3) where the lobe sends what the undistorted cosine sends to (n, 2) places of the unit disk."""
    up = np.sqrt(np.maximum(1.0 - (disk * disk).sum(axis=1), 0.0))
    way = np.stack([disk[:, 0] - up * transform[:, 1], disk[:, 1], up * transform[:, 0]], axis=1)
    return way / np.linalg.norm(way, axis=1, keepdims=True)
