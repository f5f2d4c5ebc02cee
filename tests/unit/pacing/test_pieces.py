# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that is kept gets on in every attempt, whatever the time; outside of a pace it is never given up."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest
from curvrefl.curvrefl_addon.pacing.pieces import OutOfTime, paced, piece_of_work, unpaced
from curvrefl.curvrefl_addon.pacing.reading_time import ReadingTime


def made_in_turn(kept: set[int], count: int = 5) -> None:
    """What is kept is not made again."""
    for number in range(count):
        if number not in kept:
            with piece_of_work(f"piece {number}"):
                kept.add(number)


def test_without_time_each_attempt_makes_one_piece_and_says_what_is_next() -> None:
    kept: set[int] = set()
    said = []
    for _ in range(4):
        with pytest.raises(OutOfTime) as left, paced(0.0):
            made_in_turn(kept)
        said.append(str(left.value))
    assert said == [f"piece {number}" for number in (1, 2, 3, 4)]
    with paced(0.0):
        made_in_turn(kept)
    assert kept == set(range(5))


def test_with_time_all_is_made_at_once() -> None:
    kept: set[int] = set()
    with paced(60.0):
        made_in_turn(kept)
    assert kept == set(range(5))


def test_outside_of_a_pace_nothing_is_given_up() -> None:
    kept: set[int] = set()
    made_in_turn(kept)
    with paced(0.0):
        with piece_of_work("the first"):
            pass
        with unpaced():
            made_in_turn(kept, 20)
        with pytest.raises(OutOfTime), piece_of_work("the second"):
            pass
        with ThreadPoolExecutor(1) as other:
            # (A render in a thread of its own.)
            other.submit(made_in_turn, kept, 40).result()
    assert kept == set(range(40))


def test_a_piece_within_a_piece_is_made_with_it() -> None:
    kept: set[int] = set()
    with paced(0.0):
        with piece_of_work("the outer one"):
            made_in_turn(kept)
        with pytest.raises(OutOfTime), piece_of_work("another"):
            pass
    assert kept == set(range(5))


def test_a_piece_that_fails_is_none() -> None:
    with paced(0.0):
        with pytest.raises(ValueError, match="no"), piece_of_work("one that fails"):
            raise ValueError("no")
        with piece_of_work("the first"):
            pass
        with pytest.raises(OutOfTime), piece_of_work("the second"):
            pass


def test_the_first_object_is_always_read() -> None:
    time = ReadingTime.of(0.0)
    assert [time.is_left_for_another() for _ in range(3)] == [True, False, False]
    assert time.unread == 2
    whole = ReadingTime.of(None)
    assert all(whole.is_left_for_another() for _ in range(3)) and whole.unread == 0
