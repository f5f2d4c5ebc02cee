# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Splitting keeps area, attributes and conformity."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.geometry.split import (
    SOON,
    has_long_edges,
    longest_edge,
    share_of_step,
    split_angle,
    split_mesh,
)
from curvrefl.curvrefl_addon.scene.arrays import MeshArrays


def floor(size: float, height: float) -> MeshArrays:
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], np.float32) * size
    return MeshArrays(
        name="floor",
        positions=np.column_stack([corners, np.full(4, height)]).astype(np.float32),
        corner_vertex=np.arange(4, dtype=np.int32),
        corner_normals=np.tile(np.array([0, 0, 1], np.float32), (4, 1)),
        corner_uv=(corners / size).astype(np.float32),
        triangles=np.array([[0, 1, 2], [0, 2, 3]], np.int32),
        triangle_slot=np.array([3, 4], np.int32),
    )


def split(mesh: MeshArrays, angle: float, most_triangles: int = 4_000_000) -> MeshArrays:
    """About the origin."""
    return split_mesh(mesh, mesh.positions, angle, most_triangles)[0]


def places(mesh: MeshArrays) -> np.ndarray:
    return mesh.positions[mesh.corner_vertex[mesh.triangles]].astype(np.float64)


def test_area_and_orientation_are_kept() -> None:
    result = split(floor(6.0, -1.0), 0.1)
    p = places(result)
    areas = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])[:, 2] / 2
    assert (areas > 0).all()
    assert areas.sum() == pytest.approx(144.0, rel=1e-5)
    assert areas[result.triangle_slot == 3].sum() == pytest.approx(72.0, rel=1e-5)


def test_no_edge_is_left_long() -> None:
    before = floor(6.0, -1.0)
    assert has_long_edges(before, before.positions, 0.1)
    result = split(before, 0.1)
    assert not has_long_edges(result, result.positions, 0.1)
    p = places(result)
    edges = np.roll(p, -1, axis=1) - p
    along = np.clip(-(p * edges).sum(-1) / (edges**2).sum(-1), 0, 1)
    distance = np.linalg.norm(p + along[..., None] * edges, axis=-1)
    assert (np.linalg.norm(edges, axis=-1) <= 0.1001 * distance).all()


def test_longest_edge() -> None:
    assert longest_edge(floor(6.0, -1.0)) == pytest.approx(12.0 * np.sqrt(2.0))


def test_no_cracks() -> None:
    result = split(floor(6.0, -1.0), 0.15)
    t = result.corner_vertex[result.triangles]
    edges = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    assert counts.max() == 2
    border = result.positions[unique[counts == 1]]
    on_rim = np.isclose(np.abs(border[..., :2]), 6.0).any(axis=2)
    assert on_rim.all(), "an edge with one triangle inside the floor is a crack"


def test_attributes_are_the_unsplit_ones() -> None:
    result = split(floor(6.0, -1.0), 0.2)
    np.testing.assert_allclose(result.corner_uv, result.positions[result.corner_vertex, :2] / 6.0, atol=1e-6)


def test_object_space_is_split_as_the_placed_mesh() -> None:
    """The placed mesh decides where; what is split is the mesh in its own space."""
    mesh = floor(1.0, 0.0)
    placed = mesh.positions * 6.0 - np.array([0, 0, 1], np.float32)
    result, parents = split_mesh(mesh, placed, 0.15)
    other = split(floor(6.0, -1.0), 0.15)
    np.testing.assert_array_equal(result.triangles, other.triangles)
    np.testing.assert_allclose(result.positions[:, :2], other.positions[:, :2] / 6.0, atol=1e-6)
    np.testing.assert_array_equal(mesh.triangle_slot[parents], result.triangle_slot)


def test_small_triangles_stay() -> None:
    mesh = floor(0.01, -1.0)
    assert split(mesh, 0.1) is mesh
    assert not has_long_edges(mesh, mesh.positions, 0.1)


def test_limit_is_kept() -> None:
    result = split(floor(100.0, -1.0), 0.02, most_triangles=5000)
    assert len(result.triangles) <= 5000
    assert len(result.triangles) > 2


@pytest.mark.parametrize(
    ("radius", "share"), [(65.0, 0.0), (128.0 / SOON, 0.0), (127.99, 1.0), (128.0, 1.0), (2.0, 0.0)]
)
def test_a_mirror_that_grows_is_told_when_it_will_be_split_anew(radius: float, share: float) -> None:
    assert share_of_step(radius) == pytest.approx(share, abs=1e-3)
    if share > 0.0:
        assert split_angle(SOON * radius, 0.5) < split_angle(radius, 0.5)
