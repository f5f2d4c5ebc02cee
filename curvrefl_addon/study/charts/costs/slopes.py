# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How time grows with an amount: straight lines through logarithms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....report.repeats import Timing, timing_columns


@dataclass(frozen=True, slots=True)
class Slope:
    """Of a line through the logarithms of times and amounts: 0 is a time that does not grow, 1 one in proportion."""

    median: float
    """Of the repeats' own slopes, least squares over all amounts"""
    low: float
    """First quartile"""
    high: float
    """Third quartile"""
    end: float
    """Between the two largest amounts, of the medians: what is there whatever the amount counts least there"""


@dataclass(frozen=True)
class Cost:
    """One method along one axis."""

    axis: str
    method: str
    amounts: tuple[float, ...] = ()
    timings: tuple[Timing, ...] = ()
    """A frame's, for each amount; equally many repeats in each"""
    reason: str = ""
    """Why it could not be measured, or not at more"""

    @property
    def slope(self) -> Slope | None:
        """None of fewer than two amounts."""
        return fitted_slope(self.amounts, [timing.times for timing in self.timings])


def fitted_slope(amounts: Sequence[float], times: Sequence[Sequence[float]]) -> Slope | None:
    """`times`: of each amount, milliseconds of as many repeats. None of fewer than two different amounts."""
    if len(set(amounts)) < 2:
        return None
    x, y = np.log(np.array(amounts, np.float64)), np.log(np.array(times, np.float64))
    slopes = np.polyfit(x, y, 1)[0]
    low, median, high = np.percentile(slopes, (25.0, 50.0, 75.0)).tolist()
    order = np.argsort(x)[-2:]
    (first, last), middle = x[order], np.median(y[order], axis=1)
    end = float((middle[1] - middle[0]) / (last - first)) if last > first else 0.0
    return Slope(median, low, high, end)


def rows(costs: Sequence[Cost]) -> list[dict[str, Any]]:
    """costs.csv: a row for each amount, and one with the reason where a method could not be measured."""
    table = []
    for cost in costs:
        measured = list(zip(cost.amounts, cost.timings, strict=True))
        table += [_row(cost, amount, timing) for amount, timing in measured]
        if cost.reason:
            table.append(_row(cost, None, None))
    return table


def _row(cost: Cost, amount: float | None, timing: Timing | None) -> dict[str, Any]:
    slope = cost.slope if amount is not None else None
    return {
        "axis": cost.axis,
        "method": cost.method,
        "amount": amount,
        **timing_columns("frame_ms", timing),
        "slope": None if slope is None else slope.median,
        "slope_q1": None if slope is None else slope.low,
        "slope_q3": None if slope is None else slope.high,
        "end_slope": None if slope is None else slope.end,
        "reason": cost.reason if amount is None else "",
    }
