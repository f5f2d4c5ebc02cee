# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparisons over frames on render farms: pieces of them, and what farms are told; see `verbs`."""

from __future__ import annotations

import argparse
import shlex
import shutil
from collections.abc import Iterator
from pathlib import Path

from ..errors import InputError
from ..farm.bundle import FLAMENCO_JOB_TYPE, ComparisonJob, write_bundle
from ..output import checked_folder, folder_to_publish
from ..settings_table import RENDERER
from .arguments import between, frames_of
from .inputs import SETTING
from .scene_arguments import MAX_FRAME, add_comparison, add_file
from .sequence_verbs import asked_comparison, compare_frames

OPENJD = "openjd"
"""https://github.com/OpenJobDescription: lines on stdout that tell a worker how far its task is"""


def chunk(options: argparse.Namespace) -> int:
    """Compare frames that are left; where asked for, tell of it as Open Job Description has it."""
    step = (options.of or options.frames).step
    if options.of is not None and (outside := [frame for frame in options.frames if frame not in options.of]):
        raise InputError(f"Frame {outside[0]} of --frames is not among those of --of: name a part of them.")
    options.frame, options.resume = None, True
    if options.progress is None:
        compare_frames(options, step)
        return 0
    frames = options.frames

    def told(frame: int, label: str) -> Iterator[str]:
        yield f"openjd_progress: {100.0 * frames.index(frame) / len(frames):.1f}"
        yield f"openjd_status: Frame {frame}: {label}"

    try:
        compare_frames(options, step, told)
    except InputError as error:
        print(f"openjd_fail: {error}", flush=True)
        raise
    print("openjd_progress: 100", flush=True)
    return 0


def add_chunk(parser: argparse.ArgumentParser) -> None:
    """The arguments of `chunk`."""
    add_file(parser)
    parser.add_argument(
        "--frames", type=frames_of, required=True, metavar="A-B[:STEP]", help="to compare; also A,B,.. of one step"
    )
    parser.add_argument(
        "--of", type=frames_of, metavar="A-B[:STEP]", help="all frames of the comparison, where their step is not 1"
    )
    add_comparison(parser)
    parser.add_argument("--progress", choices=(OPENJD,), help="also print lines that tell a farm how far it is")
    parser.add_argument("--output", required=True, metavar="DIR", help="folder of the whole comparison")


def job_type(options: argparse.Namespace) -> int:
    """Write the job type for Flamenco's Manager."""
    output = checked_folder(options.output)
    with folder_to_publish(output) as folder:
        shutil.copyfile(FLAMENCO_JOB_TYPE, folder / FLAMENCO_JOB_TYPE.name)
    print(output / FLAMENCO_JOB_TYPE.name)
    return 0


def bundle(options: argparse.Namespace) -> int:
    """Write a job bundle with an Open Job Description template, for a file, and say how it is run."""
    program = shlex.split(options.program)
    if not program:
        raise InputError("The program is empty: name Blender with the extension, or the launcher of the source.")
    options.frame = None
    scene, reflectors, comparison, output = asked_comparison(options, needs_gpu=False)

    from ..farm.files import files_read
    from ..scene.opened.blend_file import find_camera, find_reflectors

    find_reflectors(scene, reflectors)
    if options.camera is not None:
        find_camera(scene, options.camera)
    job = ComparisonJob(
        file=Path(options.file).absolute(),
        output=Path(options.report).absolute(),
        frames=_said(options.frames),
        frames_per_task=options.frames_per_task,
        reflectors=",".join(reflectors),
        methods=",".join(comparison.methods),
        peers=",".join(comparison.peers) or "none",
        resolution=f"{comparison.width}x{comparison.height}",
        samples=comparison.samples,
        light=comparison.light,
        program=program,
        more=tuple(_more(options)),
        files=files_read(),
    )
    with folder_to_publish(output) as folder:
        write_bundle(job, folder)
    where = shlex.join(["-p", f"File={job.file}", "-p", f"Output={job.output}"])
    print(f"Job bundle: {output}")
    print(f"Here: openjd run {shlex.quote(str(output / 'template.yaml'))} --step Merge --run-dependencies {where}")
    print(f"Deadline Cloud: deadline bundle submit {shlex.quote(str(output))}")
    return 0


def add_farm(parser: argparse.ArgumentParser, kind: type[argparse.ArgumentParser]) -> None:
    """The arguments of `farm`; those of each system are read by a parser of this kind."""
    systems = parser.add_subparsers(title="systems", metavar="SYSTEM", required=True, parser_class=kind)
    text = "Write the job type for Flamenco 3: its folder is scripts, beside flamenco-manager."
    flamenco = systems.add_parser("flamenco", help=text, description=text)
    flamenco.set_defaults(run=job_type)
    flamenco.add_argument("--output", required=True, metavar="DIR", help="folder to write to")

    text = "Write a job bundle: an Open Job Description template, fit for Deadline Cloud too."
    openjd = systems.add_parser("openjd", help=text, description=text)
    openjd.set_defaults(run=bundle)
    add_file(openjd)
    openjd.add_argument("--frames", type=frames_of, required=True, metavar="A-B[:STEP]", help="to compare")
    add_comparison(openjd)
    openjd.add_argument(
        "--frames-per-task",
        type=between(1, MAX_FRAME),
        default=8,
        metavar="N",
        help="that a worker compares before it asks for others (%(default)s)",
    )
    openjd.add_argument(
        "--program",
        default="blender --command curvrefl",
        metavar="P",
        help="what runs verbs on the workers; or the launcher in a copy of the source ('%(default)s')",
    )
    openjd.add_argument("--report", required=True, metavar="DIR", help="folder of the report, which all workers see")
    openjd.add_argument("--output", required=True, metavar="DIR", help="folder of the bundle")


def _said(frames: range) -> str:
    """As Open Job Description and `frames_of` read them."""
    if len(frames) == 1:
        return str(frames[0])
    return f"{frames[0]}-{frames[-1]}" + (f":{frames.step}" if frames.step != 1 else "")


def _more(options: argparse.Namespace) -> Iterator[str]:
    """Arguments for `chunk` that the template has no parameters for, where they are not as by default."""
    if options.camera is not None:
        yield f"--camera={options.camera}"
    for item in RENDERER:
        for flag in item.flags:
            value = getattr(options, f"{SETTING}{item.name}", None)
            if flag.verb == "compare" and value != item.flag_value(flag):
                yield flag.spelling if isinstance(value, bool) else f"{flag.spelling}={value}"
