# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Doing the same several times, and how its times spread."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import numpy as np


@dataclass(frozen=True, slots=True)
class Timing:
    """Repeats of one thing, milliseconds; at least one."""

    times: tuple[float, ...]

    @property
    def median(self) -> float:
        return self._percentile(50.0)

    @property
    def low(self) -> float:
        """First quartile, interpolated between the times"""
        return self._percentile(25.0)

    @property
    def high(self) -> float:
        """Third quartile"""
        return self._percentile(75.0)

    def joined(self, other: Timing) -> Timing:
        """With the repeats of another time."""
        return Timing(self.times + other.times)

    def _percentile(self, share: float) -> float:
        return float(np.percentile(self.times, share))


def repeated[T](action: Callable[[], T], most: int, seconds: float) -> list[T]:
    """What `action` returns, once and then again up to `most` times in all, as long as `seconds` have not passed."""
    start = perf_counter()
    results = [action()]
    while len(results) < most and perf_counter() - start < seconds:
        results.append(action())
    return results


def timing_columns(name: str, timing: Timing | None) -> dict[str, float | None]:
    """The columns NAME, NAME_q1, NAME_q3 and NAME_repeats of a row; None where there is no timing."""
    if timing is None:
        return dict.fromkeys((name, f"{name}_q1", f"{name}_q3", f"{name}_repeats"))
    return {
        name: timing.median,
        f"{name}_q1": timing.low,
        f"{name}_q3": timing.high,
        f"{name}_repeats": len(timing.times),
    }
