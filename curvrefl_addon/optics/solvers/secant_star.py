# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The secant method of Roger & Holzschuch 2006 (section 3.3) on a star-shaped reflector, in float64.

This is the reference that `secant_star.comp.glsl` is held to; both follow the same steps in the same order.

Three directions A, B, C carry gradients a, b, c of the path length. Each step takes the barycentric least-squares zero
of the linearly interpolated gradient as new direction D, discards the direction with the largest gradient, and
stops when the triangle's area on screen falls under a pixel's share. A small determinant brings back the direction
discarded last (section 3.3.3).

Two things go beyond the paper, because the search alone leaves 4 to 48 percent of the vertices off by half a pixel
when contact and grazing are included (`tools/measure/measure_solver.py`):

* a step longer than `LONGEST_STEP` radians is shortened, so that an extrapolation cannot leave for the far side;
* the end of the search is checked and polished by `descent.minimize`: Newton steps on the path length with second
  derivatives by differences of the same gradient. It takes one step where the secant search was right, and finds the
  point where it was not. Where it fails it begins once more between eye and vertex (`descent.guess`); what that cannot
  solve stays unsolved.

A vertex that ends on the far side, or unsolved, is hidden if the segment from the eye to it pierces the reflector
(`pierce`); the point where it does places it for the triangles that cross the horizon.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import status
from ..fermat import SurfaceSample, is_reflection_side, mirror_error, path_gradient, sample
from ..screen import Screen
from ..surfaces.radial_surfaces import Float64Array, RadialSurface, unit
from .descent import guess, minimize, tangent_frame
from .pierce import pierce

SMALL_DETERMINANT = 1e-5
"""Relative to a'^2 b'^2: gradient differences closer to parallel than about 0.2 degrees are ill-conditioned."""
LONGEST_STEP = 0.7
"""Radians on the sphere of directions."""
SEARCH_TOLERANCE = 1.0
"""Pixels: the paper's stop, a projected triangle smaller than a pixel"""
SEARCH_STEPS = 4
"""A search that takes longer is wandering; the descent takes over."""
NEWTON_STEPS = 20
SMALLEST_START = 0.01
"""Half the start edge AB in radians where A and B (nearly) coincide."""


@dataclass(frozen=True)
class Solution:
    """Result of a solve for n vertices, relative to the star center."""

    u: Float64Array
    """(n, 3) direction of the reflection point"""
    at: SurfaceSample
    status: np.ndarray
    """(n,) codes of `status`; never REFLECTED without both sign tests"""
    iterations: np.ndarray
    """(n,) secant steps plus Newton steps"""


def start_triangle(eye: Float64Array, vertices: Float64Array) -> Float64Array:
    """Start directions (n, 3, 3): A towards the vertex, B towards the eye, C equilateral (section 3.3.4)."""
    a = unit(vertices)
    b = unit(np.broadcast_to(eye[:3], vertices.shape))
    across = np.cross(a, b)
    in_line = np.linalg.norm(across, axis=1) < 1e-3
    across = np.where(in_line[:, None], tangent_frame(a)[0], unit(across))
    # Half way on the great circle; `across` leads the way where A and B are opposite.
    middle = unit(a + b + 1e-6 * tangent_frame(a)[1])
    middle = unit(middle - np.einsum("ij,ij->i", middle, across)[:, None] * across)
    half = 0.5 * np.linalg.norm(a - b, axis=1)
    tiny = (half < SMALLEST_START)[:, None]
    along = np.cross(across, middle)
    a = np.where(tiny, unit(middle + SMALLEST_START * along), a)
    b = np.where(tiny, unit(middle - SMALLEST_START * along), b)
    c = unit(middle + np.sqrt(3.0) * np.clip(half, SMALLEST_START, 0.6)[:, None] * across)
    return np.stack([a, b, c], axis=1)


