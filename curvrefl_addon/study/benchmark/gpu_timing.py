# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How long the GPU takes for something, where waiting for it takes longer than the thing itself.

To wait, one pixel is read. That has a price of its own, a fraction of a millisecond, so the same is asked for many
times between two waits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

from ...report.repeats import Timing, repeated, timing_columns

WORTH = 20.0
"""Between two waits there is so many times the work of a wait for nothing: times are too long by a twentieth at most"""
MOST_AT_ONCE = 4096
EMPTY_WAITS = 50


@dataclass(frozen=True, slots=True)
class GpuTiming:
    """Of one thing done again and again."""

    timing: Timing
    """Of each, in the mean of what was done between two waits"""
    at_once: int
    """Times it was done between two waits"""
    submit_ms: float
    """Of the processor to ask for one: where this is nearly the whole time, the GPU had to wait for work"""

    def columns(self, state: str) -> dict[str, float | None]:
        """Of a row."""
        return timing_columns(f"{state}_ms", self.timing) | {
            f"{state}_at_once": self.at_once,
            f"{state}_submit_ms": self.submit_ms,
        }


def empty_wait(wait: Callable[[], None]) -> float:
    """Milliseconds that `wait` takes when there is nothing to wait for, the median of many."""
    wait()

    def once() -> float:
        start = perf_counter()
        wait()
        return 1e3 * (perf_counter() - start)

    return Timing(tuple(repeated(once, EMPTY_WAITS, 1.0))).median


def time_on_gpu(
    act: Callable[[], None], wait: Callable[[], None], empty_ms: float, most: int, seconds: float
) -> GpuTiming:
    """Time `act`, which asks the GPU for the same each time; `empty_ms`: see `empty_wait`.

    Repeats as `repeated` with `most` and `seconds`, after a first one that counts for nothing.
    """

    def batch(count: int) -> tuple[float, float]:
        start = perf_counter()
        for _ in range(count):
            act()
        submitted = perf_counter()
        wait()
        return 1e3 * (perf_counter() - start), 1e3 * (submitted - start)

    batch(1)
    at_once = 1
    while (time := batch(at_once)[0]) < WORTH * empty_ms and at_once < MOST_AT_ONCE:
        at_once = min(MOST_AT_ONCE, max(2 * at_once, int(1.2 * at_once * WORTH * empty_ms / max(time, 1e-6))))
    results = repeated(lambda: batch(at_once), most, seconds)
    timing = Timing(tuple(time / at_once for time, _ in results))
    return GpuTiming(timing, at_once, Timing(tuple(submit / at_once for _, submit in results)).median)
