# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices beyond a surface of glass by construction: a line of sight first, then a vertex on the ray it becomes.

So one refraction point of every case is known without any search; others come from the oracle.
"""

from __future__ import annotations

import numpy as np

from ...optics.fermat import sample, towards_eye
from ...optics.snell import refracted
from ...optics.solvers.descent import tangent_frame
from ...optics.surfaces.radial_surfaces import Float64Array, unit
from .regimes import Cases, focal_distance
from .study_surfaces import Study

REFRACTION_REGIMES = (
    "inside",
    "behind",
    "far",
    "contact",
    "grazing",
    "silhouette",
    "hidden",
    "eye close",
    "caustic",
    "two or three images",
)
CANDIDATES = 16
"""Lines of sight that are tried for each case asked for"""

SHORTEST = 0.05


def make_refraction_cases(study: Study, regime: str, count: int, seed: int = 0) -> Cases:
    """Up to `count` vertices of a regime; none where the surface has none."""
    random = np.random.default_rng([seed, REFRACTION_REGIMES.index(regime)])
    surface, oracle = study.surface, study.oracle()
    eye = np.array([*study.eye, 1.0])
    if regime == "eye close":
        direction = unit(eye[None, :3])
        radius = surface.radius(study.side * direction)[0][0]
        eye[:3] = (1.03 if study.side > 0.0 else -0.97) * radius * study.side * direction[0]
    u = unit(random.normal(size=(CANDIDATES * count, 3)))
    if regime == "hidden":
        # Anywhere: in most places before, beside and behind.
        vertices = u * (surface.radius(u)[0] * np.exp(random.uniform(np.log(0.2), np.log(5.0), len(u))))[:, None]
        found = oracle.reflection_points(eye, vertices[: 4 * count])
        vertices = vertices[: 4 * count][np.bincount(found.vertex, minlength=4 * count) == 0][:count]
        return Cases(eye, vertices, np.full(vertices.shape, np.nan))
    point, ray, cosine = _rays(study, eye, u)
    kept = (cosine > 1e-3) & np.isfinite(ray[:, 0])
    kept[kept] = oracle.is_free(point[kept], np.tile(eye, (int(kept.sum()), 1)))
    chord = _chord(study, point, ray)
    distance = chord * random.uniform(0.05, 0.95, len(u))
    if regime == "inside":
        kept &= study.side > 0.0
    elif regime in ("behind", "two or three images") or study.side < 0.0:
        distance = chord + np.exp(random.uniform(np.log(0.1), np.log(3.0), len(u)))
    if regime == "far":
        distance = np.exp(random.uniform(np.log(10.0), np.log(100.0), len(u)))
    elif regime == "contact":
        height = np.exp(random.uniform(np.log(1e-3), np.log(2e-2), len(u)))
        normal = study.side * sample(surface, u).normal
        distance = height / np.maximum(-np.einsum("ij,ij->i", normal, ray), 0.05)
    elif regime == "grazing":
        kept &= (cosine > 0.02) & (cosine < 0.17)
    elif regime == "silhouette":
        kept &= cosine < 0.02
    elif regime == "caustic":
        distance = _focal(study, eye, u, ray, random) * random.uniform(0.95, 1.05, len(u))
        kept &= (distance > 1e-2) & (distance < 20.0)
    rows = np.flatnonzero(kept)[: count if regime != "two or three images" else 4 * count]
    vertices, point = point[rows] + distance[rows, None] * ray[rows], point[rows]
    if regime == "two or three images":
        several = np.flatnonzero(oracle.reflection_points(eye, vertices).counts(len(vertices)) > 1)[:count]
        vertices, point = vertices[several], point[several]
    return Cases(eye, vertices, point)


def _rays(study: Study, eye: Float64Array, u: Float64Array) -> tuple[Float64Array, Float64Array, Float64Array]:
    """Surface points (n, 3), refracted unit rays (n, 3), NaN where there is none, and cosines of incidence (n,)."""
    at = sample(study.surface, u)
    normal, to_eye = study.side * at.normal, towards_eye(eye, at.position)
    return at.position, refracted(to_eye, normal, study.index), np.einsum("ij,ij->i", normal, to_eye)


def _chord(study: Study, point: Float64Array, ray: Float64Array) -> Float64Array:
    """(n,) about how far rays (n, 3) from points (n, 3) stay inside: as in a ball about the star center, but no less
    than SHORTEST; 0 for an eye inside, whose rays leave."""
    along = -2.0 * np.einsum("ij,ij->i", point, np.nan_to_num(ray))
    return np.maximum(along, SHORTEST) if study.side > 0.0 else np.zeros(len(point))


def _focal(
    study: Study, eye: Float64Array, u: Float64Array, ray: Float64Array, random: np.random.Generator
) -> Float64Array:
    """(n,) along rays (n, 3) to one of the two places where neighbors cross; NaN or negative where there is none."""
    point, _, _ = _rays(study, eye, u)
    ray = np.nan_to_num(ray)
    delta = 1e-5
    moved = [_rays(study, eye, unit(u + delta * direction))[:2] for direction in tangent_frame(u)]
    return focal_distance(
        [(other - point) / delta for other, _ in moved],
        [(np.nan_to_num(other) - ray) / delta for _, other in moved],
        ray,
        random.random(len(u)) < 0.5,
    )
