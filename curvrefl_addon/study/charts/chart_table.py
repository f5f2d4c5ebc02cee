# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What was charted as text for the terminal and for Blender's text editor."""

from __future__ import annotations

from collections.abc import Sequence

from ...report.table import aligned, milliseconds, number, percent
from .chart import Charts
from .chart_marks import LEVELS, Mark, front_marks

_COLUMNS = (
    "",
    "setting",
    "FLIP  ",
    "angle p95 deg  ",
    "wrong object  ",
    "frame ms",
    "vertex p95 px  ",
    "unsolved",
    "solve ms per million",
)


def format_chart(charts: Charts) -> str:
    """What `chart` measured as lines of text: a table per scene, times against vertices, what was left out."""
    lines = []
    for scene in dict.fromkeys(mark.scene for mark in charts.marks):
        here = [mark for mark in charts.marks if mark.scene == scene]
        lines += [f"{scene} (* on the Pareto front of this error and its time)", "", *aligned(chart_rows(here)), ""]
        lines += [f"{mark.name} is left out: {mark.reason}" for mark in here if mark.reason]
    for curve in charts.curves:
        if curve.reason:
            lines.append(f"{curve.method} is left out of the times against vertices: {curve.reason}")
        elif curve.fit is not None:
            lines.append(
                f"{curve.method}: {milliseconds(curve.timings[-1].median)} ms for {curve.counts[-1]:,} vertices, "
                f"time grows as vertices ^ {curve.fit.slope:.2f}"
            )
    lines += [f"Warning: {warning}" for warning in charts.warnings]
    return "\n".join(lines).rstrip("\n")


def chart_rows(marks: Sequence[Mark]) -> list[tuple[str, ...]]:
    """One row of text per mark of one scene, after a row of column titles; a star marks fronts."""
    fronts = {name: front_marks(level, marks) for name, level in LEVELS.items()}

    def starred(text: str, level: str, mark: Mark) -> str:
        return f"{text} *" if any(mark is other for other in fronts[level]) else f"{text}  "

    table: list[tuple[str, ...]] = [_COLUMNS]
    for mark in marks:
        if mark.reason:
            continue
        vertices = mark.vertices
        setting = "" if mark.value is None else f"{mark.setting} {mark.value:g}"
        table.append(
            (
                mark.name,
                f"{setting} (default)" if mark.is_default else setting,
                starred(number(mark.flip, 4), "image", mark),
                starred(number(mark.angle_deg[1], 2), "angle", mark),
                starred(percent(mark.wrong_object), "object", mark),
                milliseconds(None if mark.frame is None else mark.frame.median),
                starred(number(None if vertices is None else vertices.p95_px, 3), "vertex", mark),
                percent(None if vertices is None else vertices.unconverged),
                milliseconds(None if vertices is None else vertices.ms_per_million.median),
            )
        )
    return table
