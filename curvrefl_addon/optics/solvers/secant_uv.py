# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The secant method of Roger & Holzschuch 2005 (section 3) on a parametric reflector f(u, v), in float64.

This is the reference that `secant_uv.comp.glsl` is held to; both follow the same steps in the same order.

A triangle A, B, C in the plane of the parameters carries the gradients of the path length d(u, v). Each step solves for
the point where the linearly interpolated gradient vanishes (equations 3.1 and 3.2); that point takes the place of the
corner that is farthest from it. The search ends after a number of steps, or when the triangle is small or flat.

Parameters run from 0 to 1. Where the map wraps the search goes on past 0 and 1, and the two first corners are taken
on the same side of the seam; where it does not, points are clamped to the map. Two things go beyond the paper:

* a step leads at most `LONGEST_STEP` from the corner with the smallest gradient: extrapolated from nearly parallel
  gradients it would lead many times around the map;
* the end counts as a reflection only if the half vector is the normal to within `LARGEST_MISS`.

Nothing is done about the poles of a map, where f does not change with u: the gradient in u vanishes there whatever the
vertex, and what reflects near a pole comes out distorted or is missing (section 4 of the paper names it).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import status
from ..fermat import half_vector, towards_eye
from ..screen import Screen
from ..surfaces.parametric_surfaces import ParametricSample, ParametricSurface
from ..surfaces.radial_surfaces import Float64Array, unit
from .descent import tangent_frame
from .pierce import pierce

STEPS = 5
"""Of the search; the paper's 4 or 5"""
SMALL_TRIANGLE = 0.05
"""Pixels: the search stops when all edges at the reflector are shorter"""
FLATTEST = 1e-6
"""Sine between two gradient differences under which equation 3.2 has no usable solution"""
LONGEST_STEP = 0.5
"""In units of the map"""
SMALLEST_START = 0.02
"""Height of the first triangle, and its base where A and B (nearly) coincide"""
LARGEST_START = 0.1
"""No first triangle is higher."""
LARGEST_MISS = 0.1
"""Radians between half vector and normal from which on an end is no reflection point"""


@dataclass(frozen=True)
class Solution:
    """Result of a solve for n vertices, relative to the center."""

    uv: Float64Array
    """(n, 2) where the search ended"""
    position: Float64Array
    """(n, 3) the reflection point; of a hidden vertex, where the reflector hides it"""
    normal: Float64Array
    """(n, 3) unit normal there, towards the side that reflects"""
    status: np.ndarray
    """(n,) codes of `status`; never REFLECTED without both sign tests"""
    iterations: np.ndarray
    """(n,)"""


def path_gradient(eye: Float64Array, vertices: Float64Array, at: ParametricSample) -> Float64Array:
    """(n, 2) derivatives of the path length E-f(u, v)-V by u and v (section 3.3.2)."""
    h = half_vector(eye, vertices, at.position)
    return -np.column_stack([_dot(at.du, h), _dot(at.dv, h)])


def start_triangle(surface: ParametricSurface, eye: Float64Array, vertices: Float64Array) -> Float64Array:
    """Start parameters (n, 3, 2): A towards the vertex, B towards the eye (section 3.3.1), C beside their middle.

    Of the two sides C takes the one where the point half way on the sphere of directions lies: great circles bend
    towards the poles of a longitude-latitude map, and the reflection point is on or near the one through A and B.
    """
    to_vertex, to_eye = unit(vertices), unit(np.broadcast_to(eye[:3], vertices.shape))
    a, b = surface.uv_of_direction(to_vertex), surface.uv_of_direction(to_eye)
    half_way = surface.uv_of_direction(unit(to_vertex + to_eye + 1e-6 * tangent_frame(to_vertex)[0]))
    edge = _nearer(surface, b - a)
    middle = a + 0.5 * edge
    bend = _nearer(surface, half_way - middle)
    length = np.linalg.norm(edge, axis=1, keepdims=True)
    along = np.where(length > 0.0, edge / np.where(length > 0.0, length, 1.0), [1.0, 0.0])
    # A and B that are one would leave no triangle.
    tiny = length < SMALLEST_START
    a = np.where(tiny, middle - 0.5 * SMALLEST_START * along, a)
    b = np.where(tiny, middle + 0.5 * SMALLEST_START * along, a + edge)
    across = np.column_stack([-along[:, 1], along[:, 0]])
    across = np.where((_dot(across, bend) < 0.0)[:, None], -across, across)
    height = np.clip(np.sqrt(0.75) * length, SMALLEST_START, LARGEST_START)
    c = middle + height * across
    outside = (clamped(surface, c) != c).any(axis=1, keepdims=True)
    c = np.where(outside, middle - height * across, c)
    return np.stack([clamped(surface, corner) for corner in (a, b, c)], axis=1)


def clamped(surface: ParametricSurface, uv: Float64Array) -> Float64Array:
    """Parameters (n, 2) that do not wrap brought into the map."""
    return np.where(surface.wraps, uv, np.clip(uv, 0.0, 1.0))


def _nearer(surface: ParametricSurface, difference: Float64Array) -> Float64Array:
    """What lies between parameters, the nearer way around."""
    return difference - np.array(surface.wraps) * np.rint(difference)


