# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels while something moves, on devices made up of a fixed time and one that goes with the pixels."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import pytest
from curvrefl.curvrefl_addon.viewport.motion_resolution import BUDGET_MS, LOOKS, SELDOM, STEPS, MotionResolution


def orbited(motion: MotionResolution, time_of: Callable[[int], float], pictures: int = 200) -> list[int]:
    """Divisors of so many pictures, of which one of divisor d takes `time_of(d)` milliseconds."""
    found = []
    for _ in range(pictures):
        found.append(motion.divisor)
        if motion.wants_time():
            motion.note(time_of(motion.divisor))
    return found


def device(fixed: float, full: float) -> Callable[[int], float]:
    return lambda divisor: fixed + full / divisor**2


@pytest.mark.parametrize(
    ("fixed", "full", "wanted"),
    [
        (0.0, 5.0, 1),
        (0.0, 29.0, 1),
        # 25 ms at half, where the full picture would take 100
        (0.0, 100.0, 2),
        (0.0, 250.0, 3),
        (0.0, 400.0, 4),
        (1.0, 1000.0, 6),
        (0.0, 1e5, 8),
        # Python alone takes longer than there is: fewer pixels help nothing
        (60.0, 20.0, 2),
        (500.0, 1.0, 2),
    ],
)
def test_it_gets_to_what_a_device_can_do_and_stays(fixed: float, full: float, wanted: int) -> None:
    motion = MotionResolution()
    found = orbited(motion, device(fixed, full))
    assert set(found[-100:]) == {wanted}
    assert sum(one != other for one, other in pairwise(found)) <= 3


def test_two_very_slow_pictures_are_enough() -> None:
    motion = MotionResolution()
    found = orbited(motion, device(0.0, 4000.0), 3)
    assert found[1] == 2 and found[2] == STEPS[-1]


def test_one_slow_picture_among_others_changes_nothing() -> None:
    motion = MotionResolution()
    orbited(motion, device(0.0, 100.0))
    motion.note(2000.0)
    assert set(orbited(motion, device(0.0, 100.0))) == {2}


@pytest.mark.parametrize(("before", "after"), [((0.0, 100.0), (0.0, 1500.0)), ((60.0, 20.0), (0.5, 400.0))])
def test_it_follows_what_is_drawn(before: tuple[float, float], after: tuple[float, float]) -> None:
    motion = MotionResolution()
    orbited(motion, device(*before))
    coarse = orbited(motion, device(*after))[-1]
    assert device(*after)(coarse) <= BUDGET_MS < device(*after)(STEPS[STEPS.index(coarse) - 1])
    assert orbited(motion, device(0.0, 5.0))[-1] == 1


def test_once_it_is_known_few_pictures_wait_for_the_device() -> None:
    motion = MotionResolution()
    orbited(motion, device(0.0, 100.0), LOOKS)
    asked = []
    for _ in range(4 * SELDOM):
        asked.append(motion.wants_time())
        if asked[-1]:
            motion.note(25.0)
    assert sum(asked) == 4
