# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The charts as SVG and PNG, by matplotlib, which is imported where it is used."""

from __future__ import annotations

import colorsys
import importlib.util
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ...diagnostics.colors import GOLDEN_RATIO
from ...errors import InputError
from ...optics.catalog import METHODS, label_of
from ...output import temporary_folder
from ...report.table import milliseconds
from .chart_marks import LEVELS, MOST_WRONG, Level, Mark, front_marks, point
from .vertex_curves import Curve

# Colors told apart by the color-blind: Paul Tol's "muted" scheme, black for the default method.
STYLES: dict[str, tuple[str, str]] = {
    "auto": ("#000000", "o"),
    "exact": ("#0077BB", "*"),
    "secant_star": ("#663333", "o"),
    "newton": ("#EE3377", "H"),
    "secant_uv": ("#332288", "s"),
    "bisector_cube": ("#CC6677", "^"),
    "bisector_grid": ("#882255", "v"),
    "bisector_screen": ("#DDAA33", "D"),
    "planar": ("#999933", "P"),
    "environment_cube": ("#44AA99", "<"),
    "environment_cube_vertex": ("#117733", ">"),
    "environment_sphere": ("#AA4499", "h"),
    "environment_parallax": ("#3399DD", "p"),
}
_MORE_MARKERS = ("8", "D", "s", "^", "v", "o")
_PEERS = {"eevee": ("EEVEE, ray tracing", "X"), "cycles": ("Cycles", "d")}
_PEER_COLOR = "#777777"
_FRONT_COLOR = "#BBBBBB"
PANEL = (4.4, 3.3)
"""Inches"""
LEGEND_WIDTH = 3.4
FADED = 0.35
"""Opacity"""
PNG_DPI = 110
MISSING_MATPLOTLIB = (
    "The charts need the Python package 'matplotlib', which this Python lacks: install it there, for example with "
    "'python -m pip install matplotlib'."
)


def method_style(name: str) -> tuple[str, str]:
    """Color and marker of a method of the catalog; one without an entry in STYLES gets its own by its place there."""
    if name in STYLES:
        return STYLES[name]
    place = list(METHODS).index(name)
    rgb = colorsys.hls_to_rgb(place * GOLDEN_RATIO % 1.0, 0.35, 0.6)
    return "#" + "".join(f"{round(255 * channel):02X}" for channel in rgb), _MORE_MARKERS[place % len(_MORE_MARKERS)]


def has_matplotlib() -> bool:
    """Whether charts can be drawn here."""
    return importlib.util.find_spec("matplotlib") is not None


def require_matplotlib() -> None:
    """Raise InputError, with what to install, where there is no matplotlib."""
    if not has_matplotlib():
        raise InputError(MISSING_MATPLOTLIB)


def draw_chart(marks: Sequence[Mark], headline: str, folder: Path, levels: Sequence[str] = tuple(LEVELS)) -> None:
    """chart.svg and chart.png into `folder`: a column of panels per scene, a row per level
    of these that anything is known of.

    Raises InputError without matplotlib.
    """
    with drawing():
        scenes = list(dict.fromkeys(mark.scene for mark in marks))
        asked = [LEVELS[name] for name in levels]
        drawn = [level for level in asked if any(point(level, mark) for mark in marks)] or asked
        figure, panels = figure_of(len(drawn), len(scenes), headline)
        for row, level in enumerate(drawn):
            for column, scene in enumerate(scenes):
                panel = panels[row][column]
                _draw_panel(panel, level, [mark for mark in marks if mark.scene == scene])
                panel.set_title(scene if row == 0 else "", fontsize=12, fontweight="bold")
                panel.set_ylabel(f"{level.title}\n{level.error_label}" if column == 0 else "", fontsize=9, ma="center")
            share_limits(panels[row])
        handles = [_method_handle(name, marks) for name in _methods(marks)]
        handles += [_peer_handle(name) for name in _PEERS if any(mark.name == name for mark in marks)]
        handles += _sign_handles()
        finish(figure, handles, folder / "chart")


