# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparisons of a frame, of frames, and the report over frames; see `verbs`."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..optics.catalog import METHODS
from ..output import checked_folder, clean_up
from ..streams import STDOUT, dropped
from .arguments import frames_of
from .inputs import (
    chosen_settings,
    frames_left,
    open_scene,
    read_names,
    require_known,
    resolution_of,
    start_gpu,
    view_layer_of,
    warn_of,
)

if TYPE_CHECKING:
    import bpy

    from ..report.compare import Comparison


def merge(options: argparse.Namespace) -> int:
    """Write the report over frames that are compared in the folder `options.output`; see `study.sequence.merge`."""
    output = checked_folder(options.output)

    from ..study.charts.chart_draw import MISSING_MATPLOTLIB, has_matplotlib
    from ..study.sequence.merge import TIMES, merge_frames
    from ..study.sequence.text import format_sequence
    from ..study.sequence.times import slow_sentences

    print(format_sequence(merge_frames(output, options.frames)))
    print("\n".join(slow_sentences(json.loads((output / TIMES).read_text(encoding="utf-8")))))
    if not has_matplotlib():
        warn_of([MISSING_MATPLOTLIB])
    print(f"Report: {output / 'report.html'}")
    return 0


def compare_frames(
    options: argparse.Namespace, step: int | None = None, told: Callable[[int, str], Iterable[str]] = lambda *_: ()
) -> None:
    """Compare the frames of `options.frames`, each into its folder; with `--resume` those that are left.

    `step`: from one to the next in the comparison that they are a part of. `told`: lines to print before what is done
    next, from the frame and what that is, in place of that alone.
    """
    scene, reflectors, comparison, output = asked_comparison(options)

    from ..study.sequence.frames import compare_frame, made_with
    from ..study.sequence.kept import folder_of, made_of

    step = step or options.frames.step
    made = made_with(Path(options.file), scene.name, reflectors, options.camera, comparison, step)

    def is_done(frame: int) -> bool:
        clean_up(folder_of(output, frame))
        return made_of(folder_of(output, frame)) == made

    for frame in frames_left(options, scene, is_done):
        folder = folder_of(output, frame)
        with _said() as say:

            def progress(label: str, frame: int = frame, say: Callable[[str], None] = say) -> None:
                for line in tuple(told(frame, label)) or (label,):
                    say(line)

            report = compare_frame(
                scene, view_layer_of(scene), reflectors, comparison, folder, made, options.camera, progress
            )
        print_report(report, folder)


def asked_comparison(
    options: argparse.Namespace, needs_gpu: bool = True
) -> tuple[bpy.types.Scene, list[str], Comparison, Path]:
    """The open scene, the mirrors' names, what to compare, and the folder to write to. The GPU is there, if needed."""
    methods = list(METHODS) if options.method.strip() == "all" else read_names(options.method, "method")
    require_known(methods, list(METHODS), "method")
    peers = [] if options.peers.strip() == "none" else read_names(options.peers, "peer")
    reflectors = read_names(options.reflector, "reflector")
    output = checked_folder(options.output)
    if needs_gpu:
        start_gpu()
    else:
        import bpy  # noqa: F401  (with the wheel, before gpu)

    from ..report.compare import Comparison

    comparison = Comparison(
        methods=tuple(methods),
        samples=options.samples,
        light=options.light,
        peers=tuple(peers),
        settings=chosen_settings(options),
    )
    scene = open_scene(options.file, options.frame)
    width, height = resolution_of(options, scene)
    return scene, reflectors, replace(comparison, width=width, height=height), output


def compare_scene(
    scene: bpy.types.Scene,
    reflectors: Sequence[str],
    comparison: Comparison,
    output: Path,
    camera: str | None = None,
) -> dict[str, Any]:
    """Compare the open scene and write the report into `output`; returns it."""
    from ..report.compare import compare_open_scene

    with _said() as say:
        return compare_open_scene(
            scene, view_layer_of(scene), reflectors, comparison, output, camera=camera, progress=say
        )


@contextmanager
def _said() -> Iterator[Callable[[str], None]]:
    """Prints lines, and Blender none."""
    with dropped(STDOUT) as stdout:
        yield lambda text: print(text, file=stdout, flush=True)


def print_report(report: dict[str, Any], output: Path) -> None:
    """The table of a comparison, and where its page is."""
    from ..report.table import format_table

    print(format_table(report))
    print(f"Report: {output / 'report.html'}")


def add_merge(parser: argparse.ArgumentParser) -> None:
    """The arguments of `merge`."""
    parser.add_argument("output", metavar="DIR", help="output of compare --frames, whoever compared which frame")
    parser.add_argument(
        "--frames", type=frames_of, metavar="A-B[:STEP]", help="which of them (all, from the first to the last)"
    )
