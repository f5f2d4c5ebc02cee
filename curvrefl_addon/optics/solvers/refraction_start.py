# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where searches for refraction points start (`newton_refraction.py`): a ladder of directions, cheap ones first."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..fermat import SurfaceSample, half_vector, path_gradient, sample
from ..snell import is_refraction_side, snell_error
from ..surfaces.radial_surfaces import Float64Array, RadialSurface, unit
from .descent import DIFFERENCE, LONGEST_STEP, SHORTENING, arc, newton_step, shifted, tangent_frame
from .pierce import pierce

type Slope = Callable[[Float64Array], tuple[Float64Array, np.ndarray]]
"""Of angles (n,) along a circle: the path's slope (n,), and whether eye and vertex see the surface from their sides"""

SCANNED = 12
"""Intervals of the great circle through eye and vertex in which signs of the gradient are compared"""
HALVINGS = 6
"""Of such an interval, by false position and halves in turn"""
ROOTS = 3
"""Most zeros on the great circle that are started from"""
NORMAL_STARTS, NORMAL_ROUNDS = 3, 8
"""Starts by the normal that Snell's law asks for, and how often it is looked for on the surface between two of them,
each time as seen from the last point"""
SUPPORT_STEPS, SUPPORT_TRIALS = 10, 4
"""Newton steps to the point of a normal, and lengths of one step that are tried"""
SEEDS = 64
"""Directions that are compared"""
GOLDEN_ANGLE = float(np.pi * (1.0 + np.sqrt(5.0)))
"""Between two of them, radians and some turns"""
STARTS = 6
"""Best of them that are started from"""
RUNGS = ("first guess", "entry", "circle", "normal", "seeds")
"""Entry: where the straight way enters, for an index near 1, and towards the vertex, for one in contact"""
FIRST_GUESS, ENTRY, CIRCLE, NORMAL, SEEDED = range(len(RUNGS))
RUNG_COUNT = len(RUNGS)


def starts_of(
    rung: int, surface: RadialSurface, eye: Float64Array, vertices: Float64Array, index: float, side: float
) -> list[Float64Array]:
    """Directions (n, 3) to start from one after the other, NaN for those that there are
    not. `index` and `side` as in `snell.py`."""
    if rung == ENTRY:
        entered, point = pierce(surface, eye, vertices)
        return [np.where(entered[:, None] & (side > 0.0), unit(point), np.nan), unit(vertices)]
    return {FIRST_GUESS: sphere_guesses, CIRCLE: circle_guesses, NORMAL: normal_guesses, SEEDED: best_seeds}[rung](
        surface, eye, vertices, index, side
    )


def spread_directions() -> Float64Array:
    """(SEEDS, 3) unit vectors, evenly along a golden spiral."""
    number = np.arange(SEEDS)
    z = 1.0 - (2.0 * number + 1.0) / SEEDS
    ring = np.sqrt(1.0 - z**2)
    return np.column_stack([ring * np.cos(GOLDEN_ANGLE * number), ring * np.sin(GOLDEN_ANGLE * number), z])


class Circle:
    """The great circle of directions from eyes towards vertices, by signed angle from the eye's direction."""

    def __init__(self, eye: Float64Array, vertices: Float64Array) -> None:
        self.start = unit(np.broadcast_to(eye[:3], vertices.shape))
        self.angle, self.across = arc(self.start, unit(vertices))

    def at(self, x: Float64Array) -> Float64Array:
        """(n, 3) directions at angles (n,)."""
        return np.cos(x)[:, None] * self.start + np.sin(x)[:, None] * self.across

    def along(self, x: Float64Array) -> Float64Array:
        """(n, 3) unit tangents there."""
        return np.cos(x)[:, None] * self.across - np.sin(x)[:, None] * self.start