def draw_vertex_count(curves: Sequence[Curve], headline: str, folder: Path) -> None:
    """vertex_count.svg and .png into `folder`. Raises InputError without matplotlib."""
    with drawing():
        from matplotlib.lines import Line2D

        figure, panels = figure_of(1, 1, headline, (7.0, 5.0))
        panel = panels[0][0]
        handles = []
        for curve in curves:
            if not curve.counts:
                continue
            color, marker = method_style(curve.method)
            median = np.array([timing.median for timing in curve.timings])
            spread = np.array([[t.median - t.low, t.high - t.median] for t in curve.timings]).T
            panel.errorbar(
                curve.counts, median, spread, color=color, marker=marker, markersize=6, linestyle="", elinewidth=1
            )
            label = label_of(curve.method)
            fit = curve.fit
            if fit is not None:
                counts = np.geomspace(curve.counts[0], curve.counts[-1], 60)
                panel.plot(counts, [fit.at(count) for count in counts], color=color, linewidth=1.2)
                label += f": slope {fit.slope:.2f}\n{milliseconds(fit.constant)} ms whatever the count"
            handles.append(Line2D([], [], color=color, marker=marker, linewidth=1.2, label=label))
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.grid(True, color="#E6E6E6", linewidth=0.6)
        panel.set_axisbelow(True)
        share_limits([panel])
        panel.set_xlabel("vertices")
        panel.set_ylabel("solve, ms (median and quartiles)")
        panel.set_title("lines: constant + factor × vertices ^ slope, least squares; slope 1 is linear", fontsize=9)
        finish(figure, handles, folder / "vertex_count")


def _methods(marks: Sequence[Mark]) -> list[str]:
    return [name for name in METHODS if any(mark.name == name and mark.frame is not None for mark in marks)]


def _draw_panel(panel: Any, level: Level, marks: Sequence[Mark]) -> None:
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.grid(True, which="major", color="#E6E6E6", linewidth=0.6)
    panel.set_axisbelow(True)
    panel.set_xlabel(level.time_label, fontsize=9)
    front = [point(level, mark) for mark in front_marks(level, marks)]
    if front:
        times, errors = np.array(front, np.float64).T
        panel.step(times, np.maximum(errors, level.smallest), where="post", color=_FRONT_COLOR, linewidth=5, zorder=1)
    for name in dict.fromkeys(mark.name for mark in marks):
        same = [mark for mark in marks if mark.name == name and point(level, mark) is not None]
        if not same:
            continue
        color, marker = (_PEER_COLOR, _PEERS[name][1]) if same[0].is_peer else method_style(name)
        places = np.array([point(level, mark) for mark in same])
        times, errors = places[:, 0], np.maximum(places[:, 1], level.smallest)
        alpha = 1.0 if any(level.may_lead(mark) for mark in same) else FADED
        panel.plot(times, errors, color=color, linewidth=0.9, alpha=alpha, zorder=2)
        for mark, time, error in zip(same, times, errors, strict=True):
            timing = level.timing(mark)
            assert timing is not None
            panel.errorbar(
                [time],
                [error],
                xerr=[[timing.median - timing.low], [timing.high - timing.median]],
                color=color,
                marker=marker,
                markersize=7,
                markerfacecolor=color if mark.is_default or mark.is_peer else "white",
                markeredgewidth=1.2,
                elinewidth=1,
                capsize=2,
                alpha=1.0 if level.may_lead(mark) else FADED,
                zorder=3,
            )
            if mark.is_peer and mark.value is not None:
                panel.annotate(
                    f"{mark.value:g}", (time, error), (6, 5), textcoords="offset points", fontsize=8, color=color
                )


