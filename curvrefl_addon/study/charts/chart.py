# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The charts of one or more scenes: chart.csv, .svg and .png, and vertex_count.csv, .svg and .png.

They are moved into the output folder at the end: charts that fail leave nothing.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import bpy

from ...output import folder_to_publish
from ...renderer.device.context import renderer_name
from ...report.compare import Comparison, Step
from ...scene.opened.blend_file import open_blend
from ...scene.opened.render_depsgraph import read_render_scene
from ...streams import readable
from .chart_data import scene_steps, step_count
from .chart_draw import draw_chart, draw_vertex_count, has_matplotlib, require_matplotlib
from .chart_marks import LEVELS, Mark, rows, write_csv
from .vertex_count import vertex_count_steps
from .vertex_curves import Curve, counts_up_to
from .vertex_curves import rows as vertex_count_rows


@dataclass(frozen=True, slots=True)
class Charts:
    """What was measured."""

    marks: tuple[Mark, ...]
    curves: tuple[Curve, ...] = ()
    warnings: tuple[str, ...] = ()
    """One sentence each"""


@dataclass(frozen=True, slots=True)
class ChartFile:
    """A .blend file to chart."""

    name: str
    """In the charts"""
    path: Path
    reflectors: tuple[str, ...]
    width: int
    height: int


def chart_open_scene(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    reflector_names: Sequence[str],
    comparison: Comparison,
    output: Path,
) -> Charts:
    """Take all of `open_scene_steps`."""
    steps = open_scene_steps(scene, view_layer, reflector_names, comparison, output)
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value


def open_scene_steps(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    reflector_names: Sequence[str],
    comparison: Comparison,
    output: Path,
) -> Generator[Step, None, Charts]:
    """Chart the open scene alone, without vertex counts, into the folder `output`; without matplotlib only the CSV.

    Yields before each step; closed between two of them it leaves nothing, and the scene as it was. Raises as
    `chart_data.scene_steps`.
    """
    name = readable(Path(bpy.data.filepath).stem) or scene.name
    count = step_count(comparison) + 1
    with folder_to_publish(output) as folder:
        steps = scene_steps(scene, view_layer, reflector_names, comparison, name)
        marks, warnings = yield from counted(steps, 0, count)
        yield Step("Drawing", 1.0 - 1.0 / count)
        charts = Charts(tuple(marks), warnings=tuple(dict.fromkeys(warnings)))
        _write(charts, comparison, folder)
    yield Step(f"Wrote {output / 'chart.csv'}", 1.0)
    return charts


def chart_steps(
    files: Sequence[ChartFile], comparison: Comparison, largest: int, output: Path, sub_frames: Sequence[int] = ()
) -> Generator[Step, None, Charts]:
    """Chart files, each in its own resolution, and the solve of up to `largest` vertices around the first's mirror.

    `sub_frames`: as of `chart_data.sweep`. As `open_scene_steps`. Raises InputError without matplotlib before anything
    else.
    """
    require_matplotlib()
    per_file = step_count(comparison, sub_frames)
    counting = len(counts_up_to(largest))
    count = counting + len(files) * per_file + 1
    marks: list[Mark] = []
    curves: list[Curve] = []
    warnings: list[str] = []
    with folder_to_publish(output) as folder:
        for index, file in enumerate(files):
            open_blend(file.path)
            scene, view_layer = bpy.context.scene, bpy.context.view_layer
            assert scene is not None and view_layer is not None, "an open file has both"
            if index == 0:
                arrays, view = read_render_scene(scene, view_layer, file.reflectors, file.width, file.height)
                curves = yield from counted(vertex_count_steps(arrays, view, comparison.methods, largest), 0, count)
            here = replace(comparison, width=file.width, height=file.height)
            steps = scene_steps(scene, view_layer, file.reflectors, here, file.name, sub_frames)
            more, warned = yield from counted(steps, counting + index * per_file, count, f"{file.name}: ")
            marks += more
            warnings += [f"{file.name}: {warning}" for warning in warned]
        yield Step("Drawing", 1.0 - 1.0 / count)
        charts = Charts(tuple(marks), tuple(curves), tuple(dict.fromkeys(warnings)))
        # (What a pixel shows, and where vertices are reflected, is the same in any number of sub-frames.)
        _write(charts, comparison, folder, ("image",) if sub_frames else tuple(LEVELS))
    yield Step(f"Wrote {output / 'chart.png'}", 1.0)
    return charts


def counted[T](steps: Generator[str, None, T], first: int, count: int, prefix: str = "") -> Generator[Step, None, T]:
    """Labels as steps number `first`, `first` + 1, ... of `count`; returns what `steps` returns."""
    done = first
    while True:
        try:
            label = next(steps)
        except StopIteration as end:
            return end.value
        yield Step(f"{prefix}{label}", done / count)
        done += 1


def _write(charts: Charts, comparison: Comparison, folder: Path, levels: Sequence[str] = tuple(LEVELS)) -> None:
    write_csv(rows(charts.marks), folder / "chart.csv")
    machine = f"{renderer_name()}, Blender {bpy.app.version_string}"
    judged = f"against Cycles with {comparison.samples} samples of {comparison.light} light; lower left is better"
    if has_matplotlib():
        draw_chart(charts.marks, f"Time against error {judged}\n{machine}", folder, levels)
    if charts.curves:
        write_csv(vertex_count_rows(charts.curves), folder / "vertex_count.csv")
        draw_vertex_count(charts.curves, f"Time against vertices\n{machine}", folder)