def secant_search(
    surface: RadialSurface, screen: Screen, vertices: Float64Array, steps: int, tolerance: float, side: float = 1.0
) -> tuple[Float64Array, np.ndarray]:
    """The paper's search: best direction (n, 3) and number of steps (n,); `tolerance` in pixels."""
    count = len(vertices)
    u = start_triangle(screen.eye, vertices)
    if side < 0.0:
        u = _on_hollow_side(surface, screen.eye, vertices, u)

    def gradient(directions: Float64Array, rows: np.ndarray) -> Float64Array:
        return path_gradient(screen.eye, vertices[rows], directions, sample(surface, directions))

    everything = np.arange(count)
    g = np.stack([gradient(u[:, k], everything) for k in range(3)], axis=1)
    discarded_u, discarded_g = np.zeros((count, 3)), np.zeros((count, 3))
    has_discarded = np.zeros(count, bool)
    newest = np.full(count, -1)
    best_u = u[:, 0].copy()
    iterations = np.zeros(count, int)
    active = everything

    for _ in range(steps):
        if len(active) == 0:
            break
        alpha, beta, ill = _least_squares(g[active])
        back = active[ill & has_discarded[active]]
        if len(back):
            # The point that came back must not be the newest again, or the search would never end.
            norm = np.linalg.norm(g[back], axis=2)
            rows = np.arange(len(back))
            norm[rows[newest[back] >= 0], newest[back][newest[back] >= 0]] = -1.0
            worst = norm.argmax(axis=1)
            u[back, worst], g[back, worst] = discarded_u[back], discarded_g[back]
            has_discarded[back] = False
            alpha, beta, _ = _least_squares(g[active])
        corners, norm = u[active], np.linalg.norm(g[active], axis=2)
        rows = np.arange(len(active))
        nearest = corners[rows, norm.argmin(axis=1)]
        weights = np.stack([alpha, beta, 1.0 - alpha - beta], axis=1)
        move = np.einsum("ij,ijk->ik", weights, corners) - nearest
        length = np.linalg.norm(move, axis=1)
        move *= np.minimum(1.0, LONGEST_STEP / np.maximum(length, 1e-30))[:, None]
        d = unit(nearest + move)
        gradient_d = gradient(d, active)
        iterations[active] += 1

        largest = norm.argmax(axis=1)
        discarded_u[active], discarded_g[active] = corners[rows, largest], g[active, largest]
        has_discarded[active] = True
        newest[active] = largest
        u[active, largest], g[active, largest] = d, gradient_d
        better = np.linalg.norm(gradient_d, axis=1) <= norm.min(axis=1)
        best_u[active] = np.where(better[:, None], d, nearest)

        at = sample(surface, d)
        shape = u[active]
        radius = at.radius[:, None]
        edge_1 = screen.pixels(at.position, radius * (shape[:, 1] - shape[:, 0]))
        edge_2 = screen.pixels(at.position, radius * (shape[:, 2] - shape[:, 0]))
        area = 0.5 * np.linalg.norm(np.cross(edge_1, edge_2), axis=1)
        moved = np.linalg.norm(screen.pixels(at.position, radius * (d - nearest)), axis=1)
        done = (area < tolerance**2) & (moved < tolerance)
        active = active[~done]
    return best_u, iterations


def solve(
    surface: RadialSurface,
    screen: Screen,
    vertices: Float64Array,
    steps: int = SEARCH_STEPS,
    newton_steps: int = NEWTON_STEPS,
    tolerance: float = 0.05,
    side: float = 1.0,
) -> Solution:
    """Reflection points of vertices (n, 3) relative to the star center; `tolerance` in pixels.

    `side` is -1 for a mirror that is hollow towards the eye. Such a one is open, so that nothing is said of what the
    way from the eye pierces.
    """
    hollow = side < 0.0
    u, iterations = secant_search(surface, screen, vertices, steps, SEARCH_TOLERANCE, side)
    u, converged, polished = minimize(surface, screen, vertices, u, newton_steps, tolerance, hollow)
    iterations += polished
    reflected = converged & is_reflection_side(screen.eye, vertices, sample(surface, u), side)

    left = np.flatnonzero(~reflected)
    pierced, point = pierce(surface, screen.eye, vertices[left])
    pierced &= not hollow
    hidden = np.zeros(len(vertices), bool)
    hidden[left] = pierced | converged[left]
    u[left[pierced]] = unit(point[pierced])

    left = np.flatnonzero(~reflected & ~hidden)
    if len(left):
        start = guess(screen.eye, vertices[left])
        if hollow:
            start = _on_hollow_side(surface, screen.eye, vertices[left], start[:, None])[:, 0]
        u[left], converged[left], polished = minimize(
            surface, screen, vertices[left], start, newton_steps, tolerance, hollow
        )
        iterations[left] += polished
        right = is_reflection_side(screen.eye, vertices[left], sample(surface, u[left]), side)
        reflected[left] = converged[left] & right
        hidden[left] = converged[left] & ~right
    code = np.select([reflected, hidden], [status.REFLECTED, status.HIDDEN], status.UNSOLVED)
    return Solution(u, sample(surface, u), code, iterations)


def _on_hollow_side(surface: RadialSurface, eye: Float64Array, vertices: Float64Array, u: Float64Array) -> Float64Array:
    """Start directions (n, k, 3), or their opposites where a hollow mirror reflects better there."""
    middle = unit(u.mean(axis=1))
    ahead, behind = (mirror_error(eye, vertices, sample(surface, sign * middle)) for sign in (1.0, -1.0))
    # The angle to the inward normal is the supplement.
    return np.where((behind > ahead)[:, None, None], -u, u)


def _least_squares(g: Float64Array) -> tuple[Float64Array, Float64Array, np.ndarray]:
    """Weights (alpha, beta) of A and B that minimize the interpolated gradient of g (n, 3, 3), and where that is
    ill-conditioned."""
    a, b, c = g[:, 0] - g[:, 2], g[:, 1] - g[:, 2], g[:, 2]
    aa, bb, ab = (np.einsum("ij,ij->i", p, q) for p, q in ((a, a), (b, b), (a, b)))
    ac, bc = np.einsum("ij,ij->i", a, c), np.einsum("ij,ij->i", b, c)
    determinant = aa * bb - ab * ab
    ill = determinant <= SMALL_DETERMINANT * aa * bb
    safe = np.where(determinant > 1e-12 * aa * bb, determinant, np.inf)
    return (ab * bc - bb * ac) / safe, (ab * ac - aa * bc) / safe, ill
