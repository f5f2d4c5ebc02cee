# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact radial maps of a few surfaces, and vertices around them: what shaders and references are given alike."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import texel_directions
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, RadialSurface, unit

SURFACES = {"sphere": Ellipsoid(), "ellipsoid": Ellipsoid(1.0, 0.5, 0.25), "bumpy": Bumpy(0.15)}


def radial_map(surface: RadialSurface, resolution: int = 128) -> np.ndarray:
    """Radius and gradient at each texel: (6, resolution, resolution, 4) float32, object space."""
    u = texel_directions(resolution).reshape(-1, 3)
    r, gradient = surface.radius(u)
    return np.column_stack([r, gradient]).reshape(6, resolution, resolution, 4).astype(np.float32)


def vertices_around(surface: RadialSurface, count: int, nearest: float = 1e-2) -> np.ndarray:
    """Outside the surface, from `nearest` to ten radii away: (count, 3), with no more digits than a shader has."""
    rng = np.random.default_rng(7)
    u = unit(rng.normal(size=(count, 3)))
    vertices = u * (surface.radius(u)[0] + 10 ** rng.uniform(np.log10(nearest), 1, count))[:, None]
    return vertices.astype(np.float32).astype(np.float64)
