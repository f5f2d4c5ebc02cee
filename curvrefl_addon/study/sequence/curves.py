# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves over time as SVG and PNG: errors by frame, and times by frame; by matplotlib, imported where it is used."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...optics.catalog import METHODS, label_of
from ...report.html import peer_title
from ..charts.chart_draw import drawing, figure_of, finish, method_style
from .summary import MEASURES, names_of, values_of
from .text import headline
from .times import SLOW

CURVES = ("flip", "flicker", "pop", "angle_p95", "holes")
"""Measures that are drawn, from above"""
PANEL = (9.0, 2.0)
"""Inches"""
PEER_COLORS = ("#999999", "#777777", "#555555", "#333333", "#BB9977", "#887755", "#AAAA99", "#666655")
MOST_MARKED = 60
"""Frames up to which each has a mark"""


def color_of(name: str, peers: Sequence[str]) -> str:
    """Of a method, or of one of the peers, in curves and on the page."""
    return method_style(name)[0] if name in METHODS else PEER_COLORS[list(peers).index(name) % len(PEER_COLORS)]


def title_of(name: str) -> str:
    """Of a method or peer."""
    return label_of(name) if name in METHODS else peer_title(name)


def draw_curves(report: Mapping[str, Any], path: Path) -> None:
    """PATH.svg and PATH.png: a panel for each measure, a curve for each method and peer, its worst frame ringed, cuts
    as upright lines. Raises InputError without matplotlib."""
    entries = report["frames"]
    frames = [entry["frame"] for entry in entries]
    groups = [(group, name) for group in ("methods", "peers") for name in names_of(entries, group)]
    with drawing():
        shown = [key for key in CURVES if any(report[group][name].get(key) for group, name in groups)]
        figure, panels = figure_of(len(shown), 1, headline(report), PANEL)
        for key, (panel,) in zip(shown, panels, strict=True):
            for group, name in groups:
                values = values_of(entries, group, name, key) if group == "methods" or MEASURES[key].of_peers else []
                _draw(panel, frames, values, name, list(report["peers"]))
                worst = report[group][name].get(key)
                if worst and worst["worst"] > 0.0:
                    color = color_of(name, list(report["peers"]))
                    panel.plot(worst["worst_frame"], worst["worst"], "o", ms=9, mfc="none", mec=color, mew=1.2)
            _finish_panel(panel, frames, [cut["frame"] for cut in report["cuts"]], MEASURES[key].label)
            is_zero = all(not (report[group][name].get(key) or {}).get("worst") for group, name in groups)
            panel.set_ylim(0.0, 1.0 if is_zero else None)
            if key == "pop":
                panel.axhline(1.0, color="#BBBBBB", linewidth=0.8, linestyle="--", zorder=0)
        panels[-1][0].set_xlabel("frame")
        finish(figure, _handles([name for _, name in groups], list(report["peers"])), path)


def draw_times(times: Mapping[str, Any], about: str, path: Path) -> None:
    """PATH.svg and PATH.png: milliseconds by frame of methods, frames over SLOW times the median ringed. Raises
    InputError without matplotlib."""
    with drawing():
        figure, panels = figure_of(1, 1, f"{about}\nringed: over {SLOW:g} times the median", (PANEL[0], 3.5))
        panel = panels[0][0]
        frames: set[int] = set()
        for name, row in times["methods"].items():
            numbers = [int(frame) for frame in row["frames"]]
            frames |= set(numbers)
            _draw(panel, numbers, list(row["frames"].values()), name, [])
            slow = [row["frames"][str(frame)] for frame in row["slow_frames"]]
            panel.plot(row["slow_frames"], slow, "o", ms=9, mfc="none", mec=color_of(name, []), mew=1.2)
        _finish_panel(panel, sorted(frames), [], "ms")
        _set_plain_log(panel)
        panel.set_xlabel("frame")
        finish(figure, _handles(list(times["methods"]), []), path)


def _draw(panel: Any, frames: Sequence[int], values: Sequence[float | None], name: str, peers: Sequence[str]) -> None:
    if not any(value is not None for value in values):
        return
    known = np.array([np.nan if value is None else value for value in values], np.float64)
    marker = (method_style(name)[1] if name in METHODS else "d") if len(frames) <= MOST_MARKED else ""
    style = "-" if name in METHODS else "--"
    color = color_of(name, peers)
    panel.plot(frames, known, color=color, linestyle=style, linewidth=1.2, marker=marker, markersize=4)


def _finish_panel(panel: Any, frames: Sequence[int], cuts: Sequence[int], label: str) -> None:
    from matplotlib.ticker import MaxNLocator

    panel.grid(True, color="#E6E6E6", linewidth=0.6)
    panel.set_axisbelow(True)
    panel.xaxis.set_major_locator(MaxNLocator(integer=True))
    margin = 0.5 if len(frames) < 2 else 0.02 * (frames[-1] - frames[0])
    panel.set_xlim(frames[0] - margin, frames[-1] + margin)
    panel.set_ylabel(label, fontsize=9)
    for cut in cuts:
        panel.axvline(cut - 0.5, color="#CC3311", linewidth=1.0, linestyle=":")


def _set_plain_log(panel: Any) -> None:
    """A logarithmic axis with numbers as people write them."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    panel.set_yscale("log")
    panel.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.10g}"))
    panel.yaxis.set_minor_locator(NullLocator())


def _handles(names: Sequence[str], peers: Sequence[str]) -> list[Any]:
    from matplotlib.lines import Line2D

    return [
        Line2D(
            [],
            [],
            color=color_of(name, peers),
            marker=method_style(name)[1] if name in METHODS else "d",
            markersize=5,
            linestyle="-" if name in METHODS else "--",
            linewidth=1.2,
            label=title_of(name),
        )
        for name in names
    ]
