# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles on texels, maps of them, and cells of a lattice."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.design.anamorphosis import charts
from curvrefl.curvrefl_addon.design.anamorphosis.charts import affine_maps, grown, islands_of, texels_of
from curvrefl.curvrefl_addon.design.anamorphosis.lattice import cells_of
from curvrefl.curvrefl_addon.optics.meshes.components import components
from curvrefl.curvrefl_addon.scene.arrays import Float64Array


def owners(corners: Float64Array, width: int, height: int) -> np.ndarray:
    """(h, w) how many triangles have each texel."""
    count = np.zeros(width * height, int)
    for _, texel in texels_of(corners, width, height):
        np.add.at(count, texel, 1)
    return count.reshape(height, width)


def test_texels_are_those_whose_middles_are_in_a_triangle() -> None:
    random = np.random.default_rng(1)
    corners = random.uniform(-10.0, 40.0, (60, 3, 2))
    x, y = np.meshgrid(np.arange(32) + 0.5, np.arange(20) + 0.5)
    places = np.column_stack([x.ravel(), y.ravel()])
    expected = np.zeros(len(places), int)
    for triangle in corners:
        edges = np.roll(triangle, -1, axis=0) - triangle
        offsets = places[None] - triangle[:, None]
        sides = edges[:, None, 0] * offsets[..., 1] - edges[:, None, 1] * offsets[..., 0]
        expected += (sides.min(axis=0) > 0.0) | (sides.max(axis=0) < 0.0)
    np.testing.assert_array_equal(owners(corners, 32, 20), expected.reshape(20, 32))


def test_a_triangle_may_have_more_texels_than_are_looked_at_together(monkeypatch: pytest.MonkeyPatch) -> None:
    large = np.array([[[-100.0, -100.0], [300.0, -100.0], [-100.0, 300.0]], [[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]]])
    whole = owners(large, 50, 40)
    monkeypatch.setattr(charts, "AT_ONCE", 37)
    np.testing.assert_array_equal(owners(large, 50, 40), whole)
    assert whole.min() == 1 and whole.max() == 2


def test_neighbors_leave_no_texel_out() -> None:
    """A lattice of odd cells over the whole image."""
    random = np.random.default_rng(2)
    x, y = np.meshgrid(np.linspace(-1.0, 33.0, 12), np.linspace(-1.0, 25.0, 9))
    place = np.stack([x, y], -1) + random.uniform(-0.9, 0.9, (9, 12, 2))
    quads = np.stack([place[:-1, :-1], place[:-1, 1:], place[1:, 1:], place[1:, :-1]], axis=2).reshape(-1, 4, 2)
    assert owners(quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 2), 32, 24).min() == 1


def test_affine_maps_take_corners_to_values() -> None:
    random = np.random.default_rng(3)
    corners, values = random.normal(size=(2, 50, 3, 2))
    matrix, offset = affine_maps(corners, values)
    np.testing.assert_allclose(np.einsum("nij,nkj->nki", matrix, corners) + offset[:, None], values, atol=1e-9)


def test_islands_end_where_a_vertex_has_two_places() -> None:
    """Three squares in a row on one strip of vertices; the last has its left side elsewhere on the image."""
    quads = np.array([[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6]])
    x, y = np.meshgrid(np.arange(4.0), np.arange(2.0))
    place = np.column_stack([x.ravel(), y.ravel()])[quads]
    place[2] += [0.0, 10.0]
    vertices = quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
    found = islands_of(vertices, place[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 2))
    assert len(set(found[:4].tolist())) == 1 and len(set(found[4:].tolist())) == 1 and found[0] != found[4]


def test_components_of_long_strips_and_single_things() -> None:
    random = np.random.default_rng(4)
    order = random.permutation(5000)
    pairs = np.column_stack([order[:2999], order[1:3000]])
    found = components(5001, pairs[random.permutation(len(pairs))])
    assert set(found[order[:3000]].tolist()) == {int(order[:3000].min())}
    np.testing.assert_array_equal(np.sort(found[order[3000:]]), np.sort(order[3000:]))
    np.testing.assert_array_equal(components(3, np.empty((0, 2), int)), [0, 1, 2])


def test_numbers_grow_by_a_texel_where_they_may() -> None:
    owner = np.full((5, 6), -1)
    owner[2, 2] = 7
    may = np.ones((5, 6), bool)
    may[2, 1] = False
    found = grown(owner, may)
    expected = owner.copy()
    expected[1:4, 1:4] = 7
    expected[2, 1] = -1
    np.testing.assert_array_equal(found, expected)


def lattice(rows: int, columns: int) -> Float64Array:
    x, y = np.meshgrid(np.linspace(0.0, 1.0, columns), np.linspace(0.0, 1.0, rows))
    return np.stack([x, y], axis=-1)


def test_cells_of_a_straight_map_go_on_by_one_past_its_end() -> None:
    places = lattice(9, 11)
    mapped = places @ np.array([[3.0, 1.0], [-0.5, 2.0]]) + [4.0, 5.0]
    piece = np.full((9, 11), -1)
    piece[3:7, 2:8] = 5
    cells = cells_of(np.where(piece[..., None] >= 0, mapped, np.nan), piece, places.reshape(-1, 2))
    assert len(cells.corners) == 2 * 5 * 7
    assert cells.is_whole.sum() >= 2 * 3 * 5
    back = np.linalg.inv(np.array([[3.0, 1.0], [-0.5, 2.0]]))
    np.testing.assert_allclose((cells.corners - [4.0, 5.0]) @ back, cells.values, atol=1e-12)
    assert (piece.ravel()[cells.first] == 5).all()


def test_no_cell_goes_over_a_jump_and_stray_places_are_healed() -> None:
    """One piece whose right half lies far away, as over the seam of a UV map; and one ray that went astray."""
    places = lattice(20, 30)
    mapped = places.copy()
    mapped[:, 15:, 0] += 50.0
    mapped[6, 7] = [-30.0, 80.0]
    cells = cells_of(mapped, np.zeros((20, 30), int), places.reshape(-1, 2))
    spread = np.ptp(cells.corners, axis=1).max()
    assert spread < 0.06
    moved = cells.corners - np.where(cells.corners[..., :1] > 20.0, [50.0, 0.0], 0.0)
    np.testing.assert_allclose(moved, cells.values, atol=1e-12)
    # Both halves go on by a cell: 14 and 14 columns of cells of their own, and one more each.
    assert len(cells.corners) == 2 * 19 * (14 + 14 + 2)


def test_the_largest_come_first() -> None:
    places = lattice(2, 6)
    mapped = places.copy()
    mapped[..., 0] = np.array([0.0, 1.0, 1.5, 3.5, 3.8, 4.9])
    cells = cells_of(mapped, np.zeros((2, 6), int), places.reshape(-1, 2))
    width = np.ptp(cells.corners[..., 0], axis=1)
    assert (np.diff(width) <= 1e-12).all() and width[0] > width[-1]
