# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The one run that measures a graphics card: a part that fails costs no other, and all that was found is there."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tools" / "measure"))

import measure_auto
import measure_device
from curvrefl.curvrefl_addon.renderer.costs.table import SHIPPED, costs_in_use

pytestmark = pytest.mark.usefixtures("gpu")


def test_a_part_that_fails_costs_no_other(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def fails(_found: dict[str, Any]) -> None:
        written = json.loads((tmp_path / "device.json").read_text())
        assert written["first"] == 7
        raise RuntimeError("the driver is on holiday")

    parts = {"first": lambda _found: 7, "second": fails, "third": lambda found: found["first"] + 1}
    found = measure_device.run(parts, tmp_path, 60.0)
    assert (found["first"], found["second"], found["third"]) == (7, "failed: the driver is on holiday", 8)
    assert json.loads((tmp_path / "device.json").read_text()) == found
    printed = capsys.readouterr()
    assert found["device"]["renderer"] in printed.out and "RuntimeError" in printed.err


def test_no_part_begins_when_the_time_is_over(tmp_path: Path) -> None:
    found = measure_device.run({"first": lambda _found: 7, "second": lambda _found: 8}, tmp_path, 0.0)
    assert found["first"] == found["second"] == "left out"


def test_passes_and_frames_have_times_of_each_part() -> None:
    found = measure_device.passes((48, 32), 300, {})
    assert set(found) == {"seen", "walk", "draw", "solve", "pixels"} and min(found.values()) > 0.0
    rows = measure_device.frames(300, (48, 32), 0.5, {})
    assert [row["method"] for row in rows] == ["exact", "newton", "auto"]
    for row in rows:
        assert {"frame", "solve", "draw and shade", "python"} <= set(row)
    assert [row["shown by"] for row in rows] == ["exact", "newton", "exact"]


def test_choices_are_compared_by_both_tables(capsys: pytest.CaptureFixture[str]) -> None:
    """Made-up costs, by which solving is free; the table in use is the one that ships afterwards."""
    quick = {name: getattr(SHIPPED, name) for name in SHIPPED.__slots__}
    quick |= dict.fromkeys(("layer_drawn", "triangle_drawn", "vertex_solved", "solve_begun"), 0.0)
    (taken,) = measure_device.choices((300,), ((160, 120),), {"costs": quick})
    printed = capsys.readouterr().out
    assert "by the shipped costs exact" in printed and "by the measured costs newton" in printed
    assert set(taken) == {"shipped", "measured"} and min(taken.values()) == 1.0
    assert costs_in_use() == SHIPPED and measure_auto.choices.MOST_SHARE == 1.0
