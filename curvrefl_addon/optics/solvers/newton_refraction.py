# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The method `newton_refraction` in float64: where the surface of glass shows a vertex beyond it.

This is the reference that `newton_refraction.comp.glsl` and `newton_refraction_stragglers.comp.glsl` are held to.

The optical path |E-P| + index |P-V| is stationary at a refraction point, but no more: before the focus of the surface
it is shortest there, behind it longest, and in between a saddle (docs/methods.md). So Newton looks for a zero of the
gradient of any kind, and never accepts a longer gradient. It starts from the last frame's point or from where a sphere
refracts, which is a zero of one function of one angle. What a few steps leave climbs a ladder of other starts.
"""

from __future__ import annotations

import numpy as np

from .. import status
from ..fermat import SurfaceSample, sample, towards_eye
from ..screen import Screen
from ..snell import index_in_range, is_refraction_side, refracted
from ..surfaces.radial_surfaces import Float64Array, RadialSurface, unit
from .descent import minimize
from .refraction_start import RUNG_COUNT, Circle, sphere_guesses, starts_of
from .secant_star import Solution

FIRST_STEPS = 6
"""Of the first pass: on a GPU the slowest vertex of a group holds up the others."""
STEPS = 20
HORIZON_BISECTIONS = 20
FIRST_PASS = -1
"""Rung of what the first pass has solved"""


def last_seen(
    surface: RadialSurface, eye: Float64Array, vertices: Float64Array, index: float, side: float
) -> tuple[Float64Array, np.ndarray]:
    """Of vertices that no search has found: the last direction (n, 3) from the eye's towards the vertex at which a
    line of sight passes the surface, and whether (n,) the vertex is beyond that ray, or before the surface: hidden.

    From inside nothing is hidden but by total reflection, which some line of sight meets where `index` is under 1.
    """
    circle = Circle(eye, vertices)
    low, high = np.zeros(len(vertices)), np.full(len(vertices), np.pi)
    for _ in range(HORIZON_BISECTIONS):
        middle = 0.5 * (low + high)
        passes = np.isfinite(_refracted_at(surface, eye, circle.at(middle), index, side)[1][:, 0])
        low, high = np.where(passes, middle, low), np.where(passes, high, middle)
    u = circle.at(low)
    at, ray = _refracted_at(surface, eye, u, index, side)
    if side < 0.0:
        return u, np.full(len(vertices), index < 1.0)
    way = vertices - at.position
    outward = np.einsum("ij,ij->i", way, at.normal - np.einsum("ij,ij->i", at.normal, ray)[:, None] * ray)
    middle_at = sample(surface, circle.start)
    before = np.einsum("ij,ij->i", middle_at.normal, vertices - middle_at.position) > 0.0
    return u, (outward > 0.0) | before


def _refracted_at(
    surface: RadialSurface, eye: Float64Array, u: Float64Array, index: float, side: float
) -> tuple[SurfaceSample, Float64Array]:
    """The surface at directions (n, 3), and the refracted lines of sight (n, 3); NaN where the eye does not see it."""
    at = sample(surface, u)
    to_eye, normal = towards_eye(eye, at.position), side * at.normal
    sees = np.einsum("ij,ij->i", to_eye, normal) > 0.0
    return at, np.where(sees[:, None], refracted(to_eye, normal, index), np.nan)


def solve(
    surface: RadialSurface,
    screen: Screen,
    vertices: Float64Array,
    index: float,
    previous: Float64Array | None = None,
    tolerance: float = 0.05,
    side: float = 1.0,
    first_steps: int = FIRST_STEPS,
    first_rung: int = 0,
) -> tuple[Solution, np.ndarray]:
    """Refraction points of vertices (n, 3) relative to the star center, and on which rung (n,) each was settled.

    `index` beyond the surface over that on the eye's side; `side` -1 for an eye inside; `tolerance` in pixels;
    `previous` (n, 3) are directions where the vertices were refracted in the last frame, NaN for others. REFLECTED
    means that a refraction point was found; `first_rung` leaves rungs out.

    Raises ValueError for an index that is no number.
    """
    index = index_in_range(index)
    eye, count = screen.eye, len(vertices)
    u = sphere_guesses(surface, eye, vertices, index, side)[0]
    u = np.where(np.isfinite(u), u, unit(side * np.broadcast_to(eye[:3], vertices.shape)))
    if previous is not None:
        u = np.where(np.isfinite(previous), previous, u)
    code = np.full(count, status.UNSOLVED)
    rung = np.full(count, FIRST_PASS)
    u, converged, iterations = minimize(surface, screen, vertices, u, first_steps, tolerance, True, index)
    code[converged & is_refraction_side(eye, vertices, sample(surface, u), side)] = status.REFLECTED

    for number in range(first_rung, RUNG_COUNT):
        left = np.flatnonzero(code == status.UNSOLVED)
        if len(left) == 0:
            break
        starts = starts_of(number, surface, eye, vertices[left], index, side)
        for start in starts:
            rows = np.flatnonzero((code[left] == status.UNSOLVED) & np.isfinite(start[:, 0]))
            here = left[rows]
            end, converged, taken = minimize(
                surface, screen, vertices[here], start[rows], STEPS, tolerance, True, index
            )
            iterations[here] += taken
            found = converged & is_refraction_side(eye, vertices[here], sample(surface, end), side)
            u[here[found]] = end[found]
            code[here[found]], rung[here[found]] = status.REFLECTED, number
    left = np.flatnonzero(code == status.UNSOLVED)
    limit, is_hidden = last_seen(surface, eye, vertices[left], index, side)
    u[left[is_hidden]] = limit[is_hidden]
    code[left[is_hidden]] = status.HIDDEN
    return Solution(u, sample(surface, u), code, iterations), rung