def sphere_guesses(
    surface: RadialSurface, eye: Float64Array, vertices: Float64Array, index: float, side: float
) -> list[Float64Array]:
    """Two directions (n, 3) where a sphere about the star center, as large as the surface towards the eye, refracts.

    Zeros of the path's slope along the circle through eye and vertex, between the horizons; NaN where there is none.
    """
    circle = Circle(eye, vertices)
    radius = surface.radius(side * circle.start)[0]
    w = float(eye[3] > 0.0)
    e = np.linalg.norm(eye[:3]) / np.where(w > 0.0, radius, 1.0)
    v = np.linalg.norm(vertices, axis=1) / radius

    def slope(x: Float64Array) -> tuple[Float64Array, np.ndarray]:
        """Of the path, and whether eye and vertex see the sphere from their sides."""
        x_eye, y_eye = e * np.cos(x) - w, -e * np.sin(x)
        x_vertex, y_vertex = v * np.cos(circle.angle - x) - 1.0, v * np.sin(circle.angle - x)
        to_eye, to_vertex = np.hypot(x_eye, y_eye), np.hypot(x_vertex, y_vertex)
        value = -(y_eye / np.maximum(to_eye, 1e-30) + index * y_vertex / np.maximum(to_vertex, 1e-30))
        return value, (side * x_eye > 0.0) & (side * x_vertex < 0.0)

    reach = np.full(len(v), np.pi)
    if side > 0.0:
        # To the horizons, where the first and last values are taken just before.
        reach = (1.0 - 1e-6) * np.arccos(np.clip(w / np.maximum(e, 1e-30), 0.0, 1.0)) * np.ones(len(v))
    return [circle.at(x) for x in _zeros(slope, reach, 2)]


def _zeros(slope: Slope, reach: Float64Array, count: int) -> list[Float64Array]:
    """Angles (n,) of the first `count` zeros of `slope` between -reach and reach, from the middle outwards to positive
    angles and then to negative ones; NaN for those that there are not.
    """
    found = [np.full(len(reach), np.nan) for _ in range(count)]
    number = np.zeros(len(reach), int)
    half = SCANNED // 2
    for sign in (1.0, -1.0):
        before = np.zeros(len(reach))
        value, _ = slope(before)
        for step in range(1, half + 1):
            # Denser towards the horizon, where the path's slope turns fastest.
            share = step / half
            x = sign * reach * np.sin(0.5 * np.pi * share)
            here, _ = slope(x)
            crosses = ((value < 0.0) != (here < 0.0)) & (number < count)
            if crosses.any():
                zero, valid = _refined(slope, before, x, value, here)
                for place in range(count):
                    mine = crosses & valid & (number == place)
                    found[place][mine] = zero[mine]
                number[crosses & valid] += 1
            before, value = x, here
    return found


def _refined(
    slope: Slope, low: Float64Array, high: Float64Array, at_low: Float64Array, at_high: Float64Array
) -> tuple[Float64Array, np.ndarray]:
    """(k,) zeros of some rows' slopes between two angles where these differ in sign: false position, kept off the ends
    by halving in turn."""
    a, b, at_a, at_b = low.copy(), high.copy(), at_low.copy(), at_high.copy()
    for turn in range(HALVINGS):
        secant = a - at_a * (b - a) / np.where(at_b == at_a, 1.0, at_b - at_a)
        x = np.where(turn % 2 == 0, secant, 0.5 * (a + b))
        here, _ = slope(x)
        left = (here < 0.0) == (at_a < 0.0)
        a, at_a = np.where(left, x, a), np.where(left, here, at_a)
        b, at_b = np.where(left, b, x), np.where(left, at_b, here)
    x = a - at_a * (b - a) / np.where(at_b == at_a, 1.0, at_b - at_a)
    return x, slope(x)[1]


def circle_guesses(
    surface: RadialSurface, eye: Float64Array, vertices: Float64Array, index: float, side: float
) -> list[Float64Array]:
    """As `sphere_guesses` on the surface itself, whose slope across the circle is left out: ROOTS directions, NaN for
    those that there are not."""
    circle = Circle(eye, vertices)

    def slope(x: Float64Array) -> tuple[Float64Array, np.ndarray]:
        u = circle.at(x)
        at = sample(surface, u)
        value = np.einsum("ij,ij->i", path_gradient(eye, vertices, u, at, index), circle.along(x))
        return value, is_refraction_side(eye, vertices, at, side)

    return [circle.at(x) for x in _zeros(slope, np.full(len(vertices), np.pi), ROOTS)]


