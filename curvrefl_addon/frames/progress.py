# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames one after the other: which are left, and how long they will take."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from time import monotonic

LAST = 8
"""Frames whose times tell of those to come: what the first one waits for, as for shaders, is soon forgotten"""


def frames_left(
    frames: Sequence[int],
    is_done: Callable[[int], bool],
    say: Callable[[str], None],
    label: str = "Frame",
) -> Iterator[int]:
    """Those of `frames` that are not done, each of which is told of before it comes.

    One that others have done meanwhile, who work on the same frames, is left out as well.
    """
    left = [frame for frame in frames if not is_done(frame)]
    if len(left) < len(frames):
        say(f"{len(frames) - len(left)} of {len(frames)} frames are there already")
    pace = Pace(len(left))
    for number, frame in enumerate(left):
        if number and is_done(frame):
            pace.left_out()
            continue
        say(f"{label} {pace.place_of(frame)}")
        yield frame
        pace.done()


class Pace:
    """How far a number of frames has come, and how long the rest will take."""

    def __init__(self, count: int) -> None:
        """Time counts from now on."""
        self.count = count
        self.number = 1
        """Of the present frame among them"""
        self._begun = monotonic()
        self._times: deque[float] = deque(maxlen=LAST)

    def done(self) -> None:
        """The present frame is done, and the next one begins."""
        now = monotonic()
        self._times.append(now - self._begun)
        self._begun = now
        self.number += 1

    def left_out(self) -> None:
        """The present frame takes no time."""
        self.number += 1

    def place_of(self, frame: int) -> str:
        """Like "12 (3 of 40), about 2 min left" of the frame that is the present one."""
        text = f"{frame} ({self.number} of {self.count})"
        if not self._times:
            return text
        left = self.count - self.number + 1
        return f"{text}, about {_said(left * sum(self._times) / len(self._times))} left"


def _said(seconds: float) -> str:
    """With as many digits as such a guess is worth."""
    if seconds < 90.0:
        return f"{max(round(seconds), 1)} s"
    if seconds < 90.0 * 60.0:
        return f"{seconds / 60.0:.0f} min"
    return f"{seconds / 3600.0:.1f} h"
