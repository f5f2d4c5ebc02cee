# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Safeguarded Newton descent on the optical path length over the sphere of directions.

On a closed convex reflector the reflection of a vertex that can be seen in it is the minimum of the path length
E-P-V, so a descent that never accepts a longer path cannot cycle or wander off. Second derivatives come from
differences of the gradient, because the map holds r and grad r only.

On a hollow mirror the reflection may also be a maximum or a saddle. There Newton looks for a zero of the gradient of
any kind, and never accepts a longer gradient.
"""

from __future__ import annotations

import numpy as np

from .fermat import SurfaceSample, path_gradient, sample
from .radial_surfaces import Float64Array, RadialSurface, unit
from .screen import Screen

DIFFERENCE = 1e-3
"""Angle for second derivatives, radians; shrinks with the distance of a vertex or an eye in contact."""
SMALLEST_DIFFERENCE = 1e-5
FLATTEST = 1e-5
"""Smallest eigenvalue of the second derivative, relative to the largest, that is not shifted."""
LONGEST_STEP = 0.5
"""Radians"""
LONGEST_LAST_STEP = 0.005
"""Radians: at the silhouette a long step along the line of sight covers few pixels, and leaves more"""
SLACKENED = 0.98
"""A step towards a point of any kind must shrink the gradient at least to this share."""
TRIALS = 6
"""Lengths of one step that are tried"""
SHORTENING = 0.35
SUFFICIENT = 1e-4
"""Share of the predicted descent that a step must keep (Armijo)"""
ROUNDING = 2e-7
"""Path lengths closer than this share of the radius count as equal: float32 cannot tell them apart."""
CONTRACTION = 0.7
"""A step at positive curvature is also taken where it shrinks the gradient to this share. An interpolated map
ripples by some 1e-4 of its radius between texels, which hides the last pixels of descent from the path length."""


def tangent_frame(u: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Two unit vectors (n, 3) that complete the unit vectors u (n, 3) to right-handed frames."""
    helper = np.where(np.abs(u[:, :1]) < 0.7, np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 1.0, 0.0]]))
    first = unit(np.cross(u, helper))
    return first, np.cross(u, first)


def guess(eye: Float64Array, vertices: Float64Array) -> Float64Array:
    """Directions (n, 3) between an eye (4,), or eyes (n, 4), and vertices, nearer to the one that is nearer the centre.

    On the great circle from the eye's direction to the vertex's, at the share d_E / (d_E + d_V).
    """
    eyes = np.broadcast_to(eye, (len(vertices), 4))
    a, b = unit(eyes[:, :3]), unit(vertices)
    distance = np.linalg.norm(eyes[:, :3], axis=1)
    share = np.where(eyes[:, 3] > 0.0, distance / (distance + np.linalg.norm(vertices, axis=1)), 1.0)
    cosine = np.clip(np.einsum("ij,ij->i", a, b), -1.0, 1.0)
    across = b - cosine[:, None] * a
    across = np.where(np.linalg.norm(across, axis=1, keepdims=True) < 1e-6, tangent_frame(a)[0], unit(across))
    angle = (share * np.arccos(cosine))[:, None]
    return np.cos(angle) * a + np.sin(angle) * across


def path_change(eye: Float64Array, vertices: Float64Array, start: Float64Array, end: Float64Array) -> Float64Array:
    """Path length by `end` minus path length by `start` (n,), without subtracting two long lengths.

    |X-Q| - |X-P| = (Q-P).(P+Q-2X) / (|X-P| + |X-Q|); for an eye at infinity the first leg is a projection.
    """
    moved = end - start

    def leg(x: Float64Array) -> Float64Array:
        lengths = np.linalg.norm(x - start, axis=1) + np.linalg.norm(x - end, axis=1)
        return np.einsum("ij,ij->i", moved, start + end - 2.0 * x) / np.maximum(lengths, 1e-30)

    return (leg(eye[:3]) if eye[3] else -(moved @ eye[:3])) + leg(vertices)


