# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects shadow maps leave out."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.renderer.lighting.shadow_reach import stand_apart


def apart(*balls: tuple[float, float]) -> list[bool]:
    """Balls on an axis: place and radius of each."""
    return stand_apart(
        np.array([(x, 0.0, 0.0) for x, _ in balls]).reshape(-1, 3), np.array([r for _, r in balls])
    ).tolist()


def test_what_lies_far_out_is_left_out() -> None:
    assert apart((0.0, 1.0), (3.0, 1.0), (-2.0, 1.0), (1e6, 1.0)) == [False, False, False, True]


def test_a_ground_without_end_is_left_out() -> None:
    assert apart((0.0, 1.0), (3.0, 1.0), (0.0, 1e5)) == [False, False, True]
    assert apart((0.0, 1.0), (0.0, 1e5)) == [False, True]


def test_a_hall_around_a_heap_of_pebbles_is_not() -> None:
    pebbles = [(0.01 * k, 0.01) for k in range(30)]
    assert not any(apart(*pebbles, (0.0, 2.0), (0.0, 60.0)))


def test_the_many_are_not_left_out_for_one_in_the_middle() -> None:
    assert not any(apart((0.0, 0.1), (-50.0, 1.0), (50.0, 1.0), (60.0, 1.0), (-60.0, 1.0)))
    assert apart((0.0, 1.0)) == [False]
    assert apart() == []
