# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays against meshes, and the oracle's reflection points checked by tracing them."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.fermat import sample
from curvrefl.curvrefl_addon.optics.surfaces.mesh_rays import MeshRays, reflected_miss
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import STUDIES, Study


def mesh_of(study: Study, columns: int, rows: int) -> MeshRays:
    """Longitude and latitude with exact normals."""
    longitude = np.linspace(0.0, 2.0 * np.pi, columns + 1)
    latitude = np.linspace(-0.5 * np.pi, np.arcsin(min(study.rim, 1.0)), rows + 1)[:, None]
    ones = np.ones_like(longitude)
    u = np.stack(
        [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude) * ones], axis=-1
    ).reshape(-1, 3)
    radius, gradient = study.surface.radius(u)
    low = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    quads = np.column_stack([low, low + 1, low + columns + 2, low + columns + 1])
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return MeshRays(radius[:, None] * u, unit(radius[:, None] * u - gradient), triangles)


def test_first_hits_are_those_of_all_triangles() -> None:
    random = np.random.default_rng(0)
    positions = random.uniform(-1.0, 1.0, (300, 3))
    triangles = np.arange(300).reshape(-1, 3)
    mesh = MeshRays(positions, np.tile([0.0, 0.0, 1.0], (300, 1)), triangles)
    origins, directions = random.uniform(-2.0, 2.0, (400, 3)), unit(random.normal(size=(400, 3)))
    directions[:3] = np.eye(3)
    found = mesh.first_hits(origins, directions)
    singles = [MeshRays(positions, np.ones((300, 3)), triangle[None]) for triangle in triangles]
    distances = np.stack([single.first_hits(origins, directions).distance for single in singles])
    np.testing.assert_array_equal(found.distance, distances.min(axis=0))
    hit = np.isfinite(found.distance)
    assert 0.1 < hit.mean() < 0.9
    np.testing.assert_array_equal(found.triangle[hit], distances.argmin(axis=0)[hit])
    assert (found.triangle[~hit] == -1).all() and np.isnan(found.normal[~hit]).all()


@pytest.mark.parametrize("name", STUDIES)
def test_reflection_points_of_the_oracle_are_what_rays_meet(name: str) -> None:
    """All visible images of 2000 vertices. What is left is the mesh's: half the edge length, a quarter of it."""
    study = STUDIES[name]
    random = np.random.default_rng(4)
    count = 2000
    u = unit(random.normal(size=(count, 3)))
    vertices = u * (study.surface.radius(u)[0] * (1.0 + 10.0 ** random.uniform(-1.5, 1.0, count)))[:, None]
    if study.side < 0.0:
        vertices = np.abs(u) * 0.5 + [0.0, 0.0, 0.2]
    eye = np.array([*study.eye, 1.0])
    found = study.oracle().reflection_points(eye, vertices)
    points, seen = found.point[found.visible], vertices[found.vertex[found.visible]]
    assert len(points) > 0.3 * count
    at = sample(study.surface, unit(points))
    steep = study.side * np.einsum("ij,ij->i", at.normal, unit(eye[:3] - points)) > 0.2
    coarse, fine = (reflected_miss(mesh_of(study, n, n // 2), eye, points[steep], seen[steep]) for n in (192, 384))
    assert np.median(fine) < 2e-3
    assert np.percentile(fine, 95) < 0.04
    assert np.median(fine) < 0.35 * np.median(coarse)


def test_a_wrong_point_is_found_out() -> None:
    study = STUDIES["ellipsoid"]
    eye = np.array([*study.eye, 1.0])
    vertices = np.array([[3.0, -2.0, 0.5], [-1.0, -3.0, 1.0]])
    points = study.oracle().reflection_points(eye, vertices).first(2)
    mesh, up = mesh_of(study, 192, 96), np.array([0.0, 0.0, 1.0])
    assert reflected_miss(mesh, eye, points, vertices).max() < 0.01
    assert reflected_miss(mesh, eye, points + 0.05 * up, vertices).min() > 0.05
    assert np.isinf(reflected_miss(mesh, eye, points + 5.0 * up, vertices)).all()
