# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Splitting keeps area, attributes and conformity."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("bpy", reason="renderer.geometry imports Blender's gpu module")

from curvrefl.curvrefl_addon.renderer.geometry import WorldGeometry
from curvrefl.curvrefl_addon.renderer.split import split_for_reflection


def floor(size: float, height: float) -> WorldGeometry:
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], np.float32) * size
    return WorldGeometry(
        positions=np.column_stack([corners, np.full(4, height)]).astype(np.float32),
        position_object=np.full(4, 7, np.int32),
        corner_position=np.arange(4, dtype=np.int32),
        corner_normals=np.tile(np.array([0, 0, 1], np.float32), (4, 1)),
        corner_uv=(corners / size).astype(np.float32),
        corner_color=None,
        triangles=np.array([[0, 1, 2], [0, 2, 3]], np.int32),
        triangle_material=np.array([3, 4], np.int32),
    )


def places(geometry: WorldGeometry) -> np.ndarray:
    return geometry.positions[geometry.corner_position[geometry.triangles]].astype(np.float64)


def test_area_and_orientation_are_kept() -> None:
    result = split_for_reflection(floor(6.0, -1.0), np.zeros(3), 0.1)
    p = places(result)
    areas = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])[:, 2] / 2
    assert (areas > 0).all()
    assert areas.sum() == pytest.approx(144.0, rel=1e-5)
    assert areas[result.triangle_material == 3].sum() == pytest.approx(72.0, rel=1e-5)


def test_no_edge_is_left_long() -> None:
    result = split_for_reflection(floor(6.0, -1.0), np.zeros(3), 0.1)
    p = places(result)
    edges = np.roll(p, -1, axis=1) - p
    along = np.clip(-(p * edges).sum(-1) / (edges**2).sum(-1), 0, 1)
    distance = np.linalg.norm(p + along[..., None] * edges, axis=-1)
    assert (np.linalg.norm(edges, axis=-1) <= 0.1001 * distance).all()


def test_no_cracks() -> None:
    result = split_for_reflection(floor(6.0, -1.0), np.zeros(3), 0.15)
    t = result.corner_position[result.triangles]
    edges = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    assert counts.max() == 2
    border = result.positions[unique[counts == 1]]
    on_rim = np.isclose(np.abs(border[..., :2]), 6.0).any(axis=2)
    assert on_rim.all(), "an edge with one triangle inside the floor is a crack"


def test_attributes_are_the_unsplit_ones() -> None:
    result = split_for_reflection(floor(6.0, -1.0), np.zeros(3), 0.2)
    np.testing.assert_allclose(result.corner_uv, result.positions[result.corner_position, :2] / 6.0, atol=1e-6)
    assert set(result.position_object) == {7}


def test_small_triangles_stay() -> None:
    geometry = floor(0.01, -1.0)
    assert split_for_reflection(geometry, np.zeros(3), 0.1) is geometry


def test_limit_is_kept() -> None:
    result = split_for_reflection(floor(100.0, -1.0), np.zeros(3), 0.02, most_triangles=5000)
    assert len(result.triangles) <= 5000
    assert len(result.triangles) > 2
