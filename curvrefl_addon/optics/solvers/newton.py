# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The method `newton` in float64: descent on the path length from a good start, and a ladder of others where it fails.

This is the reference that `newton.comp.glsl` and `newton_stragglers.comp.glsl` are held to.

A few steps from the last frame's point, or from the reflection in a sphere, solve nearly all vertices. The others are
asked first whether the mirror hides them, and then climb the ladder of `RUNGS`: each is another direction to start
from, with the full number of steps. Where a descent ends at a point that eye or vertex sees from behind, the way to it
enters the mirror on its front; the path by way of that entry is shorter, so that the descent goes on from there.
"""

from __future__ import annotations

import numpy as np

from .. import status
from ..fermat import SurfaceSample, half_vector, is_reflection_side, mirror_error, path_gradient, sample, towards_eye
from ..screen import Screen
from ..surfaces.radial_surfaces import Float64Array, RadialSurface, unit
from .descent import arc, guess, minimize, on_arc
from .pierce import pierce
from .secant_star import Solution

FIRST_STEPS = 6
"""Of the first pass: on a GPU the slowest vertex of a group holds up the others."""
STEPS = 20
ENTRIES = 3
"""How often one descent is taken back to where the way to its end enters the mirror"""
SPHERE_ROUNDS = 3
SMALLEST_HEIGHT = 1e-6
"""Of eye and vertex over the sphere of the guess, relative to its radius"""
STRAIGHT = 0.05
"""Length of the half vector under which the path is the straight segment: it pierces the mirror there"""
ON_HORIZON = 0.02
"""The same where a descent has failed: reflected and hidden are one there, and the map's texels hold neither"""
BISECTIONS = 16
RUNGS = ("sphere", "any kind", "between", "vertex", "eye", "bisection")
"""Where the descents of a straggler start. The second goes on where the first has ended, to a zero of the gradient of
any kind: where texels of the map meet with a kink, above all at the cube's corners, the curvature may be negative."""
RUNG_COUNT = len(RUNGS)
ANY_KIND = 1
FIRST_PASS = -1
"""Rung of what the first pass has solved"""
HIDDEN_AT_ONCE = -2
"""Rung of a straggler that the mirror was found to hide before the ladder"""


def sphere_guess(surface: RadialSurface, eye: Float64Array, vertices: Float64Array) -> Float64Array:
    """Directions (n, 3) where a sphere about the star center, as large as the mirror is there, would reflect.

    With heights h over a sphere of radius R and k = 1 + h / R, an angle x from P to an end makes the incidence
    x + atan(sin x / (k - cos x)), which grows with x. Newton balances both ends from the paraxial share, where
    incidence is x (1 + R / h). Two reads of the map whatever the rounds.
    """
    a, b = unit(np.broadcast_to(eye[:3], vertices.shape)), unit(vertices)
    angle, across = arc(a, b)
    radius_a, radius_b = surface.radius(a)[0], surface.radius(b)[0]
    radius = 0.5 * (radius_a + radius_b)
    over_eye = np.maximum((np.linalg.norm(eye[:3]) - radius_a) / radius, SMALLEST_HEIGHT) if eye[3] else np.inf
    over_vertex = np.maximum((np.linalg.norm(vertices, axis=1) - radius_b) / radius, SMALLEST_HEIGHT)
    near_eye, near_vertex = 1.0 + 1.0 / over_eye, 1.0 + 1.0 / over_vertex
    x = angle * near_vertex / (near_eye + near_vertex)

    def incidence(x: Float64Array, over: Float64Array | float) -> tuple[Float64Array, Float64Array]:
        """And its derivative."""
        if np.isinf(over).any():
            return x, np.ones(len(x))
        # k - cos x without its cancellation
        sine, away = np.sin(x), over + 2.0 * np.sin(0.5 * x) ** 2
        return x + np.arctan2(sine, away), 1.0 + (np.cos(x) * away - sine**2) / (away**2 + sine**2)

    for _ in range(SPHERE_ROUNDS):
        (at_eye, slope_eye), (at_vertex, slope_vertex) = incidence(x, over_eye), incidence(angle - x, over_vertex)
        x = np.clip(x - (at_eye - at_vertex) / (slope_eye + slope_vertex), 0.0, angle)
    return np.cos(x)[:, None] * a + np.sin(x)[:, None] * across


def arc_minimum(surface: RadialSurface, eye: Float64Array, vertices: Float64Array) -> Float64Array:
    """Directions (n, 3) where the path length stops falling on the great circle from eye to vertex, by bisection."""
    a, b = unit(np.broadcast_to(eye[:3], vertices.shape)), unit(vertices)
    angle, across = arc(a, b)
    low, high = np.zeros(len(vertices)), angle
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        cosine, sine = np.cos(middle)[:, None], np.sin(middle)[:, None]
        u, along = cosine * a + sine * across, cosine * across - sine * a
        falls = np.einsum("ij,ij->i", path_gradient(eye, vertices, u, sample(surface, u)), along) < 0.0
        low, high = np.where(falls, middle, low), np.where(falls, high, middle)
    return on_arc(a, b, np.where(angle > 0.0, 0.5 * (low + high) / np.where(angle > 0.0, angle, 1.0), 0.0))


