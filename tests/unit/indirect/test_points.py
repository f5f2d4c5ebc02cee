# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points where light is found lie on the surfaces, all over them, on the outside, whatever the scale."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.demo.shapes import Shape, ball, box, plane
from curvrefl.curvrefl_addon.renderer.indirect.cells import CellGrid
from curvrefl.curvrefl_addon.renderer.indirect.points import (
    LIFT,
    MOST_PATCHES,
    MOST_TRIANGLES,
    POINTS,
    Patches,
    Surface,
    place_patches,
)
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MeshArrays
from hypothesis import given, settings
from hypothesis import strategies as st

ORIGIN = np.zeros(3)


def mesh_of(shape: Shape) -> MeshArrays:
    fans = [(face[0], face[k], face[k + 1]) for face in shape.polygons for k in range(1, len(face) - 1)]
    return made(shape.positions, np.array(fans))


def made(positions: np.ndarray, triangles: np.ndarray) -> MeshArrays:
    count = len(positions)
    return MeshArrays(
        "mesh",
        positions.astype(np.float32),
        np.arange(count, dtype=np.int32),
        np.tile(np.array([0, 0, 1], np.float32), (count, 1)),
        None,
        triangles.astype(np.int32),
        np.zeros(len(triangles), np.int32),
    )


def surface(mesh: MeshArrays, matrix: np.ndarray | None = None, is_solid: bool = False) -> Surface:
    return Surface(mesh, InstanceArrays("thing", 1, 0, np.eye(4) if matrix is None else matrix, (0,)), is_solid)


