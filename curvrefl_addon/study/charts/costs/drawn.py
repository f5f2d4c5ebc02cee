# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times against amounts as SVG and PNG: a panel for each axis, on logarithmic scales."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ....optics.catalog import METHODS
from ..chart_draw import drawing, figure_of, finish, method_handle, method_style, share_limits
from .slopes import Cost

if TYPE_CHECKING:
    from .axes import Axis

COLUMNS = 4
PANEL = (2.9, 2.5)
"""Inches"""
ROOM = 0.17
"""Of a panel's width, right of the last amount, for slopes"""


def draw_costs(axes: Sequence[Axis], costs: Sequence[Cost], headline: str, folder: Path) -> None:
    """costs.svg and costs.png into `folder`. Raises InputError without matplotlib."""
    with drawing():
        columns = min(len(axes), COLUMNS)
        figure, panels = figure_of(-(-len(axes) // columns), columns, headline, PANEL)
        places = list(panels.flat)
        for axis, panel in zip(axes, places, strict=False):
            _draw_axis(panel, axis, [cost for cost in costs if cost.axis == axis.name and cost.amounts])
        for panel in places[len(axes) :]:
            panel.set_axis_off()
        used = [name for name in METHODS if any(cost.method == name and cost.amounts for cost in costs)]
        finish(figure, [method_handle(name, METHODS[name].label) for name in used], folder / "costs")


def _draw_axis(panel: Any, axis: Axis, costs: Sequence[Cost]) -> None:
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.grid(True, color="#E6E6E6", linewidth=0.6)
    panel.set_axisbelow(True)
    panel.set_xlabel(axis.label, fontsize=9)
    panel.set_ylabel("frame, ms", fontsize=9)
    panel.tick_params(labelsize=8)
    for cost in costs:
        color, marker = method_style(cost.method)
        median = np.array([timing.median for timing in cost.timings])
        spread = np.array([[t.median - t.low, t.high - t.median] for t in cost.timings]).T
        panel.errorbar(
            cost.amounts, median, spread, color=color, marker=marker, markersize=4, linewidth=1, elinewidth=1
        )
    if costs:
        low, high = panel.get_xlim()
        panel.set_xlim(low, high * (high / low) ** ROOM)
        _write_slopes(panel, costs)
        share_limits([panel])


def _write_slopes(panel: Any, costs: Sequence[Cost]) -> None:
    """Beside the ends of the curves, apart from each other; the panel grows to hold them."""
    sloped = [(float(np.log(cost.timings[-1].median)), cost, cost.slope) for cost in costs]
    ends = sorted(
        ((height, cost, slope) for height, cost, slope in sloped if slope is not None), key=lambda end: end[0]
    )
    low, high = np.log(panel.get_ylim())
    least = 0.085 * (high - low)
    at = -np.inf
    for height, cost, slope in ends:
        at = max(height, at + least)
        panel.annotate(
            f"{slope.median:.2f}",
            (cost.amounts[-1], float(np.exp(at))),
            (5, 0),
            textcoords="offset points",
            fontsize=7.5,
            verticalalignment="center",
            color=method_style(cost.method)[0],
        )
    panel.set_ylim(np.exp(low), np.exp(max(high, at + least)))
