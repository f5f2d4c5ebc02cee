# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces with known curvature, as meshes with the exact normals."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

type Arrays = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Analytic:
    """A mesh over a grid of (u, v), and what its surface's curvature is at the vertices."""

    positions: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    largest: np.ndarray
    """(n,) principal curvatures by formulas of textbooks"""
    smallest: np.ndarray
    inner: np.ndarray
    """(n,) vertices that are not at the border"""


def grid(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Parameters (n,) of a grid's vertices, its triangles, and which vertices are inside."""
    columns, rows = len(u), len(v)
    number = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    inner = np.zeros((rows, columns), bool)
    inner[1:-1, 1:-1] = True
    uu, vv = np.meshgrid(u, v)
    return uu.ravel(), vv.ravel(), triangles, inner.ravel()


def unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def sphere(radius: float = 2.0, steps: int = 60) -> Analytic:
    u, v, triangles, inner = grid(np.linspace(0, 2, steps), np.linspace(-0.9, 0.9, steps))
    normals = np.column_stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)])
    same = np.full(len(u), 1.0 / radius)
    return Analytic(radius * normals, normals, triangles, same, same, inner)


def cylinder(radius: float = 0.5, steps: int = 60) -> Analytic:
    u, v, triangles, inner = grid(np.linspace(0, 2, steps), np.linspace(-1, 1, steps))
    normals = np.column_stack([np.cos(u), np.sin(u), np.zeros(len(u))])
    positions = radius * normals + np.column_stack([0 * u, 0 * u, v])
    return Analytic(positions, normals, triangles, np.full(len(u), 1.0 / radius), np.zeros(len(u)), inner)


def torus(ring: float = 2.0, tube: float = 0.6, steps: int = 120) -> Analytic:
    """Around z. Its principal curvatures are 1 / tube and cos v / (ring + tube cos v)."""
    u, v, triangles, inner = grid(np.linspace(0, 2, steps), np.linspace(-3.0, 3.0, 2 * steps))
    normals = np.column_stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)])
    middle = np.column_stack([np.cos(u), np.sin(u), np.zeros(len(u))])
    around = np.cos(v) / (ring + tube * np.cos(v))
    return Analytic(ring * middle + tube * normals, normals, triangles, np.full(len(u), 1.0 / tube), around, inner)


def ellipsoid(axes: tuple[float, float, float] = (1.0, 0.7, 1.6), steps: int = 160) -> Analytic:
    """Gaussian and mean curvature by the support function h = 1 / |(x / a^2, y / b^2, z / c^2)|:
    K = h^4 / (a b c)^2, H = h^3 (a^2 + b^2 + c^2 - |p|^2) / (2 (a b c)^2)."""
    u, v, triangles, inner = grid(np.linspace(0, 2, steps), np.linspace(-0.9, 0.9, steps))
    a = np.array(axes)
    positions = a * np.column_stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)])
    gradient = positions / a**2
    support = 1.0 / np.linalg.norm(gradient, axis=1)
    product = np.prod(a) ** 2
    gaussian = support**4 / product
    mean = support**3 * ((a**2).sum() - (positions**2).sum(1)) / (2.0 * product)
    spread = np.sqrt(np.maximum(mean**2 - gaussian, 0.0))
    return Analytic(positions, unit(gradient), triangles, mean + spread, mean - spread, inner)


def height_field(
    height: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, ...]], reach: float = 1.0, steps: int = 120
) -> Analytic:
    """z = f(x, y), normal upwards; `height` gives f, fx, fy, fxx, fxy, fyy. Curvature is positive where it bends down:
    K = (fxx fyy - fxy^2) / W^4, H = -((1 + fy^2) fxx - 2 fx fy fxy + (1 + fx^2) fyy) / (2 W^3)."""
    x, y, triangles, inner = grid(np.linspace(-reach, reach, steps), np.linspace(-reach, reach, steps))
    f, fx, fy, fxx, fxy, fyy = height(x, y)
    w = np.sqrt(1.0 + fx**2 + fy**2)
    gaussian = (fxx * fyy - fxy**2) / w**4
    mean = -((1 + fy**2) * fxx - 2 * fx * fy * fxy + (1 + fx**2) * fyy) / (2 * w**3)
    spread = np.sqrt(np.maximum(mean**2 - gaussian, 0.0))
    normals = np.column_stack([-fx, -fy, np.ones(len(x))]) / w[:, None]
    return Analytic(np.column_stack([x, y, f]), normals, triangles, mean + spread, mean - spread, inner)


def saddle(k: float = 0.8) -> Analytic:
    """z = k (x^2 - y^2) / 2"""
    zero = np.zeros
    return height_field(
        lambda x, y: (
            0.5 * k * (x * x - y * y),
            k * x,
            -k * y,
            np.full(len(x), k),
            zero(len(x)),
            np.full(len(x), -k),
        )
    )


SURFACES = {"sphere": sphere, "cylinder": cylinder, "torus": torus, "ellipsoid": ellipsoid, "saddle": saddle}
