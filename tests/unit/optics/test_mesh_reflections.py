# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflection points on meshes against closed forms, the oracle of smooth surfaces, and what rays meet."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.mesh_reflections import ReflectingMesh
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import STUDIES, Study


def mesh_of(study: Study, columns: int, rows: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions, exact normals, triangles by longitude and latitude."""
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
    return radius[:, None] * u, unit(radius[:, None] * u - gradient), triangles


SQUARE = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
UP = np.tile([0.0, 0.0, 1.0], (4, 1))
HALVES = np.array([[0, 1, 2], [0, 2, 3]])


def test_a_flat_mirror_has_one_where_the_mirrored_point_is_seen() -> None:
    """Two large triangles; from above and from below; what is on the other side, or seen past the rim, has none."""
    mesh = ReflectingMesh(SQUARE, UP, HALVES)
    random = np.random.default_rng(1)
    shown = np.column_stack([random.uniform(-3.0, 3.0, (400, 2)), random.uniform(0.1, 2.0, 400), np.ones(400)])
    for side in (1.0, -1.0):
        eye = np.array([0.3, -0.4, 0.7 * side, 1.0])
        there = shown * [1.0, 1.0, side, 1.0]
        share = eye[2] / (eye[2] + there[:, 2])
        point = eye[:2] + share[:, None] * (there[:, :2] - eye[:2])
        inside = (np.abs(point) < 1.0).all(axis=1)
        assert 50 < inside.sum() < 350
        found = mesh.points(eye, there)
        np.testing.assert_array_equal(found.row, np.flatnonzero(inside))
        np.testing.assert_allclose(found.point[:, :2], point[inside], atol=1e-9)
        np.testing.assert_allclose(found.normal, np.tile([0.0, 0.0, side], (inside.sum(), 1)), atol=1e-12)
        assert len(mesh.points(eye, there * [1.0, 1.0, -1.0, 1.0]).row) == 0


def test_what_is_infinitely_far_away() -> None:
    mesh = ReflectingMesh(SQUARE, UP, HALVES)
    eye, sun = np.array([0.3, -0.4, 1.0, 1.0]), unit(np.array([[0.2, 0.1, 1.0]]))
    found = mesh.points(eye, np.column_stack([sun, [0.0]]))
    np.testing.assert_allclose(found.point, [[0.3 + 0.2, -0.4 + 0.1, 0.0]], atol=1e-9)
    away = np.append(unit(np.array([0.2, -0.1, 1.0])), 0.0)
    shown = np.array([[0.3, 0.2, 0.5, 1.0]])
    np.testing.assert_allclose(mesh.points(away, shown).point, [[0.3 + 0.1, 0.2 - 0.05, 0.0]], atol=1e-9)


def test_a_corner_of_two_flat_mirrors_has_two_images_and_an_edge_none_twice() -> None:
    positions = np.array([[0, 0, 0], [2, 0, 0], [2, 0, 2], [0, 0, 2], [0, 2, 0], [0, 2, 2]], float)
    normals = np.repeat([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]], 4, axis=0)
    first = ReflectingMesh(positions[[0, 1, 2, 3, 0, 4, 5, 3]], normals, np.concatenate([HALVES, HALVES + 4]))
    found = first.points(np.array([1.0, 0.9, 1.0, 1.0]), np.array([[0.7, 1.0, 1.2, 1.0], [1.0, 0.9, 1.0, 1.0]]))
    assert found.row.tolist() == [0, 0, 1, 1]
    # On the diagonal of a square, which both triangles have.
    mesh = ReflectingMesh(SQUARE, UP, HALVES)
    assert len(mesh.points(np.array([0.2, 0.2, 1.0, 1.0]), np.array([[-0.4, -0.4, 1.0, 1.0]])).row) == 1


@pytest.mark.parametrize("name", ["sphere", "strongly bumpy", "bowl"])
def test_meshes_have_the_images_of_the_surfaces_that_they_stand_for(name: str) -> None:
    study = STUDIES[name]
    random = np.random.default_rng(5)
    u = unit(random.normal(size=(300, 3)))
    vertices = u * (study.surface.radius(u)[0] * random.uniform(1.3, 4.0, 300))[:, None]
    if study.side < 0.0:
        vertices = np.abs(u) * 0.5 + [0.0, 0.0, 0.2]
    eye = np.array([*study.eye, 1.0])
    oracle = study.oracle().reflection_points(eye, vertices)
    wanted = np.bincount(oracle.vertex[oracle.visible], minlength=300)
    mesh = ReflectingMesh(*mesh_of(study, 128, 64))
    found = mesh.points(eye, np.insert(vertices, 3, 1.0, axis=1))
    # (Hidden ones among the mesh's own are not told from the others here: each of the oracle's is there.)
    is_there = []
    for vertex, point in zip(oracle.vertex[oracle.visible], oracle.point[oracle.visible], strict=True):
        near = found.point[found.row == vertex]
        is_there.append(len(near) > 0 and np.linalg.norm(near - point, axis=1).min() < 0.03)
    assert wanted.sum() > 100
    assert np.mean(is_there) > 0.985
    if name == "sphere":
        # Of a ball each point outside has one on the side of both and one on the far side, seen from inside.
        assert np.percentile(np.bincount(found.row, minlength=300), [5, 95]).tolist() == [2.0, 2.0]


def test_reflection_points_reflect() -> None:
    study = STUDIES["strongly bumpy"]
    mesh = ReflectingMesh(*mesh_of(study, 96, 48))
    eye = np.array([*study.eye, 1.0])
    shown = np.column_stack([np.random.default_rng(2).uniform(2.0, 3.0, (200, 3)), np.ones(200)])
    found = mesh.points(eye, shown)
    assert len(found.row) > 400
    to_eye, to_shown = unit(eye[:3] - found.point), unit(shown[found.row, :3] - found.point)
    mirrored = 2.0 * np.einsum("ij,ij->i", to_eye, found.normal)[:, None] * found.normal - to_eye
    assert np.linalg.norm(mirrored - to_shown, axis=1).max() < 1e-8
