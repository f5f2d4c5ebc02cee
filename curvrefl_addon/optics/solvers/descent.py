# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Safeguarded Newton descent on the optical path length over the sphere of directions.

The shortest way E-P-V over a closed star-shaped mirror is a reflection that can be seen, or the straight segment where
the mirror hides the vertex (docs/methods.md, `newton`). So a descent that never accepts a longer path cannot cycle or
wander off. Second derivatives of the two legs are exact; only those of r come from differences of the map's gradient.

On a hollow mirror the reflection may also be a maximum or a saddle. There Newton looks for a zero of the gradient of
any kind, and never accepts a longer gradient. So it is with refraction, where the leg to the vertex counts its length
times an index (`index`, see `fermat.py`).
"""

from __future__ import annotations

import numpy as np

from ..fermat import SurfaceSample, path_gradient, sample, towards_eye
from ..screen import Screen
from ..surfaces.radial_surfaces import Float64Array, RadialSurface, unit

DIFFERENCE = 1e-2
"""Angle over which grad r is differenced, radians: a sixth of a texel of the usual map"""
FLATTEST = 1e-5
"""Smallest eigenvalue of the second derivative, relative to the largest, that is not shifted."""
LONGEST_STEP = 0.5
"""Radians"""
SLACKENED = 0.98
"""A step towards a point of any kind must shrink the gradient at least to this share."""
TRIALS = 6
"""Lengths of one step that are tried"""
SHORTENING = 0.35
SUFFICIENT = 1e-4
"""Share of the predicted descent that a step must keep (Armijo)"""
ROUNDING = 2e-7
"""Path lengths closer than this share of the radius count as equal: float32 cannot tell them apart. Nor gradients,
whose error grows as an end of the path comes nearer than a radius."""
CONTRACTION = 0.7
"""A step at positive curvature is also taken where it shrinks the gradient to this share. An interpolated map
ripples by some 1e-4 of its radius between texels, which hides the last pixels of descent from the path length."""
AT_REST = 0.2
"""Share of the tolerance: a point that Newton would move less, foreshortening aside, stays where it is."""
LEFT_OVER = 0.1
"""Share of the tolerance that the error after the last correction may be, foreshortening aside"""
QUADRATIC = 0.5
"""Most that a correction may be of the step before it, for the error after it to be taken from the ratio of both"""

NEARNESS = 0.5
"""Longest such step, in distances to the nearer end of the path: second derivatives change over that length."""


def tangent_frame(u: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Two unit vectors (n, 3) that complete the unit vectors u (n, 3) to right-handed frames."""
    helper = np.where(np.abs(u[:, :1]) < 0.7, np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 1.0, 0.0]]))
    first = unit(np.cross(u, helper))
    return first, np.cross(u, first)


def on_arc(a: Float64Array, b: Float64Array, share: Float64Array) -> Float64Array:
    """Directions (n, 3) at `share` (n,) of the great circle from a to b, unit vectors (n, 3)."""
    angle, across = arc(a, b)
    turned = (share * angle)[:, None]
    return np.cos(turned) * a + np.sin(turned) * across


