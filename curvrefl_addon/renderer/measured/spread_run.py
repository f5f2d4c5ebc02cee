# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work for the GPU that is done in slices, one in each redraw, so that no redraw waits for all of it."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from time import perf_counter

from ..device.state import kept_state

LEAST_SECONDS = 0.01
"""A slice goes on after a `yield` that came before so long"""


@dataclass(frozen=True, slots=True)
class Task:
    """A part of a run."""

    label: str
    """What is being done, for the panel: "Measuring this device" """
    work: Callable[[], Iterator[None]]
    """Makes a generator when its turn has come. A `yield` ends a slice, unless there was hardly anything in it: between
    two of them at most 50 ms of work belong, but for a shader that compiles (`compiled`, in `device/shaders.py`).
    Nothing may be bound at a `yield`; what the generator made goes in its `finally`, which runs too when the run is
    canceled."""


class SpreadRun:
    """Tasks one after the other: `advance()` once in each redraw, until it `is_done`.

    It draws to targets of its own and leaves the GPU's state as it was. Has to be advanced where a GPU context is.
    """

    def __init__(self, tasks: Sequence[Task]) -> None:
        self._left = list(tasks)
        self._running: Iterator[None] | None = None
        self.slices = 0
        """Done so far"""
        self.failure = ""
        """Why the run ended before it was through, one sentence"""

    @property
    def is_done(self) -> bool:
        """Nothing is left to do, also after a failure."""
        return not self._left

    @property
    def label(self) -> str:
        """Of the task that is being done; nothing once it `is_done`."""
        return self._left[0].label if self._left else ""

    def advance(self) -> None:
        """Do the next slice. Never raises: a task that fails ends the run, and `failure` says why."""
        if not self._left:
            return
        self.slices += 1
        start = perf_counter()
        with kept_state():
            while self._left:
                self._step()
                if perf_counter() - start >= LEAST_SECONDS:
                    break

    def _step(self) -> None:
        """To the next `yield`."""
        try:
            if self._running is None:
                self._running = self._left[0].work()
            next(self._running)
        except StopIteration:
            self._running = None
            del self._left[0]
        except Exception as error:
            traceback.print_exc()
            reason = str(error).strip().rstrip(".") or type(error).__name__
            self.failure = f"{self.label} has failed: {reason}."
            self._running = None
            self._left.clear()

    def finish(self) -> None:
        """Do all that is left at once."""
        while self._left:
            self.advance()

    def cancel(self) -> None:
        """Leave the rest undone, and let go of what the task at work has made."""
        running, self._running = self._running, None
        self._left.clear()
        close = getattr(running, "close", None)
        if close is not None:
            with kept_state():
                close()