def scaled(*factors: float, place: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> np.ndarray:
    matrix = np.diag([*factors, 1.0])
    matrix[:3, 3] = place
    return matrix


def placed(*surfaces: Surface, half: float = 1.0, focus: np.ndarray = ORIGIN) -> Patches:
    patches = all_placed(list(surfaces), focus, half)
    assert patches is not None
    return patches


def all_placed(surfaces: list[Surface], focus: np.ndarray = ORIGIN, half: float = 1.0) -> Patches | None:
    """What is there when all steps are done."""
    last = None
    for patches in place_patches(surfaces, focus, half):
        assert last is None
        last = patches
    return last


def sizes_at(patches: Patches) -> np.ndarray:
    """(patches, POINTS) sides of the cells that hold them."""
    flat = patches.positions.reshape(-1, 3).astype(np.float64)
    return patches.grid.sizes(patches.grid.levels_at(flat)).reshape(-1, POINTS)


def room() -> list[Surface]:
    """A floor, a ball over it and a leaning board."""
    turn = np.array([[0.8, 0.0, 0.6, 1.0], [0.0, 1.0, 0.0, 0.2], [-0.6, 0.0, 0.8, 0.5], [0.0, 0.0, 0.0, 1.0]])
    return [
        surface(mesh_of(plane((8.0, 8.0), (3, 3)))),
        surface(mesh_of(ball(0.5, 32)), scaled(1.0, 1.0, 1.0, place=(0.0, 0.0, 0.5)), is_solid=True),
        surface(mesh_of(box((0.6, 0.8, 0.05))), turn, is_solid=True),
    ]


def test_the_table_knows_each_point() -> None:
    """Its cell has the patch that it is of."""
    patches = placed(*room())
    flat = patches.positions.reshape(-1, 3).astype(np.float64)
    normals = patches.normals.reshape(-1, 3).astype(np.float64)
    found = patches.table[patches.grid.numbers(flat, normals)].reshape(-1, POINTS)
    own = np.arange(patches.count)[:, None]
    # (Single precision may push a point over the border of its cell.)
    assert (found == own).mean() > 0.999
    assert (found >= 0).all()


def test_points_lie_a_little_above_their_surface() -> None:
    patches = placed(surface(mesh_of(plane((4.0, 4.0)))))
    height = patches.positions[..., 2]
    up = patches.normals[..., 2]
    assert np.allclose(np.abs(up), 1.0)
    # (A triangle that reaches into two levels is of one of them.)
    lift = height * up / (LIFT * sizes_at(patches))
    assert lift.min() > 0.49
    assert lift.max() < 2.01
    assert np.abs(patches.positions[..., :2]).max() <= 2.0


def test_points_of_a_ball_face_outward() -> None:
    patches = placed(surface(mesh_of(ball(1.0, 96)), is_solid=True))
    assert ((patches.positions * patches.normals).sum(axis=-1) > 0.99).all()
    radius = np.linalg.norm(patches.positions, axis=-1)
    assert (radius < 1.0 + 2.0 * LIFT * sizes_at(patches)).all()
    assert (radius > np.cos(np.pi / 48)).all()


def test_what_is_looked_at_from_within_has_points_on_both_sides() -> None:
    patches = placed(surface(mesh_of(ball(1.0, 48))))
    outward = (patches.positions * patches.normals).sum(axis=-1) > 0.0
    assert 0.4 < outward.mean() < 0.6
    solid = placed(surface(mesh_of(ball(1.0, 48)), is_solid=True))
    assert ((solid.positions * solid.normals).sum(axis=-1) > 0.0).all()


@pytest.mark.parametrize("factors", [(-1.0, 1.0, 1.0), (1.0, -2.0, 0.5), (-1.0, -1.0, -1.0)])
def test_mirrored_things_face_outward(factors: tuple[float, float, float]) -> None:
    patches = placed(surface(mesh_of(ball(1.0, 48)), scaled(*factors), is_solid=True))
    # (By the gradient of the ellipsoid.)
    outward = patches.positions / np.square(np.array(factors))
    assert ((outward * patches.normals).sum(axis=-1) > 0.0).all()


def shelves(shape: Shape, *factors: float) -> list[Surface]:
    """Enough of one shape, one above the other, that the cells of level 0 are small enough."""
    mesh = mesh_of(shape)
    heights = np.linspace(-0.93, 0.93, 10)
    return [surface(mesh, scaled(*factors, place=(0.0, 0.0, height)), is_solid=True) for height in heights.tolist()]


@pytest.mark.parametrize("factors", [(1.9, 1.9, 1.0), (4.0, 0.5, 1.0), (-1.9, 1.9, 3.0)])
def test_points_are_spread_by_area(factors: tuple[float, float, float]) -> None:
    """As many on each part as that is large, in a grid of one level."""
    size = (1.9 / abs(factors[0]), 1.9 / factors[1])
    patches = placed(*shelves(plane(size, (7, 5)), *factors))
    assert patches.grid.half == 1.0
    places = patches.positions[..., :2]
    for axis in (0, 1):
        share = np.histogram(places[..., axis], bins=4, range=(-0.95, 0.95))[0] / places[..., axis].size
        assert np.abs(share - 0.25).max() < 0.03


def test_slivers_take_nothing_from_their_neighbors() -> None:
    """Half of each shelf is two triangles, half is four hundred thin ones: both have as many patches."""
    strips, whole = plane((0.95, 1.9), (200, 1)), plane((0.95, 1.9))
    patches = placed(*shelves(strips.moved((-0.475, 0, 0)), 1, 1, 1), *shelves(whole.moved((0.475, 0, 0)), 1, 1, 1))
    left = (patches.positions[:, :, 0] < 0.0).all(axis=1).sum()
    right = (patches.positions[:, :, 0] > 0.0).all(axis=1).sum()
    assert left == pytest.approx(right, rel=0.05)


def test_a_mesh_too_fine_to_be_looked_at_whole_is_covered() -> None:
    """Of half of each shelf every second triangle stands for all: it has as many patches as the other half."""
    fine, whole = plane((0.95, 1.9), (100, 110)), plane((0.95, 1.9))
    assert 2 * len(fine.polygons) > MOST_TRIANGLES
    patches = placed(*shelves(fine.moved((-0.475, 0, 0)), 1, 1, 1), *shelves(whole.moved((0.475, 0, 0)), 1, 1, 1))
    left = (patches.positions[:, :, 0] < 0.0).all(axis=1).sum()
    right = (patches.positions[:, :, 0] > 0.0).all(axis=1).sum()
    assert left == pytest.approx(right, rel=0.05)


def test_triangles_without_area_have_no_points() -> None:
    positions = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [5, 5, 5]], float)
    flat = made(positions, np.array([[0, 1, 2], [4, 4, 4], [0, 0, 3]]))
    assert all_placed([surface(flat)]) is None
    mixed = made(positions, np.array([[0, 1, 2], [0, 1, 3], [4, 4, 4]]))
    patches = placed(surface(mixed))
    assert np.isfinite(patches.positions).all()
    assert np.isfinite(patches.normals).all()
    assert np.abs(patches.positions).max() < 1.1
    # Flattened by its matrix.
    assert all_placed([surface(mesh_of(ball(1.0, 16)), scaled(0.0, 0.0, 0.0))]) is None


def test_nothing_has_no_patches() -> None:
    assert all_placed([]) is None


