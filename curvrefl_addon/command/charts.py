# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verb `chart`: time against error and vertices, or against amounts of what a scene has.

As `verbs`: it takes the parsed options, returns an exit code, and raises InputError for what the user can put right.
"""

from __future__ import annotations

import argparse
from collections.abc import Generator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import InputError
from ..optics.catalog import METHODS
from ..output import checked_folder
from ..streams import STDOUT, dropped, readable
from .inputs import open_scene, read_names, read_scene, registered, require_known, resolution_of, start_gpu, warn_of

if TYPE_CHECKING:
    import bpy

    from ..report.compare import Step
    from ..study.charts.chart import ChartFile
    from ..study.charts.costs.axes import Axis

AGAINST = ("triangles", "pixels", "lights", "images", "image-size", "mirrors", "bounces", "all")
"""What time can be charted against in place of error"""
OF_ERRORS: dict[str, Any] = {
    "samples": 64,
    "peers": "eevee,cycles1,cycles8,cycles64",
    "sub_frames": "",
    "vertices": 1_000_000,
}
"""Defaults of the options that have no meaning there"""
COSTS_SIZE = (640, 480)
"""Of the picture in scenes of our own"""


def chart(options: argparse.Namespace) -> int:
    """Time against error, and against vertices; see `study.charts.chart`. Or against amounts: `study.charts.costs`."""
    if options.against is not None:
        return _chart_costs(options)
    if not options.files:
        raise InputError("Name at least one FILE.blend, or what to chart time against by --against.")
    methods = _methods(options.method or "all")
    peers = [] if options.peers.strip() == "none" else read_names(options.peers, "peer")
    reflectors = [] if options.reflector is None else read_names(options.reflector, "reflector")
    sub_frames = _sub_frames(options.sub_frames)
    output = checked_folder(options.output)
    start_gpu()

    from ..report.compare import Comparison
    from ..study.charts.chart import chart_steps
    from ..study.charts.chart_draw import require_matplotlib
    from ..study.charts.chart_table import format_chart

    require_matplotlib()
    comparison = Comparison(methods=tuple(methods), samples=options.samples, light=options.light, peers=tuple(peers))
    # All files are looked at first: what is wrong with the last one shows before minutes of Cycles.
    files = [_chart_file(options, file, name, reflectors) for file, name in _scene_names(options.files)]
    charts = _shown(chart_steps(files, comparison, options.vertices, output, sub_frames))
    warn_of(charts.warnings)
    print(format_chart(charts))
    print(f"Charts: {output / 'chart.png'}")
    return 0


def _chart_costs(options: argparse.Namespace) -> int:
    """Along each axis, in scenes of our own or in a file's."""
    names = read_names(options.against, "amount")
    require_known(names, AGAINST, "amount")
    for option, default in OF_ERRORS.items():
        if getattr(options, option) != default:
            raise InputError(f"--{option.replace('_', '-')} is for charts of errors: leave it out beside --against.")
    if len(options.files) > 1:
        raise InputError("Name one FILE.blend beside --against, or none for scenes of our own.")
    require_known([options.light], ("direct", "full"), "light")
    if not options.files and (options.light != "direct" or options.reflector is not None):
        raise InputError("Scenes of our own have their mirrors and direct light: name a FILE.blend for others.")
    methods = _methods(options.method) if options.method else []
    output = checked_folder(options.output)
    start_gpu()

    from ..study.charts.chart_draw import require_matplotlib
    from ..study.charts.costs.axes import DEFAULT_METHODS, chosen_axes
    from ..study.charts.costs.chart import costs_chart_steps, format_costs

    require_matplotlib()
    axes = _axes_of_file(options, names) if options.files else chosen_axes(names)
    scene_name = readable(Path(options.files[0]).stem) if options.files else ""
    size = options.resolution or COSTS_SIZE
    costs = _shown(costs_chart_steps(axes, methods or DEFAULT_METHODS, size, scene_name, output))
    print(format_costs(axes, costs))
    print(f"Charts: {output / 'costs.png'}")
    return 0


def _axes_of_file(options: argparse.Namespace, names: Sequence[str]) -> list[Axis]:
    """Of the file as it renders. Raises InputError for what is wrong with it."""
    from dataclasses import replace

    from ..report.direct_light import in_direct_light
    from ..study.charts.costs.axes import axes_of_file

    (file,) = options.files
    reflectors = [] if options.reflector is None else read_names(options.reflector, "reflector")
    found = _chart_file(options, file, file, reflectors)
    options.camera = None
    import bpy

    scene = bpy.context.scene
    assert scene is not None, "an open file has a scene"
    arrays, view = read_scene(options, scene, found.reflectors)
    if options.light == "direct":
        arrays = in_direct_light(arrays)
    return axes_of_file(names, arrays, replace(view, lens=None))


def _methods(text: str) -> list[str]:
    """Those named, or all."""
    methods = list(METHODS) if text.strip() == "all" else read_names(text, "method")
    require_known(methods, list(METHODS), "method")
    return methods


def _shown[T](steps: Generator[Step, None, T]) -> T:
    """Take all steps and say each; returns what they return."""
    with dropped(STDOUT) as stdout:
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                result: T = end.value
                return result
            print(f"{100.0 * step.done:3.0f} %  {step.label}", file=stdout, flush=True)


def _sub_frames(text: str) -> tuple[int, ...]:
    """Numbers of sub-frames to chart, least first. Raises InputError for what is none."""
    from ..renderer.settings import Settings, check_settings

    try:
        numbers = tuple(sorted({int(part) for part in text.split(",") if part.strip()}))
    except ValueError:
        raise InputError(f'"{text}" names no numbers of sub-frames: give them as in 1,4,16.') from None
    for number in numbers:
        check_settings(Settings(samples=number))
    return numbers


def _scene_names(files: Sequence[str]) -> list[tuple[str, str]]:
    """The files, once each, with their names in a chart: the name of the file, or its path where two share it."""
    stems = [Path(file).stem for file in dict.fromkeys(files)]
    return [
        (file, stem if stems.count(stem) == 1 else file) for file, stem in zip(dict.fromkeys(files), stems, strict=True)
    ]


def _chart_file(options: argparse.Namespace, file: str, name: str, reflectors: Sequence[str]) -> ChartFile:
    """What to chart of a file. Raises InputError where that cannot be."""
    from ..scene.opened.blend_file import find_camera, find_reflectors
    from ..study.charts.chart import ChartFile

    scene = open_scene(file)
    find_camera(scene)
    chosen = list(reflectors) or _marked_mirrors(scene)
    if not chosen:
        raise InputError(
            f'No object of "{file}" is marked as a mirror: mark one in Blender, or name it by --reflector.'
        )
    find_reflectors(scene, chosen)
    return ChartFile(readable(name), Path(file), tuple(chosen), *resolution_of(options, scene))


def _marked_mirrors(scene: bpy.types.Scene) -> list[str]:
    """Names of the objects whose Mirror switch is on."""
    from ..options import marked_mirrors

    with registered():
        return [mirror.name for mirror in marked_mirrors(scene)]
