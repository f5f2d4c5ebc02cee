# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sections of surfaces with closed forms, and the curvature of the plane curves."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.meshes.curvature import curvature_tensors
from curvrefl.curvrefl_addon.optics.meshes.sections import Section, sections
from scenes.inspected.analytic_surfaces import Analytic, cylinder, ellipsoid, saddle, sphere, torus, unit

Z = np.array([0.0, 0.0, 1.0])


def cut(made: Analytic, origin: tuple[float, ...], plane: tuple[float, ...] | np.ndarray) -> list[Section]:
    tensors = curvature_tensors(made.positions, made.normals, made.triangles)
    across = np.array(plane, float)
    return sections(
        made.positions, made.normals, tensors, made.triangles, np.array(origin), across / np.linalg.norm(across)
    )


def assert_close(found: np.ndarray, wanted: np.ndarray | float) -> None:
    # (Not the very ends, where a border's vertices know one side alone.)
    assert len(found) > 20
    assert (np.abs(found - wanted) / np.abs(wanted))[2:-2].max() < 0.01


@pytest.mark.parametrize("height", [0.0, 0.7, -1.2])
def test_circles_of_a_sphere_off_its_center(height: float) -> None:
    (section,) = cut(sphere(), (0.0, 0.0, height), Z)
    assert_close(section.curvature, 1.0 / np.sqrt(4.0 - height**2))
    assert not section.is_closed
    assert np.abs(section.points[:, 2] - height).max() < 1e-12
    np.testing.assert_allclose(section.length, 2.0 * np.sqrt(4.0 - height**2), rtol=1e-3)


def test_a_torus_has_its_circles() -> None:
    made = torus()
    both = cut(made, (0.0, 0.0, 0.0), Z)
    # v runs from -3 to 3: only the outer circle is there, and around it nothing.
    assert_close(both[0].curvature, 1.0 / 2.6)
    (around_tube,) = cut(made, (0.0, 0.0, 0.0), (-np.sin(1.0), np.cos(1.0), 0.0))
    assert_close(around_tube.curvature, 1.0 / 0.6)


def test_the_inside_of_a_ring_bends_inwards() -> None:
    made = torus()
    found = cut(made, (0.0, 0.0, 0.6 * np.sin(2.5)), Z)
    inner = min(found, key=lambda section: float(np.hypot(*section.points[0, :2])))
    # The section is a circle of radius 2 + 0.6 cos 2.5 about the axis, whose center is on the normal's side.
    assert_close(inner.curvature, -1.0 / (2.0 + 0.6 * np.cos(2.5)))


def test_an_ellipse() -> None:
    a, b = 1.0, 0.7
    (section,) = cut(ellipsoid((a, b, 1.6)), (0.0, 0.0, 0.0), Z)
    cosine, sine = section.points[:, 0] / a, section.points[:, 1] / b
    assert_close(section.curvature, a * b / (a**2 * sine**2 + b**2 * cosine**2) ** 1.5)


def test_an_oblique_plane_cuts_an_ellipse_out_of_a_cylinder() -> None:
    """Meusnier: the normal curvature alone would be too small."""
    r = 0.5
    (section,) = cut(cylinder(r), (0.0, 0.0, 0.0), (0.0, -1.0, 1.0))
    cosine, sine = section.points[:, 0] / r, section.points[:, 1] / r
    a, b = r, r * np.sqrt(2.0)
    assert_close(section.curvature, a * b / (a**2 * sine**2 + b**2 * cosine**2) ** 1.5)


def test_a_parabola_bends_towards_the_normal() -> None:
    (section,) = cut(saddle(0.8), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    x = section.points[:, 0]
    assert_close(section.curvature, -0.8 / (1.0 + (0.8 * x) ** 2) ** 1.5)
    np.testing.assert_allclose(section.outwards[:, 1], 0.0, atol=1e-12)
    assert (section.outwards[:, 2] > 0.7).all()


def test_a_closed_curve_is_resampled_all_around() -> None:
    steps = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    circle = np.column_stack([np.cos(steps), np.sin(steps), 0 * steps])
    number = np.arange(40)
    after = (number + 1) % 40
    low, high = circle - 0.5 * Z, circle + 0.5 * Z
    triangles = np.concatenate(
        [np.column_stack([number, after, after + 40]), np.column_stack([number, after + 40, number + 40])]
    )
    normals = np.concatenate([circle, circle])
    tensors = np.tile([0.0] * 6, (80, 1))
    (section,) = sections(np.concatenate([low, high]), normals, tensors, triangles, np.zeros(3), Z)
    assert section.is_closed
    even = section.resampled(16)
    assert len(even.points) == 16 and even.is_closed
    gaps = np.linalg.norm(np.roll(even.points, -1, axis=0) - even.points, axis=1)
    assert gaps.max() < 1.02 * gaps.min()


def test_where_the_plane_only_touches_there_is_no_curvature() -> None:
    made = sphere()
    top = cut(made, (0.0, 0.0, 2.0 * np.sin(0.9) - 1e-9), Z)
    assert all(np.isfinite(section.curvature).all() for section in top), "a small circle is one"
    # A vertex whose normal is that of the plane.
    flat = np.array([[-1.0, 0, 0], [1, 0, 0], [0, 1, 0.5], [0, -1, -0.5]])
    normals = np.tile(Z, (4, 1))
    (section,) = sections(flat, normals, np.ones((4, 6)), np.array([[0, 1, 2], [0, 3, 1]]), np.zeros(3) + 0.1 * Z, Z)
    assert np.isnan(section.curvature).all()


def test_a_corner_that_the_plane_touches_is_no_section() -> None:
    tip = np.array([[0.0, 0, 0], [1, 0, -1], [0, 1, -1], [-1, -1, -1]])
    fan = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1]])
    assert sections(tip, np.tile(Z, (4, 1)), np.zeros((4, 6)), fan, np.zeros(3), Z) == []
    (section,) = sections(tip, np.tile(unit(Z + 0.1), (4, 1)), np.zeros((4, 6)), fan, -1e-3 * Z, Z)
    assert section.is_closed and len(section.points) == 3


def test_a_plane_beside_the_mesh_cuts_nothing_and_a_cut_along_vertices_is_whole() -> None:
    assert cut(sphere(), (0.0, 0.0, 5.0), Z) == []
    (section,) = cut(sphere(steps=61), (0.0, 0.0, 0.0), Z)
    np.testing.assert_allclose(section.length, 4.0, rtol=1e-3)