def normal_guesses(
    surface: RadialSurface, eye: Float64Array, vertices: Float64Array, index: float, side: float
) -> list[Float64Array]:
    """NORMAL_STARTS directions (n, 3) where the surface has the normal that Snell's law asks for between eye and
    vertex, as seen from the star center and then from the last point again and again.

    A sharp tip is seen from the center in few directions and yet refracts into nearly all: there seeds that are even
    over the sphere are too few.
    """
    points = np.zeros(vertices.shape)
    starts: list[Float64Array] = []
    u: Float64Array | None = None
    for number in range(1 + NORMAL_ROUNDS * (NORMAL_STARTS - 1)):
        bent = half_vector(eye, vertices, points, index)
        # From inside the index is the inverse and the normal the other one: the same outward normal.
        normal = unit(bent if (index < 1.0) == (side > 0.0) else -bent)
        u = support_direction(surface, normal, normal if u is None else u)
        if number % NORMAL_ROUNDS == 0:
            starts.append(u)
        points = sample(surface, u).position
    return starts


def support_direction(surface: RadialSurface, normal: Float64Array, start: Float64Array) -> Float64Array:
    """Directions (n, 3) of the points that are farthest out along unit normals (n, 3), by Newton on normal . r u from
    `start` (n, 3).

    On a convex surface there is one such point and its normal is the one given; elsewhere a nearby maximum is found.
    """
    u = start.copy()
    at = sample(surface, u)
    height = np.einsum("ij,ij->i", normal, at.position)
    for _ in range(SUPPORT_STEPS):
        first, second = tangent_frame(u)
        along, right, up = (np.einsum("ij,ij->i", normal, axis) for axis in (u, first, second))
        slope_1, slope_2 = (np.einsum("ij,ij->i", at.gradient, axis) for axis in (first, second))
        g_1, g_2 = slope_1 * along + at.radius * right, slope_2 * along + at.radius * up
        by_first, by_second = (
            (sample(surface, unit(u + DIFFERENCE * axis)).gradient - at.gradient) / DIFFERENCE
            for axis in (first, second)
        )
        xx = (np.einsum("ij,ij->i", by_first, first) - at.radius) * along + 2.0 * slope_1 * right
        yy = (np.einsum("ij,ij->i", by_second, second) - at.radius) * along + 2.0 * slope_2 * up
        xy = 0.5 * (np.einsum("ij,ij->i", by_first, second) + np.einsum("ij,ij->i", by_second, first)) * along
        xy = xy + slope_1 * up + slope_2 * right
        # Of minus the height: that is to be made small.
        derivative, _ = shifted((-xx, -xy, -yy), any_kind=False)
        step = newton_step(derivative, -(g_1[:, None] * first + g_2[:, None] * second), (first, second))
        size = np.linalg.norm(step, axis=1, keepdims=True)
        step *= np.minimum(1.0, LONGEST_STEP / np.maximum(size, 1e-30))
        accepted = np.zeros(len(u), bool)
        factor = 1.0
        for _ in range(SUPPORT_TRIALS):
            trial = unit(u + factor * step)
            there = sample(surface, trial)
            higher = ~accepted & (np.einsum("ij,ij->i", normal, there.position) > height)
            u = np.where(higher[:, None], trial, u)
            accepted |= higher
            factor *= SHORTENING
        at = sample(surface, u)
        height = np.einsum("ij,ij->i", normal, at.position)
    return u


def best_seeds(
    surface: RadialSurface, eye: Float64Array, vertices: Float64Array, index: float, side: float
) -> list[Float64Array]:
    """STARTS directions (n, 3) of SEEDS whose refracted lines of sight pass the vertices closest in angle."""
    seeds = spread_directions()
    at = sample(surface, seeds)
    error = np.stack(
        [
            snell_error(
                eye,
                vertices,
                SurfaceSample(
                    *(
                        np.broadcast_to(part[k], (len(vertices), *part[k].shape))
                        for part in (at.position, at.normal, at.radius, at.gradient)
                    )
                ),
                index,
                side,
            )
            for k in range(len(seeds))
        ],
        axis=1,
    )
    starts = []
    for _ in range(STARTS):
        best = seeds[error.argmin(axis=1)]
        starts.append(best)
        error[np.arange(len(vertices)), error.argmin(axis=1)] = np.inf
    return starts
