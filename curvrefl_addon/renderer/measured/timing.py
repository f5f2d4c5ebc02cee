# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How long the GPU takes for something, found out in slices."""

from __future__ import annotations

from collections.abc import Callable, Generator
from statistics import median
from time import perf_counter

from ..device.shaders import compiled

ENOUGH_MS = 6.0
"""Between two waits there should be so much work, which a wait for nothing is little beside"""
MOST_AT_ONCE = 64
REPEATS = 5


class Stopwatch:
    """Times things, and knows how steady the machine was meanwhile."""

    def __init__(self) -> None:
        self._unrest: list[float] = []

    @property
    def unrest(self) -> float:
        """How many times its least the usual time of a thing was: little above 1 where the machine did nothing else."""
        return median(self._unrest) if self._unrest else 1.0

    def best_ms(self, act: Callable[[], object], wait: Callable[[], None]) -> Generator[None, None, float]:
        """Milliseconds of `act`, which asks the GPU for the same each time, until `wait` returns: the least of several,
        as other work on the machine only adds. Where asking takes longer than doing, it is that.

        Yields between them; the first one, in which shaders compile, does not count.
        """
        yield from compiled(act)
        wait()
        yield

        def batch() -> float:
            start = perf_counter()
            for _ in range(at_once):
                act()
            wait()
            return 1e3 * (perf_counter() - start)

        at_once = 1
        times = [batch()]
        while times[0] < ENOUGH_MS and at_once < MOST_AT_ONCE:
            yield
            at_once = min(max(2 * at_once, int(at_once * ENOUGH_MS / max(times[0], 1e-3))), MOST_AT_ONCE)
            times = [batch()]
        for _ in range(REPEATS - 1):
            yield
            times.append(batch())
        yield
        self._unrest.append(median(times) / min(times))
        return min(times) / at_once
