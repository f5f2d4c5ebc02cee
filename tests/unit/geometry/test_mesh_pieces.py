# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces of meshes, and the extent of a scene made of them, where both are known."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.geometry.mesh_pieces import (
    ROOM_TO_DEFORM,
    MeshPieces,
    box_of,
    mesh_pieces,
    outline,
    pieces_of_box,
)
from curvrefl.curvrefl_addon.renderer.lighting.shadow_views import SceneExtent
from curvrefl.curvrefl_addon.scene.meshes.made import smooth_mesh

hypothesis = pytest.importorskip("hypothesis")
from hypothesis import given, strategies  # noqa: E402

BOX = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float) - [0.5, 0.5, 0.0]
QUADS = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
BOX_TRIANGLES = np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])
FLOOR = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
FLOOR_TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]])


def pieces_of(positions: np.ndarray, triangles: np.ndarray) -> MeshPieces:
    return mesh_pieces(smooth_mesh("mesh", positions, np.zeros_like(positions), triangles))


def grid(side: int, height: np.ndarray | float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A square from -1 to 1 of side x side vertices, with heights."""
    x, y = np.meshgrid(np.linspace(-1, 1, side), np.linspace(-1, 1, side))
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    triangles = np.concatenate(
        [
            np.column_stack([first, first + 1, first + side]),
            np.column_stack([first + 1, first + side + 1, first + side]),
        ]
    )
    return np.column_stack([x.ravel(), y.ravel(), np.broadcast_to(height, (side, side)).ravel()]), triangles


def placed(place: tuple[float, float, float], *scale: float) -> np.ndarray:
    matrix = np.diag([*(scale or (1.0, 1.0, 1.0)), 1.0])
    matrix[:3, 3] = place
    return matrix


def test_a_box_has_six_planes() -> None:
    pieces = pieces_of(BOX, BOX_TRIANGLES)
    assert sorted(pieces.triangle_piece) == [1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6]
    np.testing.assert_allclose(pieces.areas, 1.0)


@pytest.mark.parametrize("side", [20, 200])
def test_a_fine_floor_is_one_plane_and_a_hill_is_not(side: int) -> None:
    flat = pieces_of(*grid(side))
    assert set(flat.triangle_piece) == {1}
    x = np.linspace(-1, 1, side)
    height = 0.1 / (1.0 + 9.0 * (x[:, None] ** 2 + x**2))
    hill = pieces_of(*grid(side, height))
    assert hill.triangle_piece.max() == 0
    # What stands out of a flat shape is in its outline.
    assert hill.outlines[0][:, 2].max() > 0.999 * height.max()


@given(
    strategies.integers(0, 1000),
    strategies.tuples(*[strategies.floats(0.01, 100.0)] * 3),
    strategies.sampled_from(["ball", "cloud", "shell", "box"]),
)
def test_outline_holds_the_points(seed: int, scale: tuple[float, float, float], shape: str) -> None:
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(3000, 3))
    if shape in ("ball", "shell"):
        points /= np.linalg.norm(points, axis=1, keepdims=True)
    if shape == "ball":
        points *= rng.uniform(0, 1, (3000, 1))
    if shape == "box":
        points = rng.uniform(-1, 1, (3000, 3))
    points *= scale
    found = outline(points)
    assert len(found) < 300
    directions = rng.normal(size=(200, 3))
    width = np.ptp(points @ directions.T, axis=0)
    missed = (points @ directions.T).max(axis=0) - (found @ directions.T).max(axis=0)
    assert (missed < 0.05 * width).all()
    assert (found.min(axis=0) >= points.min(axis=0) - 1e-9).all() and (
        found.max(axis=0) <= points.max(axis=0) + 1e-9
    ).all()


def test_a_tower_among_low_boxes_is_in_the_map() -> None:
    box, floor = pieces_of(BOX, BOX_TRIANGLES), pieces_of(FLOOR, FLOOR_TRIANGLES)
    rng = np.random.default_rng(1)
    instances = [(floor, placed((0, 0, 0), 50.0, 50.0, 1.0), True)]
    instances += [(box, placed((*rng.uniform(-40, 40, 2), 0.0), 0.2, 0.2, 0.2), True) for _ in range(300)]
    instances.append((box, placed((0, 0, 0), 1.0, 1.0, 5.0), True))
    view = SceneExtent(instances).parallel_view(np.array([0.0, 0.0, 1.0]), 512)
    assert view is not None
    top = view.world_to_clip @ np.array([0.3, 0.3, 5.0, 1.0])
    assert np.abs(top[:3]).max() <= 1.0


def test_floor_under_turned_and_mirrored_things_is_on_the_hull() -> None:
    box, floor = pieces_of(BOX, BOX_TRIANGLES), pieces_of(FLOOR, FLOOR_TRIANGLES)
    turned = np.eye(4)
    turned[:3, :3] = np.array([[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]])
    turned[2, 3] = 3.0
    extent = SceneExtent(
        [
            (box, turned, True),
            (floor, placed((0, 0, 0), -9.0, 9.0, 1.0), True),
            (box, placed((2, 0, 1), 1, -1, 1), True),
        ]
    )
    lowest = [plane for plane in extent.hull if plane.pieces == ((1, 1),)]
    assert len(lowest) == 1
    np.testing.assert_allclose(lowest[0].normal, [0, 0, 1])
    assert lowest[0].offset == pytest.approx(0.0)
    idle, _, _ = extent.split_by(np.array([0.0, 0.0, 1.0, 0.0]))
    assert (1, 1) in extent.pieces_in_planes(idle)


def test_a_room_seen_from_inside_casts_nowhere() -> None:
    """A lamp inside of a box lights all six walls from the side where the scene is."""
    room, thing = pieces_of(BOX, BOX_TRIANGLES), pieces_of(BOX, BOX_TRIANGLES)
    extent = SceneExtent([(room, placed((0, 0, 0), 10, 10, 10), True), (thing, placed((0, 0, 0.5)), True)])
    idle, casters, _ = extent.split_by(np.array([2.0, 0.0, 5.0, 1.0]))
    assert {instance for instance, _ in extent.pieces_in_planes(idle)} == {0}
    assert np.abs(casters[:, :2]).max() <= 0.5


def test_what_moves_inside_spares_the_hull() -> None:
    box, floor = pieces_of(BOX, BOX_TRIANGLES), pieces_of(FLOOR, FLOOR_TRIANGLES)
    extent = SceneExtent(
        [(floor, placed((0, 0, 0), 9.0, 9.0, 1.0), True), (box, placed((0, 0, 1), 0.3, 0.3, 0.3), True)]
    )
    assert extent.spares([1], np.array([[0.0, 0.0, 0.5], [1.0, 1.0, 2.0]]))
    assert not extent.spares([1], np.array([[0.0, 0.0, -3.0], [1.0, 1.0, 2.0]])), "below the floor"
    assert not extent.spares([0], np.array([[0.0, 0.0, 0.5]])), "the floor itself"


def test_what_casts_no_shadow_only_receives() -> None:
    box = pieces_of(BOX, BOX_TRIANGLES)
    extent = SceneExtent([(box, placed((0, 0, 0)), True), (box, placed((7, 0, 0)), False)])
    _, casters, receivers = extent.split_by(np.array([0.0, 0.0, 1.0, 0.0]))
    assert casters[:, 0].max() <= 0.5 < 7.5 <= receivers[:, 0].max()


@pytest.mark.parametrize("count", [1, 511, 512, 513, 5000])
def test_a_box_is_that_of_all_points(count: int) -> None:
    points = np.random.default_rng(count).normal(size=(count, 3)).astype(np.float32)
    low, high = box_of(points)
    np.testing.assert_array_equal(low, points.min(axis=0))
    np.testing.assert_array_equal(high, points.max(axis=0))
    points[-1, 1] = np.nan
    assert np.isnan(box_of(points)[0][1]) and np.isnan(box_of(points)[1][1])


def test_what_deforms_is_its_box_with_room_and_no_plane() -> None:
    low, high = np.array([-1.0, 0.0, 2.0], np.float32), np.array([1.0, 3.0, 2.0], np.float32)
    pieces = pieces_of_box(low, high, np.zeros(7, np.int8))
    assert len(pieces.areas) == len(pieces.normals) == 0
    (outline_of_box,) = pieces.outlines
    size = high - low
    np.testing.assert_allclose(outline_of_box.min(axis=0), low - ROOM_TO_DEFORM * size)
    np.testing.assert_allclose(outline_of_box.max(axis=0), high + ROOM_TO_DEFORM * size)