def secant_search(
    surface: ParametricSurface, screen: Screen, vertices: Float64Array, steps: int, tolerance: float
) -> tuple[Float64Array, np.ndarray]:
    """The paper's search: last point (n, 2) and number of steps (n,); `tolerance` in pixels."""
    uv = start_triangle(surface, screen.eye, vertices)

    def gradient(parameters: Float64Array, rows: np.ndarray) -> Float64Array:
        return path_gradient(screen.eye, vertices[rows], surface.sample(parameters))

    active = np.arange(len(vertices))
    g = np.stack([gradient(uv[:, k], active) for k in range(3)], axis=1)
    last = uv[np.arange(len(uv)), _squared(g).argmin(axis=1)]
    iterations = np.zeros(len(vertices), int)
    for _ in range(steps):
        corners, gradients = uv[active], g[active]
        alpha, beta, flat = _zero(gradients)
        active, corners, gradients = active[~flat], corners[~flat], gradients[~flat]
        if len(active) == 0:
            break
        rows = np.arange(len(active))
        weights = np.stack([1.0 - alpha - beta, alpha, beta], axis=1)[~flat]
        nearest = corners[rows, _squared(gradients).argmin(axis=1)]
        move = np.einsum("ij,ijk->ik", weights, corners) - nearest
        move *= np.minimum(1.0, LONGEST_STEP / np.maximum(np.linalg.norm(move, axis=1), 1e-30))[:, None]
        new = clamped(surface, nearest + move)
        at = surface.sample(new)
        farthest = _squared(corners - new[:, None]).argmax(axis=1)
        uv[active, farthest] = new
        g[active, farthest] = path_gradient(screen.eye, vertices[active], at)
        last[active] = new
        iterations[active] += 1
        edges = uv[active] - new[:, None]
        lengths = [
            np.linalg.norm(screen.pixels(at.position, at.du * edges[:, k, :1] + at.dv * edges[:, k, 1:]), axis=1)
            for k in range(3)
        ]
        active = active[np.max(lengths, axis=0) >= tolerance]
    return last, iterations


def solve(
    surface: ParametricSurface,
    screen: Screen,
    vertices: Float64Array,
    steps: int = STEPS,
    tolerance: float = SMALL_TRIANGLE,
) -> Solution:
    """Reflection points of vertices (n, 3) relative to the center; `tolerance` in pixels."""
    eye = screen.eye
    uv, iterations = secant_search(surface, screen, vertices, steps, tolerance)
    at = surface.sample(uv)
    position, normal = at.position.copy(), _reflecting_side(surface, eye, at)
    h = half_vector(eye, vertices, position)
    along = _dot(h, normal)
    sine = np.linalg.norm(np.cross(h, normal), axis=1)
    seen = (_dot(normal, towards_eye(eye, position)) > 0.0) & (_dot(normal, vertices - position) > 0.0)
    reflected = seen & (np.arctan2(sine, along) <= LARGEST_MISS)
    # The path is stationary too where the segment from the eye to the vertex pierces the reflector.
    hidden = ~seen & (sine <= LARGEST_MISS)
    if surface.solid is not None:
        left = np.flatnonzero(~reflected)
        pierced, points = pierce(surface.solid, eye, vertices[left])
        rows = left[pierced]
        hidden[rows] = True
        uv[rows] = _nearest_on_map(surface, points[pierced])
        position[rows], normal[rows] = points[pierced], surface.sample(uv[rows]).normal
    code = np.select([reflected, hidden], [status.REFLECTED, status.HIDDEN], status.UNSOLVED)
    return Solution(uv, position, normal, code, iterations)


def _reflecting_side(surface: ParametricSurface, eye: Float64Array, at: ParametricSample) -> Float64Array:
    if not surface.is_open:
        return at.normal
    turned = _dot(at.normal, towards_eye(eye, at.position)) < 0.0
    return np.where(turned[:, None], -at.normal, at.normal)


def _nearest_on_map(surface: ParametricSurface, points: Float64Array) -> Float64Array:
    """Parameters (n, 2) of points (n, 3) on the surface: those of the direction, and one Newton step from there."""
    uv = surface.uv_of_direction(unit(points))
    at = surface.sample(uv)
    offset = points - at.position
    uu, vv, uv_product = (_dot(p, q) for p, q in ((at.du, at.du), (at.dv, at.dv), (at.du, at.dv)))
    up, vp = _dot(at.du, offset), _dot(at.dv, offset)
    determinant = uu * vv - uv_product**2
    # Nothing to gain beside a pole.
    safe = np.where(determinant > 1e-4 * vv * vv, determinant, np.inf)
    step = np.column_stack([vv * up - uv_product * vp, uu * vp - uv_product * up]) / safe[:, None]
    return clamped(surface, uv + np.clip(step, -SMALLEST_START, SMALLEST_START))


def _zero(g: Float64Array) -> tuple[Float64Array, Float64Array, np.ndarray]:
    """Weights (alpha, beta) of B and C at which the interpolated gradient of g (n, 3, 2) vanishes, and where there are
    none: (1 - alpha - beta) G_A + alpha G_B + beta G_C = 0 (equation 3.2)."""
    a, b, c = g[:, 0], g[:, 1] - g[:, 0], g[:, 2] - g[:, 0]
    determinant = _cross(b, c)
    flat = np.abs(determinant) <= FLATTEST * np.sqrt(_squared(b) * _squared(c))
    safe = np.where(flat, 1.0, determinant)
    return -_cross(a, c) / safe, -_cross(b, a) / safe, flat


def _cross(p: Float64Array, q: Float64Array) -> Float64Array:
    return p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]


def _dot(p: Float64Array, q: Float64Array) -> Float64Array:
    return np.einsum("...i,...i->...", p, q)


def _squared(vectors: Float64Array) -> Float64Array:
    return _dot(vectors, vectors)
