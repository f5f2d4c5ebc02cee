# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Images that are searched in a picture, against all reflection points of the mesh and against the plane mirror."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.mesh_images import MeshImages
from curvrefl.curvrefl_addon.optics.surfaces.mesh_reflections import ReflectingMesh
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.mirror_room import radial_mesh
from scenes.views import look_at

VIEW = look_at(np.array([0.0, -5.0, 1.0]), np.zeros(3), 64, 48, 0.5)


def searched(images: MeshImages, view: View, shown: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, ...]:
    return images.places(view.eye, view.lines_of_sight, view.project, view.height, shown, start)


def test_images_on_a_ball_are_its_reflection_points() -> None:
    """From starts many triangles away; points near by, far off and infinitely far away."""
    mesh = radial_mesh(Ellipsoid(), 24)
    positions = mesh.positions[mesh.corner_vertex].astype(float)
    normals, triangles = mesh.corner_normals.astype(float), mesh.triangles.astype(int)
    images, all_of_them = MeshImages(positions, normals, triangles), ReflectingMesh(positions, normals, triangles)
    random = np.random.default_rng(2)
    shown = np.column_stack([random.uniform(-3.0, 3.0, (200, 3)) + np.array([0.0, -4.0, 3.0]), np.ones(200)])
    shown[:50, :3] *= 10.0
    shown[50:80, 3] = 0.0
    truth = all_of_them.points(VIEW.eye, shown)
    towards_eye = np.einsum("ij,ij->i", truth.normal, VIEW.place - truth.point) > 0.0
    on_front = towards_eye & (np.einsum("ij,ij->i", truth.normal, truth.point) > 0.0)
    rows, first = np.unique(truth.row[on_front], return_index=True)
    right = VIEW.project(truth.point[on_front][first])
    shown = shown[rows]
    assert len(rows) > 150
    place, seen, found = searched(images, VIEW, shown, right + random.uniform(-4.0, 4.0, right.shape))
    assert found.mean() > 0.97
    # (Where triangles meet at an angle a point may be shown twice.)
    off = np.full(len(rows), np.inf)
    for number, row in enumerate(rows):
        off[number] = np.linalg.norm(VIEW.project(truth.point[truth.row == row]) - place[number], axis=1).min()
    assert off[found].max() < 1e-5
    assert (np.linalg.norm(place - right, axis=1)[found] < 1e-5).mean() > 0.95
    np.testing.assert_allclose(VIEW.project(seen[found]), place[found], atol=1e-9)
    again, _, is_found = searched(images, VIEW, shown[found], place[found])
    assert is_found.all() and np.abs(again - place[found]).max() < 1e-6


def test_images_in_a_plane_are_those_of_the_mirrored_points() -> None:
    """Two large triangles; what starts beside the mirror, or is no number, is not found, nor what it cannot show."""
    corners = np.array([[-2.0, 1.0, -2.0], [2.0, 1.0, -2.0], [2.0, 1.0, 2.0], [-2.0, 1.0, 2.0]])
    normals = np.tile([0.0, -1.0, 0.0], (4, 1))
    images = MeshImages(corners, normals, np.array([[0, 1, 2], [0, 2, 3]]))
    shown = np.array([[0.3, -1.0, 0.5, 1.0]] * 4 + [[0.0, 30.0, 30.0, 1.0]])
    shown[3, 0] = np.nan
    expected = VIEW.project(np.array([[0.3, 3.0, 0.5]]))[0]
    start = np.array([expected + np.array([8.0, -5.0]), expected, [-500.0, 3.0], expected, expected])
    place, _, found = searched(images, VIEW, shown, start)
    assert found.tolist() == [True, True, False, False, False]
    np.testing.assert_allclose(place[:2], [expected] * 2, atol=1e-7)
