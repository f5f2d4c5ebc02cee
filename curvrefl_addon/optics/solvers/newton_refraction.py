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

from collections.abc import Callable

import numpy as np

from .. import status
from ..fermat import SurfaceSample, half_vector, path_gradient, sample, towards_eye
from ..screen import Screen
from ..snell import LARGEST_INDEX, SMALLEST_INDEX, is_refraction_side, refracted, snell_error
from ..surfaces.radial_surfaces import Float64Array, RadialSurface, unit
from .descent import DIFFERENCE, LONGEST_STEP, SHORTENING, arc, minimize, newton_step, shifted, tangent_frame
from .pierce import pierce
from .secant_star import Solution

type Slope = Callable[[Float64Array], tuple[Float64Array, np.ndarray]]
"""Of angles (n,) along a circle: the path's slope (n,), and whether eye and vertex see the surface from their sides"""

FIRST_STEPS = 6
"""Of the first pass: on a GPU the slowest vertex of a group holds up the others."""
STEPS = 40
SCANNED = 12
"""Intervals of the great circle through eye and vertex in which signs of the gradient are compared"""
HALVINGS = 4
"""Of such an interval, by false position and halves in turn"""
ROOTS = 3
"""Most zeros on the great circle that are started from"""
SEEDS = 64
"""Directions that are compared"""
STARTS = 6
"""Best of them that are started from"""
GOLDEN_ANGLE = float(np.pi * (1.0 + np.sqrt(5.0)))
NORMAL_ROUNDS = 3
SUPPORT_STEPS = 10
SUPPORT_TRIALS = 4
HORIZON_BISECTIONS = 20
RUNGS = ("first guess", "entry", "circle", "normal", "seeds")
"""Where the searches of a straggler start. Entry: where the straight way enters, for an index near 1, and towards the
vertex, for one in contact."""
FIRST_GUESS, ENTRY, CIRCLE, NORMAL, SEEDED = range(len(RUNGS))
RUNG_COUNT = len(RUNGS)
FIRST_PASS = -1
"""Rung of what the first pass has solved"""


def spread_directions() -> Float64Array:
    """(SEEDS, 3) unit vectors, evenly along a golden spiral."""
    number = np.arange(SEEDS)
    z = 1.0 - (2.0 * number + 1.0) / SEEDS
    ring = np.sqrt(1.0 - z**2)
    return np.column_stack([ring * np.cos(GOLDEN_ANGLE * number), ring * np.sin(GOLDEN_ANGLE * number), z])


class _Circle:
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
    circle = _Circle(eye, vertices)
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
    circle = _Circle(eye, vertices)

    def slope(x: Float64Array) -> tuple[Float64Array, np.ndarray]:
        u = circle.at(x)
        at = sample(surface, u)
        value = np.einsum("ij,ij->i", path_gradient(eye, vertices, u, at, index), circle.along(x))
        return value, is_refraction_side(eye, vertices, at, side)

    return [circle.at(x) for x in _zeros(slope, np.full(len(vertices), np.pi), ROOTS)]


def normal_guesses(
    surface: RadialSurface, eye: Float64Array, vertices: Float64Array, index: float, side: float
) -> list[Float64Array]:
    """Directions (n, 3) where the surface has the normal that Snell's law asks for between eye and vertex as seen from
    the star center, and from that point again, NORMAL_ROUNDS of them.

    A sharp tip is seen from the center in few directions and yet refracts into nearly all: there seeds that are even
    over the sphere are too few.
    """
    points = np.zeros(vertices.shape)
    starts = []
    for _ in range(NORMAL_ROUNDS):
        bent = half_vector(eye, vertices, points, index)
        # From inside the index is the inverse and the normal the other one: the same outward normal.
        normal = unit(bent if (index < 1.0) == (side > 0.0) else -bent)
        u = support_direction(surface, normal)
        starts.append(u)
        points = sample(surface, u).position
    return starts


def support_direction(surface: RadialSurface, normal: Float64Array) -> Float64Array:
    """Directions (n, 3) of the points that are farthest out along unit normals (n, 3), by Newton on normal . r u.

    On a convex surface there is one such point and its normal is the one given; elsewhere a nearby maximum is found.
    """
    u = normal.copy()
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


def last_seen(
    surface: RadialSurface, eye: Float64Array, vertices: Float64Array, index: float, side: float
) -> tuple[Float64Array, np.ndarray]:
    """Of vertices that no search has found: the last direction (n, 3) from the eye's towards the vertex at which a
    line of sight passes the surface, and whether (n,) the vertex is beyond that ray, or before the surface: hidden.

    From inside nothing is hidden but by total reflection, which some line of sight meets where `index` is under 1.
    """
    circle = _Circle(eye, vertices)
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


def _starts_of(
    rung: int, surface: RadialSurface, eye: Float64Array, vertices: Float64Array, index: float, side: float
) -> list[Float64Array]:
    """Directions (n, 3) to start from one after the other, NaN for those that there are not."""
    if rung == ENTRY:
        entered, point = pierce(surface, eye, vertices)
        return [np.where(entered[:, None] & (side > 0.0), unit(point), np.nan), unit(vertices)]
    return {FIRST_GUESS: sphere_guesses, CIRCLE: circle_guesses, NORMAL: normal_guesses, SEEDED: best_seeds}[rung](
        surface, eye, vertices, index, side
    )


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
    """
    index = float(np.clip(index, SMALLEST_INDEX, LARGEST_INDEX))
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
        starts = _starts_of(number, surface, eye, vertices[left], index, side)
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
