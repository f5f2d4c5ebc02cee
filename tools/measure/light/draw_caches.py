# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The chart of caches of light: error against rays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

LOOKS = {"patches": ("#0077BB", "o"), "probes": ("#EE3377", "s")}
SHADES = (0.35, 0.55, 0.75, 1.0)
"""Opacity, from few of them to many"""
ERRORS = {"off": "root mean square error / mean", "median": "median of relative errors"}
"""Rows of panels: fields of `measure_caches.Row`"""


def draw(rows: Sequence[Any], noises: Mapping[str, float], path: Path) -> None:
    """`rows`: of `measure_caches`; `noises`: of the truth, by scene."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.8 * len(noises) + 0.4, 7.4), layout="constrained")
    panels = figure.subplots(len(ERRORS), len(noises), squeeze=False, sharey="row")
    figure.suptitle(
        "Light from other surfaces where mirrors show them: error against rays; lower left is better", fontsize=10
    )
    for line, (field, label) in zip(panels, ERRORS.items(), strict=True):
        for panel, (scene, noise) in zip(line, noises.items(), strict=True):
            _draw_panel(panel, [row for row in rows if row.scene == scene], field)
            if field == "off":
                panel.axhline(noise, color="#777777", linestyle=":", label="noise of what is right")
                panel.set_title(scene, fontsize=12, fontweight="bold")
                panel.legend(fontsize=7)
            else:
                panel.set_xlabel("rays followed")
        line[0].set_ylabel(label)
    figure.savefig(path, dpi=100)


def _draw_panel(panel: Any, rows: Sequence[Any], field: str) -> None:
    for cache, (color, marker) in LOOKS.items():
        of_cache = [row for row in rows if row.cache == cache]
        for place, count in enumerate(dict.fromkeys(row.number for row in of_cache)):
            same = [row for row in of_cache if row.number == count]
            panel.plot(
                [row.rays for row in same],
                [getattr(row, field) for row in same],
                color=color,
                marker=marker,
                alpha=SHADES[min(place, len(SHADES) - 1)],
                label=f"{count:,} {cache}",
            )
        for row in of_cache:
            if row.is_ours:
                where = (row.rays, getattr(row, field))
                panel.plot(*where, "o", markersize=13, fillstyle="none", color="#000000")
                panel.annotate("ours", where, (8, 8), textcoords="offset points", fontsize=9)
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.grid(True, which="both", color="#E6E6E6", linewidth=0.6)
    panel.set_axisbelow(True)