def share_limits(panels: Sequence[Any]) -> None:
    """The panels of a row show the same errors and times, with few round numbers at their axes."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

    used = [panel for panel in panels if panel.has_data()]
    for name in ("x", "y"):
        limits = np.array([getattr(panel, f"get_{name}lim")() for panel in used or panels])
        low, high = limits[:, 0].min(), limits[:, 1].max()
        for panel in panels:
            getattr(panel, f"set_{name}lim")(low, high)
            axis = getattr(panel, f"{name}axis")
            axis.set_major_locator(FixedLocator(round_numbers(low, high)))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.10g}"))
            axis.set_minor_locator(NullLocator())


def round_numbers(low: float, high: float) -> list[float]:
    """Between 0 < `low` < `high`: powers of ten, and multiples of them where there are few."""
    decades = np.log10(high / low)
    factors: tuple[float, ...] = (1.0,) if decades > 3.0 else (1.0, 3.0) if decades > 1.5 else (1.0, 2.0, 5.0)
    if decades < 0.6:
        factors = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0)
    powers = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
    return [number for power in powers for factor in factors if low <= (number := factor * 10.0**power) <= high]


def _method_handle(name: str, marks: Sequence[Mark]) -> Any:
    method = METHODS[name]
    values = sorted({mark.value for mark in marks if mark.name == name and mark.value is not None})
    field = next((mark.setting for mark in marks if mark.name == name and mark.setting), "")
    varied = f"{field.replace('_', ' ')} {values[0]:g} to {values[-1]:g}" if len(values) > 1 else "no setting"
    return method_handle(name, f"{method.label}\n{varied}")


def method_handle(name: str, label: str) -> Any:
    """A method's line in a legend."""
    from matplotlib.lines import Line2D

    color, marker = method_style(name)
    return Line2D([], [], color=color, marker=marker, markersize=7, linewidth=0.9, label=label)


def _peer_handle(name: str) -> Any:
    from matplotlib.lines import Line2D

    title, marker = _PEERS[name]
    label = f"{title}\nsamples as numbered" if name == "cycles" else title
    return Line2D([], [], color=_PEER_COLOR, marker=marker, markersize=7, linewidth=0.9, label=label)


def _sign_handles() -> list[Any]:
    from matplotlib.lines import Line2D

    def sign(label: str, **style: Any) -> Any:
        return Line2D([], [], label=label, **style)

    return [
        sign("Pareto front", color=_FRONT_COLOR, linewidth=5),
        sign(
            f"faded: wrong object at over {100.0 * MOST_WRONG:.0f} % of the\npixels; on no front of angles",
            color="#000000",
            alpha=FADED,
            marker="o",
            linestyle="",
        ),
        sign("filled: default setting", color="#000000", marker="o", linestyle=""),
        sign("hollow: other settings", color="#000000", marker="o", markerfacecolor="white", linestyle=""),
        sign("bars: quartiles of the repeats", color="#000000", marker="_", markersize=14, linestyle=""),
    ]


def figure_of(rows: int, columns: int, headline: str, panel: tuple[float, float] = PANEL) -> tuple[Any, Any]:
    """The figure with room for a legend, and its panels, rows by columns."""
    from matplotlib.figure import Figure

    width, height = panel[0] * columns + LEGEND_WIDTH, panel[1] * rows + 0.5
    figure = Figure(figsize=(width, height), layout="constrained")
    figure.suptitle(headline, fontsize=10, x=0.01, horizontalalignment="left")
    return figure, figure.subplots(rows, columns, squeeze=False)


def finish(figure: Any, handles: Sequence[Any], path: Path) -> None:
    """Put the legend there and write PATH.png and PATH.svg."""
    figure.legend(handles=handles, loc="outside right center", fontsize=9, frameon=False, labelspacing=0.9)
    figure.savefig(path.with_suffix(".png"), dpi=PNG_DPI)
    # No date, no random names: the same numbers make the same file.
    figure.savefig(path.with_suffix(".svg"), metadata={"Date": None})


@contextmanager
def drawing() -> Iterator[None]:
    """matplotlib as it comes, whatever the user's settings; its cache of fonts goes to a temporary folder."""
    require_matplotlib()
    before = os.environ.get("MPLCONFIGDIR")
    with temporary_folder() as folder:
        os.environ["MPLCONFIGDIR"] = str(folder)
        try:
            import matplotlib

            with matplotlib.rc_context():
                matplotlib.rcdefaults()
                matplotlib.rcParams["svg.hashsalt"] = "curvrefl"
                yield
        finally:
            if before is None:
                del os.environ["MPLCONFIGDIR"]
            else:
                os.environ["MPLCONFIGDIR"] = before