def start_of_rung(
    rung: int, surface: RadialSurface, eye: Float64Array, vertices: Float64Array, hollow: bool
) -> Float64Array:
    """Directions (n, 3) to start a descent from, on any rung but ANY_KIND."""
    name = RUNGS[rung]
    if name == "sphere":
        u = guess(eye, vertices) if hollow else sphere_guess(surface, eye, vertices)
    elif name == "between":
        u = guess(eye, vertices)
    elif name == "vertex":
        u = unit(vertices)
    elif name == "eye":
        u = unit(np.broadcast_to(eye[:3], vertices.shape))
    else:
        u = arc_minimum(surface, eye, vertices)
    return on_hollow_side(surface, eye, vertices, u) if hollow else u


def on_hollow_side(surface: RadialSurface, eye: Float64Array, vertices: Float64Array, u: Float64Array) -> Float64Array:
    """Directions (n, 3), or their opposites where a hollow mirror reflects better there."""
    ahead, behind = (mirror_error(eye, vertices, sample(surface, sign * u)) for sign in (1.0, -1.0))
    # The angle to the inward normal is the supplement.
    return np.where((behind > ahead)[:, None], -u, u)


def solve(
    surface: RadialSurface,
    screen: Screen,
    vertices: Float64Array,
    previous: Float64Array | None = None,
    tolerance: float = 0.05,
    side: float = 1.0,
    first_steps: int = FIRST_STEPS,
    first_rung: int = 0,
    convex: bool = False,
) -> tuple[Solution, np.ndarray]:
    """Reflection points of vertices (n, 3) relative to the star center, and on which rung (n,) each was settled.

    `tolerance` in pixels; `previous` (n, 3) are directions where the vertices were reflected in the last frame or, on a
    convex mirror, where the way to hidden ones entered it; NaN for others. `side` is -1 for a mirror that is hollow
    towards the eye; `convex` says that the mirror is closed and so. `first_rung` leaves rungs out.
    """
    eye, hollow, count = screen.eye, side < 0.0, len(vertices)
    u = start_of_rung(0, surface, eye, vertices, hollow)
    if previous is not None:
        u = np.where(np.isfinite(previous), previous, u)
    u, converged, iterations = minimize(surface, screen, vertices, u, first_steps, tolerance, hollow)
    code = np.full(count, status.UNSOLVED)
    rung = np.full(count, FIRST_PASS)
    at = sample(surface, u)
    code[converged & is_reflection_side(eye, vertices, at, side)] = status.REFLECTED
    straight = _is_straight(eye, vertices, at) & converged & (code == status.UNSOLVED) & (not hollow)
    code[straight] = status.HIDDEN
    # The way into a convex mirror leads over one front and one back; elsewhere another front may come before.
    is_front = np.einsum("ij,ij->i", at.normal, towards_eye(eye, at.position)) > 0.0
    rows = np.flatnonzero(straight & ~(convex & is_front))
    pierced, point = pierce(surface, eye, vertices[rows])
    u[rows[pierced]] = unit(point[pierced])

    left = np.flatnonzero(code == status.UNSOLVED)
    if not hollow:
        pierced, point = pierce(surface, eye, vertices[left])
        code[left[pierced]], rung[left[pierced]] = status.HIDDEN, HIDDEN_AT_ONCE
        u[left[pierced]] = unit(point[pierced])
        left = left[~pierced]
    end = start_of_rung(0, surface, eye, vertices[left], hollow)
    for number in range(first_rung, len(RUNGS)):
        if len(left) == 0:
            break
        start = end if number == ANY_KIND else start_of_rung(number, surface, eye, vertices[left], hollow)
        end, converged, taken = _descend(
            surface, screen, vertices[left], start, tolerance, hollow, hollow or number == ANY_KIND
        )
        iterations[left] += taken
        rung[left] = number
        kept = converged | (code[left] == status.UNSOLVED)
        u[left[kept]] = end[kept]
        at = sample(surface, end)
        right = converged & is_reflection_side(eye, vertices[left], at, side)
        code[left[right]] = status.REFLECTED
        hidden = ~right & converged
        if not hollow:
            length = np.linalg.norm(half_vector(eye, vertices[left], at.position), axis=1)
            hidden = ~right & (length < np.where(converged, STRAIGHT, ON_HORIZON))
        code[left[hidden]] = status.HIDDEN
        # On a hollow mirror nothing proves that a vertex is hidden: other rungs may still find its reflection.
        still = ~right if hollow else ~right & ~hidden
        left, end = left[still], end[still]
    return Solution(u, sample(surface, u), code, iterations), rung


def _descend(
    surface: RadialSurface,
    screen: Screen,
    vertices: Float64Array,
    start: Float64Array,
    tolerance: float,
    hollow: bool,
    any_kind: bool,
) -> tuple[Float64Array, np.ndarray, np.ndarray]:
    """As `minimize` with the full number of steps, and on from where the way to a point seen from behind enters."""
    u, converged, iterations = minimize(surface, screen, vertices, start, STEPS, tolerance, any_kind)
    for _ in range(0 if hollow else ENTRIES):
        at = sample(surface, u)
        behind = converged & ~is_reflection_side(screen.eye, vertices, at) & ~_is_straight(screen.eye, vertices, at)
        rows = np.flatnonzero(behind)
        enters, point = pierce(surface, screen.eye, at.position[rows])
        rows = rows[enters]
        if len(rows) == 0:
            break
        u[rows], converged[rows], taken = minimize(
            surface, screen, vertices[rows], unit(point[enters]), STEPS, tolerance, any_kind
        )
        iterations[rows] += taken
    return u, converged, iterations


def _is_straight(eye: Float64Array, vertices: Float64Array, at: SurfaceSample) -> np.ndarray:
    return np.linalg.norm(half_vector(eye, vertices, at.position), axis=1) < STRAIGHT
