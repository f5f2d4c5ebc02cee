# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Safeguarded Newton descent on the optical path length over the sphere of directions.

On a closed convex reflector the reflection of a vertex that can be seen in it is the minimum of the path length E-P-V, so a descent
that never accepts a longer path cannot cycle or wander off. Second derivatives come from differences of the
gradient, because the map holds r and grad r only.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .fermat import path_gradient, sample
from .radial_surfaces import Float64Array, RadialSurface, unit

if TYPE_CHECKING:
    from .secant_star import Screen

DIFFERENCE = 1e-3
"""Angle for second derivatives, radians; shrinks with the distance of a vertex in contact."""
FLATTEST = 1e-5
"""Smallest eigenvalue of the second derivative, relative to the largest, that is not shifted."""
LONGEST_STEP = 0.3
"""Radians"""
HALVINGS = 6
SHORTENING = 0.35


def tangent_frame(u: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Two unit vectors (n, 3) that complete the unit vectors u (n, 3) to right-handed frames."""
    helper = np.where(np.abs(u[:, :1]) < 0.7, np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 1.0, 0.0]]))
    first = unit(np.cross(u, helper))
    return first, np.cross(u, first)


def path_length(eye: Float64Array, vertices: Float64Array, points: Float64Array) -> Float64Array:
    """|E-P| + |P-V| (n,); for an eye at infinity the first term is measured from the plane through the centre."""
    to_eye = np.linalg.norm(eye[:3] - points, axis=1) if eye[3] else -(points @ eye[:3])
    return to_eye + np.linalg.norm(vertices - points, axis=1)


def minimise(
    surface: RadialSurface, screen: Screen, vertices: Float64Array, start: Float64Array, steps: int, tolerance: float
) -> tuple[Float64Array, np.ndarray, np.ndarray]:
    """Descend from `start` (n, 3): directions (n, 3), converged (n,), steps taken (n,).

    Converged means that a Newton step at a point of positive curvature moves less than `tolerance` pixels.
    """
    count = len(vertices)
    u = start.copy()
    converged = np.zeros(count, bool)
    iterations = np.zeros(count, int)
    active = np.arange(count)
    eye = screen.eye

    for _ in range(steps):
        if len(active) == 0:
            break
        here, target = u[active], vertices[active]
        at = sample(surface, here)
        first, second = tangent_frame(here)

        def gradient(
            directions: Float64Array, target: Float64Array = target
        ) -> Float64Array:
            return path_gradient(eye, target, directions, sample(surface, directions))

        def dot(p: Float64Array, q: Float64Array) -> Float64Array:
            return np.einsum("ij,ij->i", p, q)

        g = gradient(here)
        gx, gy = dot(g, first), dot(g, second)
        to_vertex = np.linalg.norm(target - at.position, axis=1)
        delta = DIFFERENCE * np.minimum(1.0, 3.0 * to_vertex / at.radius) + 1e-5
        g_first = gradient(unit(here + delta[:, None] * first))
        g_second = gradient(unit(here + delta[:, None] * second))
        hxx = (dot(g_first, first) - gx) / delta
        hyy = (dot(g_second, second) - gy) / delta
        hxy = 0.5 * ((dot(g_first, second) - gy) + (dot(g_second, first) - gx)) / delta

        middle, spread = 0.5 * (hxx + hyy), np.hypot(0.5 * (hxx - hyy), hxy)
        lowest, highest = middle - spread, middle + spread
        wanted = np.maximum(np.abs(lowest), FLATTEST * np.abs(highest))
        shift = np.maximum(0.0, wanted - lowest)
        determinant = (hxx + shift) * (hyy + shift) - hxy * hxy
        safe = np.where(determinant > 0.0, determinant, np.inf)
        sx = -((hyy + shift) * gx - hxy * gy) / safe
        sy = -((hxx + shift) * gy - hxy * gx) / safe
        length = np.hypot(sx, sy)
        capped = np.minimum(1.0, LONGEST_STEP / np.maximum(length, 1e-30))
        step = (capped * sx)[:, None] * first + (capped * sy)[:, None] * second
        pixels = np.linalg.norm(screen.pixels(at.position, at.radius[:, None] * step), axis=1)
        done = (pixels < tolerance) & (shift == 0.0) & (determinant > 0.0)
        iterations[active] += 1

        before = path_length(eye, target, at.position)
        slope = dot(g, step)
        factor = np.ones(len(active))
        accepted = np.zeros(len(active), bool)
        moved = here.copy()
        for _ in range(HALVINGS):
            trial = unit(here + factor[:, None] * step)
            length_there = path_length(eye, target, sample(surface, trial).position)
            good = ~accepted & (length_there <= before + 1e-4 * factor * slope)
            moved[good] = trial[good]
            accepted |= good
            factor = np.where(accepted, factor, SHORTENING * factor)
            if accepted.all():
                break
        # The last step is below a tolerance already: it is taken even where rounding hides the descent.
        moved[done & ~accepted] = unit(here + step)[done & ~accepted]
        u[active] = moved
        converged[active[done]] = True
        active = active[~done & accepted]
    return u, converged, iterations
