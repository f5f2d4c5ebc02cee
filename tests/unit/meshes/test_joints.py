# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Gaps, angles and differences of curvature at joints that are known."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.meshes.curvature import principal_curvatures
from curvrefl.curvrefl_addon.optics.meshes.cut_mesh import CutMesh, border_edges
from curvrefl.curvrefl_addon.optics.meshes.joints import GRADES, joints_of_borders, joints_of_edges
from scenes.inspected.analytic_surfaces import SURFACES
from scenes.inspected.profiles import arc, joined, swept

TOLERANCES = (1e-3, np.radians(0.1), 0.05)


@pytest.mark.parametrize(
    ("left", "right", "degrees", "grade"),
    [
        (0.0, 0.0, 0.0, "G2"),
        (0.0, 0.0, 30.0, "G0"),
        (0.0, 1.0, 0.0, "G1"),
        (0.5, 1.5, 0.0, "G1"),
        (1.0, -1.0, 0.0, "G1"),
        (0.8, 0.8, 0.0, "G2"),
        (1.0, 1.0, 1.0, "G0"),
        (-0.7, 0.4, 90.0, "G0"),
    ],
)
def test_arcs_that_meet(left: float, right: float, degrees: float, grade: str) -> None:
    made = joined(left, right, np.radians(degrees))
    found, left_out = joints_of_edges(made.positions, made.triangles, made.joint)
    assert left_out == 0
    assert len(found.angle) == len(made.joint)
    np.testing.assert_allclose(np.degrees(found.angle), degrees, atol=0.02)
    sides = np.sort(found.curvature, axis=1)
    np.testing.assert_allclose(sides, np.broadcast_to(np.sort([left, right]), sides.shape), atol=0.02)
    np.testing.assert_allclose(found.difference, abs(left - right), atol=0.02)
    assert {GRADES[number] for number in found.grades(*TOLERANCES)} == {grade}
    assert not found.gap.any()
    np.testing.assert_allclose(found.edges, made.positions[np.sort(made.joint, axis=1)])


@pytest.mark.parametrize("name", SURFACES)
def test_a_cut_through_one_smooth_surface_is_no_joint(name: str) -> None:
    """Each side is measured at its border, without the other: the error of the fits themselves."""
    made = SURFACES[name]()
    # (The first vertex inside is the second of the second row.)
    width = int(np.flatnonzero(made.inner)[0]) - 1
    column = width // 2
    line = np.arange(1, len(made.positions) // width - 1) * width + column
    edges = np.column_stack([line[:-1], line[1:]])
    found, _ = joints_of_edges(made.positions, made.triangles, edges)
    assert np.degrees(found.angle).max() < 0.02
    strongest = np.maximum(np.abs(made.largest), np.abs(made.smallest))[line].max()
    assert found.difference[1:-1].max() < 0.03 * strongest


def test_finer_meshes_are_measured_better() -> None:
    errors = []
    for count in (9, 17, 33):
        made = joined(0.5, 1.5, 0.0, count)
        found, _ = joints_of_edges(made.positions, made.triangles, made.joint)
        errors.append([np.abs(found.difference - 1.0).max(), found.angle.max()])
    assert (np.diff(np.log2(errors), axis=0) < -1.5).all(), "curvature by the square, the angle by the cube"


def test_jets_hold_at_a_border() -> None:
    made = SURFACES["torus"]()
    border = border_edges(made.triangles)
    mesh = CutMesh(made.positions, made.triangles, border)
    worst_normal, worst_curvature = 0.0, 0.0
    for side, vertex in enumerate(mesh.vertex_of_side.tolist()):
        if vertex not in border:
            continue
        jet = mesh.jet(side)
        assert jet is not None
        facing = jet.normal * np.sign(jet.normal @ made.normals[vertex])
        worst_normal = max(worst_normal, float(np.linalg.norm(facing - made.normals[vertex])))
        found = principal_curvatures(jet.tensor[None], jet.normal[None])
        worst_curvature = max(worst_curvature, abs(float(found.strongest[0]) - made.largest[vertex]))
    assert worst_normal < 1e-3
    assert worst_curvature < 0.02 * made.largest.max()


def test_edges_that_are_no_joints() -> None:
    """At a border, where three triangles meet, and one in the middle of a surface, which separates nothing."""
    made = joined(0.0, 0.0)
    border = border_edges(made.triangles)
    found, left_out = joints_of_edges(made.positions, made.triangles, border)
    assert (len(found.angle), left_out) == (0, len(border))
    fin = np.concatenate([made.triangles, [[*made.joint[3], len(made.positions)]]])
    positions = np.concatenate([made.positions, [[0.0, 0.0, 1.0]]])
    found, left_out = joints_of_edges(positions, fin, made.joint)
    assert (len(found.angle), left_out) == (len(made.joint) - 1, 1)
    alone, _ = joints_of_edges(made.positions, made.triangles, made.joint[5:6])
    assert np.isnan(alone.angle).all()
    assert alone.grades(*TOLERANCES).tolist() == [-1]


def test_a_crease_that_ends_inside() -> None:
    """Only its separated end is measured."""
    made = joined(0.0, 0.0, np.radians(20.0))
    found, _ = joints_of_edges(made.positions, made.triangles, made.joint[:6])
    # (Around its end triangles of both sides are neighbors: the last edges see less of the angle.)
    np.testing.assert_allclose(np.degrees(found.angle[:2]), 20.0, atol=0.5)
    assert np.isfinite(found.angle).all()


@pytest.mark.parametrize("gap", [0.0, 0.004])
def test_two_objects_that_touch(gap: float) -> None:
    """With vertices of their own along the joint."""
    left, triangles = swept(arc(-0.5, np.pi, 33)[::-1], rows=33)
    right, other_triangles = swept(arc(1.5, 0.0, 33) + np.array([gap, 0.0]), rows=47)
    found = joints_of_borders(left, triangles, right, other_triangles, reach=0.01)
    assert len(found.gap) == 32
    np.testing.assert_allclose(found.gap, gap, atol=1e-9)
    assert np.degrees(found.angle).max() < 0.1
    np.testing.assert_allclose(found.difference, 1.0, atol=0.03)
    assert {GRADES[number] for number in found.grades(*TOLERANCES)} == {"G1" if gap == 0.0 else "Gap"}


def test_objects_apart_or_without_a_border() -> None:
    left, triangles = swept(arc(0.0, np.pi, 9)[::-1], rows=9)
    assert len(joints_of_borders(left, triangles, left + 3.0, triangles, reach=0.01).gap) == 0
    tetrahedron = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    assert len(joints_of_borders(left, triangles, corners, tetrahedron, reach=10.0).gap) == 0


def test_too_few_triangles_for_curvature() -> None:
    """Two triangles: an angle, but nothing that bends."""
    positions = np.array([[0.0, 0, 0], [0, 1, 0], [-1, 0.5, 0], [1, 0.5, 0.5]])
    strip = np.concatenate([positions, [[0.0, -1, 0], [-1, -0.5, 0], [1, -0.5, 0.5]]])
    triangles = np.array([[0, 1, 2], [0, 3, 1], [4, 0, 5], [4, 6, 0], [0, 2, 5], [0, 6, 3]])
    found, _ = joints_of_edges(strip, triangles, np.array([[0, 1], [4, 0]]))
    assert np.isfinite(found.angle).all()
    assert np.isnan(found.curvature).all()
    assert set(found.grades(*TOLERANCES).tolist()) == {1}