def arc(a: Float64Array, b: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Angle (n,) from a to b, unit vectors (n, 3), and the unit tangent (n, 3) at a that leads there."""
    cosine = _dot(a, b)
    across = b - cosine[:, None] * a
    sine = np.linalg.norm(across, axis=1)
    across = np.where(sine[:, None] < 1e-6, tangent_frame(a)[0], unit(across))
    # Not arccos: near 0 and pi it loses half the digits.
    return np.arctan2(sine, cosine), across


def guess(eye: Float64Array, vertices: Float64Array) -> Float64Array:
    """Directions (n, 3) between an eye (4,), or eyes (n, 4), and vertices, nearer to the one that is nearer the center.

    On the great circle from the eye's direction to the vertex's, at the share d_E / (d_E + d_V).
    """
    eyes = np.broadcast_to(eye, (len(vertices), 4))
    distance = np.linalg.norm(eyes[:, :3], axis=1)
    share = np.where(eyes[:, 3] > 0.0, distance / (distance + np.linalg.norm(vertices, axis=1)), 1.0)
    return on_arc(unit(eyes[:, :3]), unit(vertices), share)


def path_change(
    eye: Float64Array, vertices: Float64Array, start: Float64Array, end: Float64Array, index: float = 1.0
) -> Float64Array:
    """Path length by `end` minus path length by `start` (n,), without subtracting two long lengths.

    |X-Q| - |X-P| = (Q-P).(P+Q-2X) / (|X-P| + |X-Q|); for an eye at infinity the first leg is a projection.
    """
    moved = end - start

    def leg(x: Float64Array) -> Float64Array:
        lengths = np.linalg.norm(x - start, axis=1) + np.linalg.norm(x - end, axis=1)
        return _dot(moved, start + end - 2.0 * x) / np.maximum(lengths, 1e-30)

    return (leg(eye[:3]) if eye[3] else -(moved @ eye[:3])) + index * leg(vertices)


def second_derivative(
    surface: RadialSurface,
    eye: Float64Array,
    vertices: Float64Array,
    u: Float64Array,
    at: SurfaceSample,
    frame: tuple[Float64Array, Float64Array],
    index: float = 1.0,
) -> tuple[Float64Array, Float64Array, Float64Array]:
    """Of the path length at u in `frame`: xx, xy and yy, (n,) each.

    With P_i = r_i u + r e_i and P_ij . h = (r_ij - r d_ij) (h . u) + r_i (h . e_j) + r_j (h . e_i) it is
    -P_ij . h plus, for each leg of length d in the direction t, (P_i . P_j - (P_i . t) (P_j . t)) / d; that of the
    vertex counts `index` times.
    """
    first, second = frame
    to_vertex = vertices - at.position
    distance = np.maximum(np.linalg.norm(to_vertex, axis=1), 1e-30)
    t_vertex, t_eye = to_vertex / distance[:, None], towards_eye(eye, at.position)
    h = t_eye + index * t_vertex
    by_first, by_second = (
        (sample(surface, unit(u + DIFFERENCE * axis)).gradient - at.gradient) / DIFFERENCE for axis in frame
    )
    slope_1, slope_2 = _dot(at.gradient, first), _dot(at.gradient, second)
    h_u, h_1, h_2 = _dot(h, u), _dot(h, first), _dot(h, second)
    xx = -((_dot(by_first, first) - at.radius) * h_u + 2.0 * slope_1 * h_1)
    yy = -((_dot(by_second, second) - at.radius) * h_u + 2.0 * slope_2 * h_2)
    xy = -(0.5 * (_dot(by_first, second) + _dot(by_second, first)) * h_u + slope_1 * h_2 + slope_2 * h_1)
    moved_1 = slope_1[:, None] * u + at.radius[:, None] * first
    moved_2 = slope_2[:, None] * u + at.radius[:, None] * second
    legs = [(t_vertex, distance / index)]
    if eye[3]:
        legs.append((t_eye, np.maximum(np.linalg.norm(eye[:3] - at.position, axis=1), 1e-30)))
    for t, length in legs:
        along_1, along_2 = _dot(moved_1, t), _dot(moved_2, t)
        xx = xx + (_dot(moved_1, moved_1) - along_1**2) / length
        xy = xy + (_dot(moved_1, moved_2) - along_1 * along_2) / length
        yy = yy + (_dot(moved_2, moved_2) - along_2**2) / length
    return xx, xy, yy


def minimize(
    surface: RadialSurface,
    screen: Screen,
    vertices: Float64Array,
    start: Float64Array,
    steps: int,
    tolerance: float,
    any_kind: bool = False,
    index: float = 1.0,
) -> tuple[Float64Array, np.ndarray, np.ndarray]:
    """Descend from `start` (n, 3): directions (n, 3), converged (n,), steps taken (n,).

    Converged means that at a point of positive curvature a second Newton correction, with the same derivative, moves
    less than `tolerance` pixels, and that what it leaves is a tenth of that whichever way it points, or that the
    gradient is down to rounding; or that no length of a Newton step under `tolerance` is an improvement. With
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
        g = path_gradient(eye, target, here, at, index)
        frame = tangent_frame(here)
        derivative = second_derivative(surface, eye, target, here, at, frame, index)
        derivative, regular = shifted(derivative, any_kind)
        newton = newton_step(derivative, g, frame)
        newton_length = np.linalg.norm(newton, axis=1)
        step = newton * np.minimum(1.0, LONGEST_STEP / np.maximum(newton_length, 1e-30))[:, None]
        iterations[active] += 1
        # Pixels of an angle that nothing foreshortens: the line of sight may hide a step, but not the error it leaves.
        per_angle = at.radius * screen.pixels_per_length(at.position)
        nearest = _nearest_end(eye, target, at)
        least = ROUNDING * at.radius * (1.0 + at.radius / nearest)
        length = np.linalg.norm(g, axis=1)
        rests = newton_length * per_angle < AT_REST * tolerance
        rests |= (length < least) & (_pixels(screen, at, newton) < tolerance)
        rests &= regular

        slope = _dot(g, step)
        factor = np.ones(len(active))
        accepted = rests.copy()
        moved = here.copy()
        correction = np.full(here.shape, np.inf)
        length_there = np.zeros(len(active))
        for trial_number in range(TRIALS):
            if accepted.all():
                break
            trial = unit(here + factor[:, None] * step)
            there = sample(surface, trial)
            change = path_change(eye, target, at.position, there.position, index)
            descends = change <= SUFFICIENT * factor * slope + ROUNDING * at.radius
            g_there = path_gradient(eye, target, trial, there, index)
            shortened = np.linalg.norm(g_there, axis=1)
            contracts = shortened < (SLACKENED if any_kind else CONTRACTION) * length
            good = ~accepted & regular & contracts if any_kind else ~accepted & (descends | (regular & contracts))
            moved[good] = trial[good]
            if trial_number == 0:
                correction[good] = newton_step(derivative, g_there, frame)[good]
                length_there = shortened
            accepted |= good
            factor = np.where(accepted, factor, SHORTENING * factor)
        known = np.isfinite(correction[:, 0]) & regular & (newton_length < LONGEST_STEP)
        known &= newton_length * at.radius < NEARNESS * nearest
        correction[~known] = 0.0
        left = np.linalg.norm(correction, axis=1)
        ratio = left / np.maximum(newton_length, 1e-30)
        quadratic = (ratio < QUADRATIC) & (left * ratio * per_angle < LEFT_OVER * tolerance)
        small = (_pixels(screen, at, correction) < tolerance) & (quadratic | (length_there < least))
        small |= left * per_angle < AT_REST * tolerance
        small &= known
        moved[small] = unit(moved[small] + correction[small])
        # Where texels meet with a kink nothing may come closer than this.
        stuck = ~accepted & regular & (_pixels(screen, at, newton) < tolerance)
        done = rests | small | stuck
        u[active] = moved
        converged[active[done]] = True
        active = active[~done & accepted]
    return u, converged, iterations


def _nearest_end(eye: Float64Array, vertices: Float64Array, at: SurfaceSample) -> Float64Array:
    """(n,) distance from the surface to eye or vertex, whichever is nearer."""
    nearest = np.linalg.norm(vertices - at.position, axis=1)
    if eye[3]:
        nearest = np.minimum(nearest, np.linalg.norm(eye[:3] - at.position, axis=1))
    return np.maximum(nearest, 1e-30)


def _pixels(screen: Screen, at: SurfaceSample, step: Float64Array) -> Float64Array:
    """(n,) of tangent steps (n, 3), as the line of sight foreshortens them."""
    return np.linalg.norm(screen.pixels(at.position, at.radius[:, None] * step), axis=1)


def shifted(
    derivative: tuple[Float64Array, Float64Array, Float64Array], any_kind: bool
) -> tuple[tuple[Float64Array, Float64Array, Float64Array], np.ndarray]:
    """The second derivative made positive, and whether (n,) it was so as it was; with `any_kind` only whether it can be
    inverted."""
    xx, xy, yy = derivative
    if any_kind:
        return derivative, xx * yy - xy * xy != 0.0
    middle, spread = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    lowest, highest = middle - spread, middle + spread
    shift = np.maximum(0.0, np.maximum(np.abs(lowest), FLATTEST * np.abs(highest)) - lowest)
    return (xx + shift, xy, yy + shift), (shift == 0.0) & (lowest > 0.0)


def newton_step(
    derivative: tuple[Float64Array, Float64Array, Float64Array],
    g: Float64Array,
    frame: tuple[Float64Array, Float64Array],
) -> Float64Array:
    """Newton steps (n, 3) for gradients g (n, 3); none where the derivative is singular."""
    xx, xy, yy = derivative
    first, second = frame
    x, y = _dot(g, first), _dot(g, second)
    determinant = xx * yy - xy * xy
    safe = np.where(determinant != 0.0, determinant, np.inf)
    return (-(yy * x - xy * y) / safe)[:, None] * first + (-(xx * y - xy * x) / safe)[:, None] * second


def _dot(p: Float64Array, q: Float64Array) -> Float64Array:
    return np.einsum("ij,ij->i", p, q)
