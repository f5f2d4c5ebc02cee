# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All refraction points on a plane and on a sphere in closed form, the check of every search for them.

`index` is that beyond the surface over that on the eye's side (see `snell.py`).
"""

from __future__ import annotations

import numpy as np

from .radial_surfaces import Float64Array, unit

POLISH = 60
"""Steps of bracketed Newton, or of Newton on an angle; fewer do but where roots are about to merge"""
ON_CIRCLE = 1e-3
"""How far from the unit circle a root of the sextic may be that polishing takes onto it: double roots lose half the
digits"""
REAL = 1e-10
"""Mismatch of the sines under which a root is one of Snell's law itself and not of its square"""
SAME = 1e-7
"""Radians between two roots that count as one"""


def plane_points(eye: Float64Array, vertices: Float64Array, index: float | Float64Array) -> Float64Array:
    """Refraction points (n, 3) on the plane z = 0; NaN for vertices that are not under it.

    eye (4,) or (n, 4) homogeneous with z > 0, vertices (n, 3), `index` a number or (n,). In the plane of incidence the
    optical path is a convex function of the place x between the feet of both ends, and its derivative
    x / |(x, a)| - index (D - x) / |(D - x, b)| has one zero, which a bracketed Newton search finds to the last digit
    (squared it is the quartic x^2 ((D - x)^2 + b^2) = index^2 (D - x)^2 (x^2 + a^2)).
    """
    eyes = np.broadcast_to(eye, (len(vertices), 4))
    ratio = np.broadcast_to(np.asarray(index, np.float64), (len(vertices),))
    depth = -vertices[:, 2]
    is_near = eyes[:, 3] > 0.0
    # Horizontally from the vertex, so that an eye at infinity needs no foot.
    across = eyes[:, :2] - eyes[:, 3:] * vertices[:, :2]
    distance = np.linalg.norm(across, axis=1)
    towards = across / np.where(distance > 0.0, distance, 1.0)[:, None]
    height = eyes[:, 2]
    with np.errstate(invalid="ignore", divide="ignore"):
        # Of an eye at infinity: Snell's law gives the angle at once.
        sine = np.where(is_near, 0.0, distance / np.hypot(distance, height)) / ratio
        far = depth * sine / np.sqrt(1.0 - sine**2)
    low, high = np.zeros(len(vertices)), np.where(is_near, distance, 0.0)
    x = 0.5 * high
    for _ in range(POLISH):
        left = distance - x
        to_vertex, to_eye = np.hypot(x, depth), np.hypot(left, height)
        slope = ratio * x / to_vertex - left / to_eye
        low, high = np.where(slope <= 0.0, x, low), np.where(slope >= 0.0, x, high)
        newton = x - slope / (ratio * depth**2 / to_vertex**3 + height**2 / to_eye**3)
        x = np.where((newton > low) & (newton < high), newton, 0.5 * (low + high))
    offset = np.where(is_near, x, far)
    points = np.column_stack([vertices[:, :2] + offset[:, None] * towards, np.zeros(len(vertices))])
    points[~((depth > 0.0) & (height > 0.0))] = np.nan
    return points


