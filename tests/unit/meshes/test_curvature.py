# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature at vertices against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.meshes.curvature import (
    CurvatureSum,
    applied,
    curvature_tensors,
    normal_curvature,
    principal_curvatures,
    tangent_axes,
)
from scenes.inspected.analytic_surfaces import SURFACES, Analytic, cylinder, sphere, torus

ONE_PERCENT = 0.01


@pytest.mark.parametrize("name", SURFACES)
def test_within_a_percent_of_the_closed_forms(name: str) -> None:
    """Of the strongest curvature there is, and where it does not vanish of the value itself."""
    made = SURFACES[name]()
    tensors = curvature_tensors(made.positions, made.normals, made.triangles)
    found = principal_curvatures(tensors, made.normals)
    inner = made.inner
    assert inner.sum() > 1000
    strongest = np.maximum(np.abs(made.largest), np.abs(made.smallest))
    for ours, exact, scale in (
        (found.largest, made.largest, strongest),
        (found.smallest, made.smallest, strongest),
        (found.mean, 0.5 * (made.largest + made.smallest), strongest),
        (found.gaussian, made.largest * made.smallest, strongest**2),
        (found.strongest, strongest, strongest),
    ):
        assert (np.abs(ours - exact) / scale)[inner].max() < ONE_PERCENT
        firm = inner & (np.abs(exact) > 0.3 * scale)
        assert (np.abs(ours - exact) / np.abs(exact).clip(1e-12))[firm].max(initial=0.0) < ONE_PERCENT
    assert np.abs(applied(tensors, made.normals)).max() < 1e-12 * strongest.max(), "a tensor of the tangent plane"


def test_directions_of_a_cylinder_and_a_torus() -> None:
    for made, around in ((cylinder(), True), (torus(), False)):
        tensors = curvature_tensors(made.positions, made.normals, made.triangles)
        direction = principal_curvatures(tensors, made.normals).direction
        flat = made.positions * [1, 1, 0]
        ring = np.cross([0.0, 0.0, 1.0], flat / np.linalg.norm(flat, axis=1, keepdims=True))
        along = np.abs((direction * ring).sum(1))[made.inner]
        # A cylinder bends most around its axis, this torus most around its tube.
        assert (along > 0.999).all() if around else (along < 0.05).all()


def test_euler_on_a_torus() -> None:
    """Curvature along a tangent at the angle t is k1 cos^2 t + k2 sin^2 t."""
    made = torus()
    tensors = curvature_tensors(made.positions, made.normals, made.triangles)
    found = principal_curvatures(tensors, made.normals)
    other = np.cross(made.normals, found.direction)
    tangent = np.cos(0.7) * found.direction + np.sin(0.7) * other
    wanted = np.cos(0.7) ** 2 * made.largest + np.sin(0.7) ** 2 * made.smallest
    assert np.abs(normal_curvature(tensors, tangent) - wanted)[made.inner].max() < ONE_PERCENT * made.largest.max()


def turned_inside_out(made: Analytic) -> np.ndarray:
    return curvature_tensors(made.positions, -made.normals, made.triangles)


def test_sign_goes_with_the_normal_not_with_the_winding() -> None:
    made = torus()
    tensors = curvature_tensors(made.positions, made.normals, made.triangles)
    np.testing.assert_allclose(turned_inside_out(made), -tensors, atol=1e-12)
    np.testing.assert_allclose(
        curvature_tensors(made.positions, made.normals, made.triangles[:, (0, 2, 1)]), tensors, atol=1e-9
    )


@pytest.mark.parametrize("scale", [1e-5, 1e5])
def test_curvature_is_one_over_length(scale: float) -> None:
    made = sphere()
    tensors = curvature_tensors(scale * made.positions + 3.0 * scale, made.normals, made.triangles)
    plain = curvature_tensors(made.positions, made.normals, made.triangles)
    np.testing.assert_allclose(scale * tensors, plain, atol=1e-7)


def test_a_few_triangles_at_a_time_and_slivers() -> None:
    made = sphere()
    whole = curvature_tensors(made.positions, made.normals, made.triangles)
    # Triangles without a plane, one of them a point, say nothing; a vertex that has only such is flat.
    lonely = len(made.positions)
    positions = np.concatenate([made.positions, made.positions[:1]])
    normals = np.concatenate([made.normals, made.normals[:1]])
    slivers = np.array([[0, 1, 1], [5, 5, 5], [0, 0, lonely]])
    found = CurvatureSum(positions, normals, np.concatenate([made.triangles, slivers]))
    steps = 0
    while not found.is_complete:
        found.add_some(1000)
        steps += 1
    assert steps == -(-(len(made.triangles) + 3) // 1000)
    np.testing.assert_allclose(found.tensors()[:lonely], whole, atol=1e-12)
    assert not found.tensors()[lonely].any()


def test_axes_across_any_normal() -> None:
    normals = np.random.default_rng(1).normal(size=(500, 3))
    normals[0], normals[1] = (0, 0, -1), (0, 0, 1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    frames = np.stack([*tangent_axes(normals), normals], axis=1)
    np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), np.broadcast_to(np.eye(3), (500, 3, 3)), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0, atol=1e-12)
