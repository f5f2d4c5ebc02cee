# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices around a reflector by construction: a reflection point first, then a vertex on the ray it reflects.

So one right answer of every case is known without any search. Where a vertex has several images the others come from
the oracle.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...optics.fermat import sample, towards_eye
from ...optics.solvers.descent import tangent_frame
from ...optics.solvers.pierce import pierce
from ...optics.surfaces.radial_surfaces import Float64Array, unit
from .oracle import Oracle
from .study_surfaces import Study

REGIMES = (
    "far",
    "near",
    "contact",
    "grazing",
    "silhouette",
    "hidden",
    "eye close",
    "caustic",
    "two or three images",
    "axis, corner, pole",
)
MOST_TRIES = 40
BLOCK = 512
"""Candidates that are looked at together"""
MESH_VERTICES = 120
"""Of a small mesh, see `mesh_cases`"""
MESH_SIZE = 0.25
"""Its radius, of the distance to its reflection point"""


@dataclass(frozen=True)
class Cases:
    """n vertices of one regime; float64, relative to the star center. May hold fewer than were asked for, or none."""

    eye: Float64Array
    """(4,) homogeneous"""
    vertices: Float64Array
    """(n, 3)"""
    points: Float64Array
    """(n, 3) the reflection point each was made from; NaN where it has none"""


def make_cases(study: Study, regime: str, count: int, seed: int = 0) -> Cases:
    """Up to `count` vertices of a regime; none where the reflector has none (a caustic before a convex mirror)."""
    random = np.random.default_rng([seed, REGIMES.index(regime)])
    eye = np.array([*study.eye, 1.0])
    if regime == "eye close":
        # Over the point of the surface that the usual eye looks at.
        direction = unit(eye[None, :3])
        if study.side > 0.0:
            eye[:3] = (1.03 * study.surface.radius(direction)[0] * direction[0]).tolist()
        else:
            eye[:3] = -0.97 * study.surface.radius(-direction)[0] * direction[0]
    if regime == "hidden":
        return _hidden(study, eye, count, random)
    if regime == "two or three images":
        return _several(study, eye, count, random)
    if regime == "caustic":
        return _caustic(study, eye, count, random)
    oracle = study.oracle()
    vertices, points = [np.zeros((0, 3))], [np.zeros((0, 3))]
    found = 0
    for _ in range(MOST_TRIES):
        u = _special(random, count) if regime == "axis, corner, pole" else unit(random.normal(size=(4 * count, 3)))
        point, ray, cosine = _rays(study, eye, u)
        kept = cosine > 1e-4
        distance = np.exp(random.uniform(np.log(0.1), np.log(3.0), len(u)))
        if regime == "far":
            distance = np.exp(random.uniform(np.log(10.0), np.log(100.0), len(u)))
        elif regime == "contact":
            # Down to a thousandth over the surface, along rays that leave it steeply or not.
            height = np.exp(random.uniform(np.log(1e-3), np.log(2e-2), len(u)))
            distance = height / np.maximum(cosine, 0.05)
            kept &= cosine > 0.05
        elif regime == "grazing":
            kept &= (cosine > 0.02) & (cosine < 0.17)
        elif regime == "silhouette":
            kept &= cosine < 0.02
        vertex = point + distance[:, None] * ray
        vertex, point = _shown(study, oracle, eye, vertex[kept], point[kept], count - found)
        vertices.append(vertex)
        points.append(point)
        found += len(vertex)
        if found >= count:
            break
    return Cases(eye, np.concatenate(vertices), np.concatenate(points))


def mesh_cases(cases: Cases, meshes: int) -> Cases:
    """Small balls of MESH_VERTICES vertices each about up to `meshes` of a regime's vertices, one after the other.

    For methods that work on whole meshes. No reflection point is known by construction.
    """
    index = (np.arange(MESH_VERTICES) + 0.5) / MESH_VERTICES
    z, longitude = 1.0 - 2.0 * index, np.pi * (1.0 + np.sqrt(5.0)) * np.arange(MESH_VERTICES)
    ring = np.sqrt(1.0 - z**2)
    ball = np.column_stack([ring * np.cos(longitude), ring * np.sin(longitude), z])
    centers, points = cases.vertices[:meshes], cases.points[:meshes]
    # A hidden vertex has no reflection point.
    away = np.where(np.isnan(points), 0.5 * centers, points)
    radii = MESH_SIZE * np.linalg.norm(centers - away, axis=1)
    vertices = (centers[:, None] + radii[:, None, None] * ball).reshape(-1, 3)
    return Cases(cases.eye, vertices, np.full(vertices.shape, np.nan))


def _rays(study: Study, eye: Float64Array, u: Float64Array) -> tuple[Float64Array, Float64Array, Float64Array]:
    """Surface points (n, 3), reflected unit rays (n, 3) and cosines of incidence (n,)."""
    at = sample(study.surface, u)
    normal = study.side * at.normal
    to_eye = towards_eye(eye, at.position)
    cosine = np.einsum("ij,ij->i", normal, to_eye)
    return at.position, 2.0 * cosine[:, None] * normal - to_eye, cosine


def _special(random: np.random.Generator, count: int) -> Float64Array:
    """Directions exactly at axes, edges and corners of the cube and at poles, many times over."""
    grid = np.array(np.meshgrid(*[[-1.0, 0.0, 1.0]] * 3, indexing="ij")).reshape(3, -1).T
    chosen = unit(grid[np.abs(grid).sum(axis=1) > 0.0])
    return chosen[random.integers(len(chosen), size=4 * count)]


