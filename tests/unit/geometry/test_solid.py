# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that bound a solid, and those that only look like it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid
from curvrefl.curvrefl_addon.renderer.geometry.solid import has_no_boundary, solid_side
from curvrefl.curvrefl_addon.scene.arrays import MeshArrays
from scenes.mirror_room import radial_mesh
from scenes.star_meshes import inverted, torus, welded


def ball() -> MeshArrays:
    return welded(radial_mesh(Ellipsoid(1.0, 0.5, 0.25), 32))


def with_triangles(mesh: MeshArrays, triangles: np.ndarray) -> MeshArrays:
    return replace(mesh, triangles=triangles, triangle_slot=mesh.triangle_slot[: len(triangles)])


def test_star_shaped_meshes_are_solids() -> None:
    assert solid_side(ball()) == 1
    assert solid_side(welded(radial_mesh(Bumpy(0.3), 32))) == 1


def test_inside_out() -> None:
    assert solid_side(inverted(ball())) == -1


def test_open_and_empty() -> None:
    mesh = ball()
    assert solid_side(with_triangles(mesh, mesh.triangles[1:])) == 0
    assert solid_side(with_triangles(mesh, mesh.triangles[:0])) == 0


def test_one_triangle_turned_over() -> None:
    mesh = ball()
    triangles = mesh.triangles.copy()
    triangles[7] = triangles[7, ::-1]
    assert solid_side(with_triangles(mesh, triangles)) == 0


def test_closed_but_not_seen_whole_from_its_middle() -> None:
    ring = torus(1.0, 0.3)
    assert has_no_boundary(ring.corner_vertex[ring.triangles])
    assert solid_side(ring) == 0


def test_boundary_of_single_triangles() -> None:
    assert not has_no_boundary(np.array([[0, 1, 2]], np.int32))
    assert has_no_boundary(np.array([[0, 1, 2], [2, 1, 0]], np.int32))
    assert not has_no_boundary(np.array([[0, 1, 2], [2, 1, 3]], np.int32))
