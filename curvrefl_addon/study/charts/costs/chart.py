# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Time against amounts: costs.csv, .svg and .png, and the slopes as text."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from pathlib import Path

import bpy

from ....output import folder_to_publish
from ....renderer.device.context import renderer_name
from ....report.compare import Step
from ....report.table import aligned, milliseconds
from ..chart import counted
from ..chart_draw import require_matplotlib
from ..chart_marks import write_csv
from .axes import Axis
from .drawn import draw_costs
from .measured import cost_steps, step_count
from .scenes import Size
from .slopes import Cost, rows


@dataclass(frozen=True, slots=True)
class Costs:
    """What was measured."""

    costs: tuple[Cost, ...]
    warnings: tuple[str, ...]
    """One sentence each"""


def costs_chart_steps(
    axes: Sequence[Axis], methods: Sequence[str], size: Size, scene_name: str, output: Path
) -> Generator[Step, None, Costs]:
    """Measure and draw into the folder `output`; yields before each step, closed before the end it leaves nothing.

    `scene_name`: of a file, or nothing for scenes of our own; other arguments as of `cost_steps`. Raises InputError
    without matplotlib before anything else.
    """
    require_matplotlib()
    count = step_count(axes) + 1
    with folder_to_publish(output) as folder:
        costs, warnings = yield from counted(cost_steps(axes, methods, size), 0, count)
        yield Step("Drawing", 1.0 - 1.0 / count)
        write_csv(rows(costs), folder / "costs.csv")
        of = f" of {scene_name}" if scene_name else ""
        machine = f"{renderer_name()}, Blender {bpy.app.version_string}"
        headline = f"Time of a frame{of} against what it shows; numbers: slope in logarithms\n{machine}"
        draw_costs(axes, costs, headline, folder)
    yield Step(f"Wrote {output / 'costs.png'}", 1.0)
    return Costs(tuple(costs), tuple(warnings))


def format_costs(axes: Sequence[Axis], costs: Costs) -> str:
    """As lines of text, a table for each axis."""
    lines = []
    for axis in axes:
        here = [cost for cost in costs.costs if cost.axis == axis.name]
        measured = [cost for cost in here if cost.amounts]
        if measured:
            longest = max(measured, key=lambda cost: len(cost.amounts))
            titles = (axis.label, *(f"{amount:,.0f}" for amount in longest.amounts), "slope", "quartiles", "at the end")
            lines += [*aligned([titles, *(_cells(cost, len(longest.amounts)) for cost in measured)]), ""]
        lines += [f"{cost.method} is left out, or ends there: {cost.reason}" for cost in here if cost.reason]
        lines += [""] if any(cost.reason for cost in here) else []
    lines += [
        "Milliseconds of a frame of one sub-frame, medians. The slope is that of a line through logarithms: 0 does not",
        "grow, 1 grows in proportion; the end is that between the last two.",
        *(f"Warning: {warning}" for warning in costs.warnings),
    ]
    return "\n".join(lines)


def _cells(cost: Cost, count: int) -> tuple[str, ...]:
    times = [milliseconds(timing.median) for timing in cost.timings]
    slope = cost.slope
    slopes = ("-", "-", "-")
    if slope is not None:
        slopes = (f"{slope.median:.2f}", f"{slope.low:.2f}..{slope.high:.2f}", f"{slope.end:.2f}")
    return (cost.method, *times, *["-"] * (count - len(times)), *slopes)
