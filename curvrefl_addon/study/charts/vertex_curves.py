# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How long methods take against how many vertices they solve, and the straight line through that."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...report.repeats import Timing, timing_columns

CONSTANTS = 100
"""Values that a fit tries for the part of the time that does not depend on the count"""


@dataclass(frozen=True, slots=True)
class Fit:
    """milliseconds = constant + factor * vertices ** slope"""

    slope: float
    factor: float
    constant: float = 0.0

    def at(self, vertices: float) -> float:
        return self.constant + self.factor * float(vertices) ** self.slope


@dataclass(frozen=True)
class Curve:
    """One method with its default settings."""

    method: str
    counts: tuple[int, ...] = ()
    timings: tuple[Timing, ...] = ()
    reason: str = ""
    """Why it could not be measured"""

    @property
    def fit(self) -> Fit | None:
        """None of fewer than two counts."""
        return fitted(self.counts, [timing.median for timing in self.timings])


def fitted(counts: Sequence[float], times_ms: Sequence[float]) -> Fit | None:
    """Least squares of relative errors; None of fewer than two counts, without a constant for fewer than four."""
    if len(counts) < 2:
        return None
    times = np.array(times_ms, np.float64)
    shares = np.linspace(0.0, 1.0, CONSTANTS, endpoint=False) if len(counts) >= 4 else np.zeros(1)
    fits = [_power(np.array(counts, np.float64), times, constant) for constant in shares * times.min()]

    def error(fit: Fit) -> float:
        return sum(float(np.log(fit.at(count) / time)) ** 2 for count, time in zip(counts, times, strict=True))

    return min(fits, key=error)


def _power(counts: NDArray[np.float64], times: NDArray[np.float64], constant: float) -> Fit:
    """The fit with this constant, a straight line in logarithms."""
    rest = times - constant
    # A relative error of the whole time is a larger one of the rest.
    slope, offset = np.polyfit(np.log(counts), np.log(rest), 1, w=rest / times)
    return Fit(float(slope), float(np.exp(offset)), constant)


def counts_up_to(largest: int) -> tuple[int, ...]:
    """1000, 3000, 10,000, ... and `largest` itself, which is at least 1000."""
    steps = [factor * 10**power for power in range(3, 9) for factor in (1, 3)]
    return (*(count for count in steps if count < largest), largest)


def rows(curves: Sequence[Curve]) -> list[dict[str, Any]]:
    """vertex_count.csv: one row per count, one with the reason for a method that could not be measured."""
    table: list[dict[str, Any]] = []
    for curve in curves:
        fit = curve.fit
        for count, timing in zip(curve.counts, curve.timings, strict=True):
            table.append(_row(curve, count, timing, fit))
        if curve.reason:
            table.append(_row(curve))
    return table


def _row(
    curve: Curve,
    count: int | None = None,
    timing: Timing | None = None,
    fit: Fit | None = None,
) -> dict[str, Any]:
    return {
        "method": curve.method,
        "vertices": count,
        **timing_columns("solve_ms", timing),
        "slope": None if fit is None else fit.slope,
        "constant_ms": None if fit is None else fit.constant,
        "fitted_ms": None if fit is None or count is None else fit.at(count),
        "reason": curve.reason,
    }
