# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Star centers of meshes whose kernel is known."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid
from curvrefl.curvrefl_addon.optics.surfaces.star_center import MAX_TRIANGLES, find_star_center, solid_angles
from curvrefl.curvrefl_addon.scene.arrays import MeshArrays
from scenes.star_meshes import corner_block, inverted, joined, moved, star_mesh, torus

ORIGIN = np.zeros(3)


def corners_of(mesh: MeshArrays) -> np.ndarray:
    return mesh.positions[mesh.corner_vertex[mesh.triangles]].astype(np.float64)


def test_solid_angles_of_a_closed_mesh_sum_up() -> None:
    corners = corners_of(star_mesh(Bumpy(0.3), 24))
    assert solid_angles(corners).sum() == pytest.approx(4.0 * np.pi)
    assert solid_angles(corners - np.array([0.1, -0.2, 0.3])).sum() == pytest.approx(4.0 * np.pi)
    assert solid_angles(corners - np.array([3.0, 0.0, 0.0])).sum() == pytest.approx(0.0, abs=1e-9)


def test_solid_angle_of_an_octant() -> None:
    octant = np.eye(3)[None]
    assert solid_angles(octant)[0] == pytest.approx(0.5 * np.pi)
    assert solid_angles(7.0 * octant[:, ::-1])[0] == pytest.approx(-0.5 * np.pi)


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e5])
def test_a_ball_far_from_its_origin(scale: float) -> None:
    mesh = moved(star_mesh(Ellipsoid(), 24), (5.0 * scale, 3.0 * scale, -scale), scale)
    found = find_star_center(corners_of(mesh), ORIGIN)
    assert found.misfit < 1e-3
    assert found.worst_cosine > 0.9
    np.testing.assert_allclose(found.position / scale, [5.0, 3.0, -1.0], atol=0.1)


@pytest.mark.parametrize("inside_out", [False, True])
@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.0), (-10.0, 4.0, 6.0)])
def test_the_kernel_of_a_corner_block_is_found(offset: tuple[float, float, float], inside_out: bool) -> None:
    """All plain candidates miss it, but for the origin, which is on its rim at best."""
    mesh = moved(corner_block(), offset)
    found = find_star_center(corners_of(inverted(mesh) if inside_out else mesh), ORIGIN)
    assert found.name == "moved into the kernel"
    assert found.misfit < 1e-6
    inside = found.position - np.array(offset)
    assert (inside > 0.25).all() and (inside < 0.75).all()


def test_the_origin_is_kept_where_nothing_is_better() -> None:
    found = find_star_center(corners_of(star_mesh(Ellipsoid(), 24)), ORIGIN)
    assert np.linalg.norm(found.position) < 1e-6
    assert found.worst_cosine == pytest.approx(1.0, abs=0.01)


def test_a_large_mesh_is_judged_by_a_part_of_it() -> None:
    mesh = moved(star_mesh(Bumpy(0.2), 120), (0.0, 7.0, 0.0))
    assert len(mesh.triangles) > MAX_TRIANGLES
    found = find_star_center(corners_of(mesh), ORIGIN)
    assert found.misfit < 0.02
    assert np.linalg.norm(found.position - np.array([0.0, 7.0, 0.0])) < 0.3


def test_what_is_not_star_shaped_says_so() -> None:
    ball = star_mesh(Ellipsoid(), 16)
    two = find_star_center(corners_of(joined(moved(ball, (2.0, 0.0, 0.0)), moved(ball, (-2.0, 0.0, 0.0)))), ORIGIN)
    ring = find_star_center(corners_of(torus(1.0, 0.3)), ORIGIN)
    assert two.misfit > 0.05 and two.worst_cosine < 0.0
    assert ring.misfit > 0.05 and ring.worst_cosine < 0.0


def test_triangles_without_area_do_not_matter() -> None:
    corners = corners_of(star_mesh(Ellipsoid(), 16))
    slivers = np.repeat(corners[:50, :1], 3, axis=1)
    found = find_star_center(np.concatenate([corners, slivers]), ORIGIN)
    assert found.misfit < 1e-3 and found.worst_cosine > 0.9
