# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners that do not differ become one."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.scene.meshes.corners import merge_corners
from curvrefl.curvrefl_addon.scene.signature import array_signature
from hypothesis import given
from hypothesis import strategies as st


def test_equal_corners_are_the_vertices() -> None:
    corner_vertex = np.array([0, 1, 2, 2, 1, 3], np.int32)
    values = np.array([10, 11, 12, 13], np.float32)[corner_vertex][:, None]
    merged, models = merge_corners(corner_vertex, 4, [values])
    np.testing.assert_array_equal(merged, corner_vertex)
    np.testing.assert_array_equal(corner_vertex[models], [0, 1, 2, 3])


def test_only_what_differs_is_split() -> None:
    corner_vertex = np.array([0, 1, 2, 0, 1, 2], np.int32)
    uv = np.array([[0, 0], [1, 0], [2, 0], [0, 0], [1, 5], [2, 0]], np.float32)
    merged, models = merge_corners(corner_vertex, 3, [uv])
    assert len(models) == 4
    np.testing.assert_array_equal(uv[models][merged], uv)


def test_a_number_that_is_none_equals_itself() -> None:
    merged, models = merge_corners(np.array([0, 0], np.int32), 1, [np.full((2, 3), np.nan, np.float32)])
    assert len(models) == 1
    np.testing.assert_array_equal(merged, [0, 0])


@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 3), st.integers(0, 2)), min_size=1, max_size=60))
def test_as_many_corners_as_there_are_different_ones(rows: list[tuple[int, int, int]]) -> None:
    present = sorted({row[0] for row in rows})
    corner_vertex = np.array([present.index(row[0]) for row in rows], np.int32)
    first = np.array([[row[1], 0.5, 2.0 * row[1]] for row in rows], np.float32)
    second = np.array([[row[2], 1.0] for row in rows], np.float32)
    merged, models = merge_corners(corner_vertex, len(present), [first, second])
    assert len(models) == len(set(rows))
    np.testing.assert_array_equal(corner_vertex[models][merged], corner_vertex)
    np.testing.assert_array_equal(first[models][merged], first)
    np.testing.assert_array_equal(second[models][merged], second)
    np.testing.assert_array_equal(corner_vertex[models[: len(present)]], np.arange(len(present)))


def test_a_signature_tells_contents_shapes_and_absence_apart() -> None:
    values = np.arange(6, dtype=np.float32)
    signatures = [
        array_signature(values),
        array_signature(values[::-1]),
        array_signature(values.reshape(2, 3)),
        array_signature(values.astype(np.int32)),
        array_signature(values, None),
        array_signature(None, values),
        array_signature(np.nextafter(values, np.float32(9.0))),
    ]
    assert len(set(signatures)) == len(signatures)
    assert array_signature(values) == array_signature(values.copy())