def test_patches_are_the_same_again() -> None:
    first, again = placed(*room()), placed(*room())
    for name in ("table", "positions", "normals"):
        assert np.array_equal(getattr(first, name), getattr(again, name))
    assert first.grid == again.grid


@given(power=st.integers(-13, 13))
@settings(max_examples=12)
def test_a_scaled_scene_has_scaled_patches(power: int) -> None:
    """By powers of two, 1e-4 to 1e4: with the same bits, but for the lift of single precision."""
    scale = 2.0**power
    plain = placed(*room())
    matrices = [scaled(scale, scale, scale) @ item.instance.matrix for item in room()]
    things = [surface(item.mesh, matrix, item.is_solid) for item, matrix in zip(room(), matrices, strict=True)]
    large = placed(*things, half=scale)
    assert large.count == plain.count
    assert large.grid.half == scale * plain.grid.half
    assert np.array_equal(large.table, plain.table)
    assert np.array_equal(large.normals, plain.normals)
    assert np.allclose(large.positions / scale, plain.positions, rtol=1e-6, atol=1e-6)


@given(
    power=st.floats(-4.0, 4.0),
    place=st.tuples(*[st.floats(-3.0, 3.0)] * 3),
    segments=st.sampled_from([4, 8, 40]),
    is_solid=st.booleans(),
    half=st.floats(0.1, 10.0),
)
@settings(max_examples=25)
def test_any_ball_is_covered(
    power: float, place: tuple[float, float, float], segments: int, is_solid: bool, half: float
) -> None:
    """Of every size and wherever it is: points near its surface, unit normals, no more patches than there may be."""
    scale = 10.0**power
    where = (scale * place[0], scale * place[1], scale * place[2])
    patches = placed(
        surface(mesh_of(ball(1.0, segments)), scaled(scale, scale, scale, place=where), is_solid), half=half * scale
    )
    assert 0 < patches.count <= MOST_PATCHES
    assert patches.table.max() == patches.count - 1
    off = (patches.positions - np.array(where)) / scale
    radius = np.linalg.norm(off, axis=-1)
    lift = LIFT * sizes_at(patches) / scale
    assert (radius < 1.0 + lift + 1e-5).all()
    assert np.allclose(np.linalg.norm(patches.normals, axis=-1), 1.0, atol=1e-5)
    # All around, where it has more than a few.
    if patches.count > 100 and segments == 40:
        assert off.max(axis=(0, 1)).min() > 0.8
        assert off.min(axis=(0, 1)).max() < -0.8


@pytest.mark.parametrize("half", [1e-3, 0.05, 1.0, 30.0])
def test_a_large_scene_has_no_more_patches_than_there_may_be(half: float) -> None:
    """Whatever was asked for."""
    patches = placed(*room(), surface(mesh_of(plane((5000.0, 5000.0)))), half=half)
    assert 0 < patches.count <= MOST_PATCHES


def test_many_instances_all_have_patches() -> None:
    pebbles = [
        surface(mesh_of(ball(0.01, 8)), scaled(1, 1, 1, place=(0.3 * (k % 20), 0.3 * (k // 20), 0.0)), is_solid=True)
        for k in range(400)
    ]
    patches = placed(*pebbles, half=3.0)
    nearest = {(round(float(x) / 0.3), round(float(y) / 0.3)) for x, y, _ in patches.positions.reshape(-1, 3)}
    assert len(nearest) == 400


def test_points_behind_a_wall_give_way_to_the_first() -> None:
    patches = placed(*room())
    count = patches.count
    normals = np.zeros((count, 2, 3), np.float32)
    normals[:, 0, 2] = 1.0
    # One plane through the middle of each patch's points, another that is nowhere.
    first = patches.positions[:, 0]
    normals[:, 0] = np.where(np.arange(count)[:, None] % 2 == 0, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    distances = np.full((count, 2), -1e30, np.float32)
    distances[:, 0] = (normals[:, 0] * first).sum(axis=1) - 1e-6
    parted = patches.parted(normals, distances)
    heights = np.einsum("pk,pnk->pn", normals[:, 0], parted.positions)
    assert (heights >= distances[:, :1] - 1e-6).all()
    same = (np.einsum("pk,pnk->pn", normals[:, 0], patches.positions) >= distances[:, :1])[..., None]
    assert np.array_equal(np.where(same, parted.positions, 0.0), np.where(same, patches.positions, 0.0))
    assert isinstance(parted.grid, CellGrid)