def sphere_points(
    eye: Float64Array, vertices: Float64Array, radius: float, index: float | Float64Array, side: float = 1.0
) -> Float64Array:
    """Up to six refraction points (n, 6, 3) per vertex on the sphere about the origin, by angle from the eye; NaN else.

    eye (4,) or (n, 4) homogeneous, vertices (n, 3), `index` a number or (n,); `side` -1 for an eye inside. All are in
    the plane of eye, vertex and center, but for vertices in line with eye and center, whose other points are these
    turned about the line. With the direction of P at the angle t there, eye e (w = 1, or 0 at infinity) and vertex v at
    the angle g, in radii, the tangential parts of both legs cancel where
        e sin t / sqrt(e^2 + w - 2 w e cos t) = index v sin(g - t) / sqrt(v^2 + 1 - 2 v cos(g - t)).
    Squared that is a trigonometric polynomial of degree three, in z = exp(i t) a sextic; those of its roots on the unit
    circle that have the sign and see eye and vertex from their sides are polished by Newton on the angle.
    """
    count = len(vertices)
    eyes = np.broadcast_to(eye, (count, 4))
    ratio = np.broadcast_to(np.asarray(index, np.float64), (count,))[:, None]
    w = (eyes[:, 3] > 0.0).astype(np.float64)[:, None]
    to_eye = np.where(w > 0.0, eyes[:, :3] / radius, eyes[:, :3])
    to_vertex = vertices / radius
    x_axis = unit(to_eye)
    along = np.einsum("ij,ij->i", to_vertex, x_axis)
    across = to_vertex - along[:, None] * x_axis
    in_line = np.linalg.norm(across, axis=1) < 1e-14 * np.linalg.norm(to_vertex, axis=1)
    helper = np.where(np.abs(x_axis[:, :1]) < 0.9, np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 1.0, 0.0]]))
    y_axis = unit(np.where(in_line[:, None], np.cross(x_axis, helper), across))
    e = np.linalg.norm(to_eye, axis=1)[:, None]
    v = np.linalg.norm(to_vertex, axis=1)[:, None]
    g = np.arctan2(np.einsum("ij,ij->i", across, y_axis) * ~in_line, along)[:, None]

    def sides(t: Float64Array) -> tuple[Float64Array, ...]:
        """Tangential and normal parts of the unit legs, and their lengths."""
        x_eye, x_vertex = e * np.cos(t) - w, v * np.cos(g - t) - 1.0
        y_eye, y_vertex = -e * np.sin(t), v * np.sin(g - t)
        eye_length, vertex_length = np.hypot(x_eye, y_eye), np.hypot(x_vertex, y_vertex)
        eye_length, vertex_length = np.maximum(eye_length, 1e-300), np.maximum(vertex_length, 1e-300)
        return (
            y_eye / eye_length,
            y_vertex / vertex_length,
            x_eye / eye_length,
            x_vertex / vertex_length,
            eye_length,
            vertex_length,
        )

    angles = np.angle(_sextic_roots(e[:, 0], w[:, 0], v[:, 0], g[:, 0], ratio[:, 0]))
    for _ in range(POLISH):
        t_eye, t_vertex, c_eye, c_vertex, eye_length, vertex_length = sides(angles)
        mismatch = t_eye + ratio * t_vertex
        # Of a leg's tangential part: minus its normal part, plus what the point's own move turns of it.
        slope = -(c_eye + ratio * c_vertex) - w * c_eye**2 / eye_length - ratio * c_vertex**2 / vertex_length
        step = np.where(np.abs(slope) > 1e-13, mismatch / np.where(slope == 0.0, 1.0, slope), 0.0)
        angles = angles - np.clip(step, -ON_CIRCLE, ON_CIRCLE)
    t_eye, t_vertex, c_eye, c_vertex, *_ = sides(angles)
    kept = (np.abs(t_eye + ratio * t_vertex) < REAL * (1.0 + ratio)) & (side * c_eye > 0.0) & (side * c_vertex < 0.0)
    angles = np.where(kept, np.arctan2(np.sin(angles), np.cos(angles)), np.nan)
    angles = np.sort(angles, axis=1)
    angles[:, 1:][np.diff(angles, axis=1) < SAME] = np.nan
    angles = np.sort(angles, axis=1)
    return radius * (np.cos(angles)[..., None] * x_axis[:, None] + np.sin(angles)[..., None] * y_axis[:, None])


def _sextic_roots(
    e: Float64Array, w: Float64Array, v: Float64Array, g: Float64Array, ratio: Float64Array
) -> np.ndarray:
    """(n, 6) complex roots of e^2 sin^2 t |V-P|^2 - ratio^2 v^2 sin^2 (g-t) |E-P|^2 as a polynomial in exp(i t).

    Functions are (n, ...) coefficients of exp(i k t) from the lowest k to the highest.
    """
    one, turn = np.ones(len(e), complex), np.exp(1j * g)

    def squared_sine(turned: np.ndarray) -> np.ndarray:
        return np.stack([-0.25 * turned**2, 0.5 * one, -0.25 / turned**2], axis=1)

    def squared_length(far: Float64Array, weight: Float64Array, turned: np.ndarray) -> np.ndarray:
        return np.stack([-weight * far * turned, far**2 + weight, -weight * far / turned], axis=1)

    def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Of coefficients of k = -2, 0, 2 and of k = -1, 0, 1."""
        result = np.zeros((len(a), 7), complex)
        for i, place in enumerate((0, 2, 4)):
            result[:, place : place + 3] += a[:, i : i + 1] * b
        return result

    first = product(squared_sine(one), squared_length(v, np.ones(len(v)), turn)) * (e**2)[:, None]
    second = product(squared_sine(turn), squared_length(e, w, one)) * (ratio**2 * v**2)[:, None]
    polynomial = first - second
    polynomial /= np.abs(polynomial).max(axis=1, keepdims=True)
    # Where the leading coefficient is nothing its root is at infinity: on no unit circle.
    leading = polynomial[:, 6:]
    leading = np.where(np.abs(leading) < 1e-14, 1e-14, leading)
    companion = np.zeros((len(e), 6, 6), complex)
    companion[:, np.arange(1, 6), np.arange(5)] = 1.0
    companion[:, :, 5] = -polynomial[:, :6] / leading
    return np.linalg.eigvals(companion)
