# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""More images of a vertex on a mirror that bends both ways: one in each region of its own curvature, in float64.

This is the reference that `newton_region.comp.glsl` is held to.
"""

from __future__ import annotations

import numpy as np

from .. import status
from ..fermat import is_reflection_side, mirror_error, sample
from ..screen import Screen
from ..surfaces.curvature_regions import Regions
from ..surfaces.radial_surfaces import Float64Array, RadialSurface, unit
from .descent import minimize
from .secant_star import Solution

STARTS = 2
"""Seeds of a region that searches start from"""
STEPS = 12
MARCH_STEPS = 24
INSIDE = 1e-3
"""Share of the radius that a point must be under the surface to block the way"""


def solve_region(
    surface: RadialSurface,
    screen: Screen,
    vertices: Float64Array,
    regions: Regions,
    region: int,
    tolerance: float = 0.05,
) -> Solution:
    """An image of vertices (n, 3) in one region of a closed mirror; UNSOLVED where it has none, or none is found.

    Of the region's seeds those whose bisectors are nearest to the normal start searches for zeros of the gradient of
    any kind. What ends in the region, seen from its front by eye and vertex, with nothing in the way, is an image.
    """
    count, eye = len(vertices), screen.eye
    seeds = regions.seeds[region]
    errors = np.stack(
        [mirror_error(eye, vertices, sample(surface, np.tile(seed, (count, 1)))) for seed in seeds], axis=1
    )
    order = np.argsort(errors, axis=1, kind="stable")
    u = seeds[order[:, 0]].copy()
    code = np.full(count, status.UNSOLVED)
    iterations = np.zeros(count, int)
    for number in range(STARTS):
        left = np.flatnonzero(code == status.UNSOLVED)
        end, found, taken = minimize(
            surface, screen, vertices[left], seeds[order[left, number]], STEPS, tolerance, True
        )
        iterations[left] += taken
        at = sample(surface, end)
        found &= is_reflection_side(eye, vertices[left], at) & regions.holds(region, end)
        found &= is_way_free(surface, at.position, vertices[left] - at.position)
        found &= is_way_free(surface, at.position, eye[:3] - eye[3] * at.position)
        u[left[found]], code[left[found]] = end[found], status.REFLECTED
    return Solution(u, sample(surface, u), code, iterations)


def is_way_free(surface: RadialSurface, points: Float64Array, ways: Float64Array) -> np.ndarray:
    """(n,) whether nothing of the mirror is in the way from points (n, 3) of it along `ways` (n, 3).

    Marched in steps that grow from P, at most through the bounding ball: a fold thinner than a step is not found.
    """
    length = np.linalg.norm(ways, axis=1)
    through = np.minimum(length, 2.0 * surface.bound)[:, None] * unit(ways)
    free = np.ones(len(points), bool)
    for step in range(1, MARCH_STEPS + 1):
        here = points + (step / MARCH_STEPS) ** 2 * through
        distance = np.linalg.norm(here, axis=1)
        here[distance == 0.0] = (0.0, 0.0, 1.0)
        free &= distance >= (1.0 - INSIDE) * surface.radius(unit(here))[0]
    return free
