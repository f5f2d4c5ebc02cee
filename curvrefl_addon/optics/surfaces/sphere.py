# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The reflection point on a sphere in closed form (Alhazen's problem), the check of every iterative solver."""

from __future__ import annotations

import numpy as np

from .radial_surfaces import Float64Array, unit


def reflection_points(eye: Float64Array, vertices: Float64Array, radius: float) -> Float64Array:
    """Outer reflection points (n, 3) on the sphere about the origin; NaN where the sphere hides the vertex.

    eye (3,) and vertices (n, 3) outside the sphere. In the plane of E, V and the center let z = exp(i t) be the
    direction of P, e and v the complex eye and vertex in units of the radius. The angles of incidence and reflection
    agree where (e - z)(v - z) / z^2 is real, which is the quartic
    conj(e v) z^4 - conj(e + v) z^3 + (e + v) z - e v = 0; its roots on the unit circle that see both E and V on the
    outer side are reflections, and for a sphere there is at most one. The root is polished by Newton on the angle.
    """
    to_eye = np.broadcast_to(eye / radius, vertices.shape)
    to_vertex = vertices / radius
    x_axis = unit(to_eye)
    side = to_vertex - np.einsum("ij,ij->i", to_vertex, x_axis)[:, None] * x_axis
    # A vertex in line with eye and center has no plane of its own: any plane through the line serves.
    in_line = np.linalg.norm(side, axis=1) < 1e-14 * np.linalg.norm(to_vertex, axis=1)
    helper = np.where(np.abs(x_axis[:, :1]) < 0.9, np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 1.0, 0.0]]))
    y_axis = unit(np.where(in_line[:, None], np.cross(x_axis, helper), side))
    e = np.einsum("ij,ij->i", to_eye, x_axis) + 0j
    v = np.einsum("ij,ij->i", to_vertex, x_axis) + 1j * np.einsum("ij,ij->i", to_vertex, y_axis) * ~in_line

    leading = np.conj(e * v)
    companion = np.zeros((len(v), 4, 4), complex)
    companion[:, 1, 0] = companion[:, 2, 1] = companion[:, 3, 2] = 1.0
    companion[:, 0, 3] = e * v / leading
    companion[:, 1, 3] = -(e + v) / leading
    companion[:, 3, 3] = np.conj(e + v) / leading
    roots = np.linalg.eigvals(companion)
    angle = np.angle(roots)

    def mismatch(t: Float64Array) -> Float64Array:
        z = np.exp(1j * t)
        product = (e[:, None] - z) * (v[:, None] - z) / z**2
        return product.imag / np.abs(product)

    for _ in range(6):
        step = 1e-6
        slope = (mismatch(angle + step) - mismatch(angle - step)) / (2 * step)
        # A flat spot (double root at the horizon) would throw the angle away; it is left as it is.
        move = np.where(np.abs(slope) > 1e-9, mismatch(angle) / np.where(slope == 0, 1, slope), 0.0)
        angle = angle - np.clip(move, -1e-2, 1e-2)
    z = np.exp(1j * angle)
    cosine_eye = ((e[:, None] - z) / z).real / np.abs(e[:, None] - z)
    cosine_vertex = ((v[:, None] - z) / z).real / np.abs(v[:, None] - z)
    real = np.abs(mismatch(angle)) < 1e-7
    # Reflection also needs eye and vertex on opposite sides of the normal: the signed sines cancel.
    sines = ((e[:, None] - z) / z).imag / np.abs(e[:, None] - z) + ((v[:, None] - z) / z).imag / np.abs(v[:, None] - z)
    score = np.where(real & (cosine_eye > 0) & (cosine_vertex > 0), -np.abs(sines), -np.inf)
    best = score.argmax(axis=1)
    rows = np.arange(len(v))
    chosen = z[rows, best]
    points = radius * (chosen.real[:, None] * x_axis + chosen.imag[:, None] * y_axis)
    points[~np.isfinite(score[rows, best])] = np.nan
    return points
