# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Time against amounts from numbers that are known by construction: slopes, their spread, rows, the drawn files."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.report.repeats import Timing
from curvrefl.curvrefl_addon.study.charts.costs.drawn import draw_costs
from curvrefl.curvrefl_addon.study.charts.costs.slopes import Cost, fitted_slope, rows

AMOUNTS = (1.0, 2.0, 4.0, 8.0, 16.0)


def test_slope_is_the_power_of_the_amount() -> None:
    slope = fitted_slope(AMOUNTS, [[3.0 * amount**0.75] * 4 for amount in AMOUNTS])
    assert slope is not None
    assert (slope.median, slope.low, slope.high, slope.end) == pytest.approx((0.75,) * 4)


def test_a_machine_that_is_slow_now_and_then_alike_at_all_amounts_spreads_no_slope() -> None:
    slowness = np.array([1.0, 1.7, 0.9, 2.5])
    slope = fitted_slope(AMOUNTS, [(3.0 * amount * slowness).tolist() for amount in AMOUNTS])
    assert slope is not None and slope.low == pytest.approx(1.0) and slope.high == pytest.approx(1.0)


def test_spread_is_that_of_the_repeats_own_slopes() -> None:
    powers = np.array([0.4, 0.5, 0.6, 0.7, 0.8])
    slope = fitted_slope(AMOUNTS, [(amount**powers).tolist() for amount in AMOUNTS])
    assert slope is not None
    assert (slope.low, slope.median, slope.high) == pytest.approx((0.5, 0.6, 0.7))


def test_the_end_tells_of_growth_that_a_constant_part_hides() -> None:
    amounts = (1.0, 10.0, 100.0, 1000.0)
    slope = fitted_slope(amounts, [[50.0 + amount] * 3 for amount in amounts])
    assert slope is not None
    assert slope.median < 0.5
    assert slope.end == pytest.approx(np.log10(1050.0 / 150.0))


@pytest.mark.parametrize("amounts", [(), (4.0,), (4.0, 4.0)])
def test_no_slope_of_a_single_amount(amounts: tuple[float, ...]) -> None:
    assert fitted_slope(amounts, [[1.0, 2.0] for _ in amounts]) is None


def cost(method: str, times: tuple[float, ...], reason: str = "") -> Cost:
    timings = tuple(Timing((0.9 * time, time, 1.1 * time)) for time in times)
    return Cost("lights", method, AMOUNTS[: len(times)], timings, reason)


def test_rows_have_the_slope_with_each_amount_and_the_reason_last() -> None:
    table = rows([cost("exact", (2.0, 4.0, 8.0)), cost("planar", (), "It is round.")])
    assert [(row["method"], row["amount"], row["frame_ms"]) for row in table] == [
        ("exact", 1.0, 2.0),
        ("exact", 2.0, 4.0),
        ("exact", 4.0, 8.0),
        ("planar", None, None),
    ]
    assert all(row["slope"] == pytest.approx(1.0) and row["reason"] == "" for row in table[:3])
    assert table[3]["reason"] == "It is round." and table[3]["slope"] is None
    assert len({tuple(row) for row in table}) == 1, "all rows have all columns"


def test_costs_are_drawn_and_the_same_again(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    axes: Any = [SimpleNamespace(name=name, label=name) for name in ("lights", "mirrors")]
    costs = [cost("exact", (2.0, 4.0, 8.0)), cost("newton", (2.0, 4.1, 8.0)), cost("planar", (), "It is round.")]
    for folder in (tmp_path / "one", tmp_path / "two"):
        folder.mkdir()
        draw_costs(axes, costs, "Headline", folder)
        assert sorted(path.name for path in folder.iterdir()) == ["costs.png", "costs.svg"]
        assert (folder / "costs.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "one" / "costs.svg").read_bytes() == (tmp_path / "two" / "costs.svg").read_bytes()