def minimise(
    surface: RadialSurface,
    screen: Screen,
    vertices: Float64Array,
    start: Float64Array,
    steps: int,
    tolerance: float,
    any_kind: bool = False,
) -> tuple[Float64Array, np.ndarray, np.ndarray]:
    """Descend from `start` (n, 3): directions (n, 3), converged (n,), steps taken (n,).

    Converged means that a Newton step at a point of positive curvature moves less than `tolerance` pixels. With
    `any_kind` the curvature may be of any sign.
    """
    eye = screen.eye
    u = start.copy()
    converged = np.zeros(len(vertices), bool)
    iterations = np.zeros(len(vertices), int)
    active = np.arange(len(vertices))

    for _ in range(steps):
        if len(active) == 0:
            break
        here, target = u[active], vertices[active]
        at = sample(surface, here)
        g = path_gradient(eye, target, here, at)
        step, regular = _newton_step(surface, eye, target, here, at, g, any_kind)
        pixels = np.linalg.norm(screen.pixels(at.position, at.radius[:, None] * step), axis=1)
        done = (pixels < tolerance) & (np.linalg.norm(step, axis=1) < LONGEST_LAST_STEP) & regular
        iterations[active] += 1

        slope = _dot(g, step)
        length = np.linalg.norm(g, axis=1)
        factor = np.ones(len(active))
        accepted = np.zeros(len(active), bool)
        moved = here.copy()
        for _ in range(TRIALS):
            trial = unit(here + factor[:, None] * step)
            there = sample(surface, trial)
            change = path_change(eye, target, at.position, there.position)
            descends = change <= SUFFICIENT * factor * slope + ROUNDING * at.radius
            shortened = np.linalg.norm(path_gradient(eye, target, trial, there), axis=1)
            contracts = shortened < (SLACKENED if any_kind else CONTRACTION) * length
            good = ~accepted & regular & contracts if any_kind else ~accepted & (descends | (regular & contracts))
            moved[good] = trial[good]
            accepted |= good
            factor = np.where(accepted, factor, SHORTENING * factor)
            if accepted.all():
                break
        # The last step is below the tolerance: where rounding hides its descent the point stays.
        u[active] = moved
        converged[active[done]] = True
        active = active[~done & accepted]
    return u, converged, iterations


def _newton_step(
    surface: RadialSurface,
    eye: Float64Array,
    vertices: Float64Array,
    u: Float64Array,
    at: SurfaceSample,
    g: Float64Array,
    any_kind: bool,
) -> tuple[Float64Array, np.ndarray]:
    """Tangent step (n, 3), and whether the second derivative was positive as it was, without a shift."""
    first, second = tangent_frame(u)
    nearest = np.linalg.norm(vertices - at.position, axis=1)
    if eye[3]:
        nearest = np.minimum(nearest, np.linalg.norm(eye[:3] - at.position, axis=1))
    delta = DIFFERENCE * np.minimum(1.0, 3.0 * nearest / at.radius) + SMALLEST_DIFFERENCE

    def difference(direction: Float64Array) -> Float64Array:
        moved = unit(u + delta[:, None] * direction)
        return (path_gradient(eye, vertices, moved, sample(surface, moved)) - g) / delta[:, None]

    by_first, by_second = difference(first), difference(second)
    gx, gy = _dot(g, first), _dot(g, second)
    hxx, hyy = _dot(by_first, first), _dot(by_second, second)
    hxy = 0.5 * (_dot(by_first, second) + _dot(by_second, first))
    middle, spread = 0.5 * (hxx + hyy), np.hypot(0.5 * (hxx - hyy), hxy)
    lowest, highest = middle - spread, middle + spread
    shift = np.maximum(0.0, np.maximum(np.abs(lowest), FLATTEST * np.abs(highest)) - lowest)
    shift *= not any_kind
    hxx, hyy = hxx + shift, hyy + shift
    determinant = hxx * hyy - hxy * hxy
    solvable = determinant != 0.0 if any_kind else determinant > 0.0
    safe = np.where(solvable, determinant, np.inf)
    sx = -(hyy * gx - hxy * gy) / safe
    sy = -(hxx * gy - hxy * gx) / safe
    capped = np.minimum(1.0, LONGEST_STEP / np.maximum(np.hypot(sx, sy), 1e-30))
    step = (capped * sx)[:, None] * first + (capped * sy)[:, None] * second
    return step, (shift == 0.0) & solvable


def _dot(p: Float64Array, q: Float64Array) -> Float64Array:
    return np.einsum("ij,ij->i", p, q)