def _first(count: int, total: int, holds: Callable[[NDArray[np.int64]], NDArray[np.bool_]]) -> NDArray[np.int64]:
    """The first `count` of the rows 0 to `total` of which `holds` is true; it is asked of few rows at a time."""
    chosen = np.zeros(0, np.int64)
    for start in range(0, total, BLOCK):
        rows = np.arange(start, min(start + BLOCK, total))
        chosen = np.concatenate([chosen, rows[holds(rows)]])
        if len(chosen) >= count:
            break
    return chosen[:count]


def _shown(
    study: Study, oracle: Oracle, eye: Float64Array, vertex: Float64Array, point: Float64Array, count: int
) -> tuple[Float64Array, Float64Array]:
    """The first `count` vertices and points for which `_is_shown` is true."""
    chosen = _first(count, len(vertex), lambda here: _is_shown(study, oracle, eye, vertex[here], point[here]))
    return vertex[chosen], point[chosen]


def _is_shown(
    study: Study, oracle: Oracle, eye: Float64Array, vertex: Float64Array, point: Float64Array
) -> NDArray[np.bool_]:
    """(n,) whether points (n, 3) are on the mirror, with free ways to the eye and the vertices (n, 3)."""
    shown = study.cover(unit(point))
    for is_eye in (False, True):
        rows = np.flatnonzero(shown)
        end = np.tile(eye, (len(rows), 1)) if is_eye else np.column_stack([vertex[rows], np.ones(len(rows))])
        shown[rows] = oracle.is_free(point[rows], end)
    return shown


def _hidden(study: Study, eye: Float64Array, count: int, random: np.random.Generator) -> Cases:
    """Vertices that the reflector stands before, or that are inside it, and that have no reflection."""
    u = unit(random.normal(size=(8 * count, 3)))
    u = u[study.cover(u)]
    vertices = u * (study.surface.radius(u)[0] * np.exp(random.uniform(0.01, 1.5, len(u))))[:, None]
    if study.side > 0.0:
        vertices = vertices[pierce(study.surface, eye, vertices)[0]]
    oracle = study.oracle()
    vertices = vertices[
        _first(count, len(vertices), lambda here: oracle.reflection_points(eye, vertices[here]).counts(len(here)) == 0)
    ]
    return Cases(eye, vertices, np.full(vertices.shape, np.nan))


def _several(study: Study, eye: Float64Array, count: int, random: np.random.Generator) -> Cases:
    """Vertices that the oracle finds two or more visible images of."""
    none = np.zeros((0, 3))
    if not study.mixed:
        return Cases(eye, none, none)
    u = unit(random.normal(size=(8 * count, 3)))
    point, ray, cosine = _rays(study, eye, u)
    vertex = point + np.exp(random.uniform(np.log(0.3), np.log(10.0), len(u)))[:, None] * ray
    vertex, point = vertex[cosine > 1e-3], point[cosine > 1e-3]
    oracle = study.oracle()

    def has_several(here: NDArray[np.int64]) -> NDArray[np.bool_]:
        several = _is_shown(study, oracle, eye, vertex[here], point[here])
        rows = here[several]
        several[several] = oracle.reflection_points(eye, vertex[rows]).counts(len(rows)) > 1
        return several

    chosen = _first(count, len(vertex), has_several)
    return Cases(eye, vertex[chosen], point[chosen])


def _caustic(study: Study, eye: Float64Array, count: int, random: np.random.Generator) -> Cases:
    """Vertices within 5 percent of where neighboring reflected rays cross, before a mirror hollow there."""
    u = unit(random.normal(size=(16 * count, 3)))
    point, ray, cosine = _rays(study, eye, u)
    # Rays from the eye's neighborhood of u: dP + t dR loses rank where the pencil focuses.
    delta = 1e-5
    frame = tangent_frame(u)
    moved = [_rays(study, eye, unit(u + delta * direction)) for direction in frame]
    focal = focal_distance(
        [(other_point - point) / delta for other_point, _, _ in moved],
        [(other_ray - ray) / delta for _, other_ray, _ in moved],
        ray,
        random.random(len(u)) < 0.5,
    )
    vertex = point + (focal * random.uniform(0.95, 1.05, len(u)))[:, None] * ray
    kept = (cosine > 1e-2) & (focal > 1e-2) & (focal < 20.0)
    return Cases(eye, *_shown(study, study.oracle(), eye, vertex[kept], point[kept], count))


def focal_distance(
    points: Sequence[Float64Array], rays: Sequence[Float64Array], ray: Float64Array, is_farther: NDArray[np.bool_]
) -> Float64Array:
    """(n,) along unit rays (n, 3) to where neighbors cross them; NaN where there is no such place.

    `points` and `rays`: derivatives (n, 3) of where rays start and of their directions, by two directions of the
    surface. dP + t dR loses rank across the ray at two distances; `is_farther` (n,) takes the root with the positive
    sign.
    """
    across = tangent_frame(ray)
    a = np.empty((len(ray), 2, 2))
    b = np.empty((len(ray), 2, 2))
    for column in range(2):
        for row, axis in enumerate(across):
            a[:, row, column] = np.einsum("ij,ij->i", points[column], axis)
            b[:, row, column] = np.einsum("ij,ij->i", rays[column], axis)
    # det(A + t B) = 0
    first, last = np.linalg.det(a), np.linalg.det(b)
    middle = a[:, 0, 0] * b[:, 1, 1] + a[:, 1, 1] * b[:, 0, 0] - a[:, 0, 1] * b[:, 1, 0] - a[:, 1, 0] * b[:, 0, 1]
    square = middle**2 - 4.0 * first * last
    root = np.where(is_farther, 1.0, -1.0) * np.sqrt(np.maximum(square, 0.0))
    return np.where(square >= 0.0, (-middle + root) / np.where(last == 0.0, 1e-30, 2.0 * last), np.nan)
