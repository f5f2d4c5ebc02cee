# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which frames are left, also of those that others do, and what is said of the time."""

from __future__ import annotations

import pytest
from curvrefl.curvrefl_addon.frames import progress
from curvrefl.curvrefl_addon.frames.progress import frames_left


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(progress, "monotonic", clock)
    return clock


def test_frames_that_are_done_are_left_out_and_told_of(clock: Clock) -> None:
    said: list[str] = []
    done = {2}
    for frame in frames_left(range(1, 6), done.__contains__, said.append):
        done.add(frame)
        if frame == 1:
            done.add(4)  # (by another worker)
        clock.now += 60.0
    assert done == {1, 2, 3, 4, 5}
    assert said == [
        "1 of 5 frames are there already",
        "Frame 1 (1 of 4)",
        "Frame 3 (2 of 4), about 3 min left",
        "Frame 5 (4 of 4), about 60 s left",
    ]


def test_the_first_frame_is_soon_forgotten(clock: Clock) -> None:
    said: list[str] = []
    for frame in frames_left(range(100), lambda frame: False, said.append):
        clock.now += 3600.0 if frame == 0 else 0.5
    assert said[1] == "Frame 1 (2 of 100), about 99.0 h left"
    assert said[20] == "Frame 20 (21 of 100), about 40 s left"
    assert said[-1] == "Frame 99 (100 of 100), about 1 s left"
