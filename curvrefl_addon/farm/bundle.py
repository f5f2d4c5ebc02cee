# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Job bundles of comparisons over frames: an Open Job Description template with all that a submission needs beside it.

A bundle is a folder with `template.yaml`, `parameter_values.yaml` and `asset_references.yaml`, as Deadline Cloud takes
it (https://docs.aws.amazon.com/deadline-cloud/latest/developerguide/build-job-bundle.html); the template alone is Open
Job Description, version 2023-09, with its extension for chunks
(https://github.com/OpenJobDescription/openjd-specifications/wiki/2023-09-Template-Schemas).
"""

from __future__ import annotations

import json
import string
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import InputError

_FOLDER = Path(__file__).resolve().parent
FLAMENCO_JOB_TYPE = _FOLDER / "curvrefl_comparison.js"
"""For the folder `scripts` of a Flamenco Manager"""
_TEMPLATE = _FOLDER / "comparison.yaml"
_ARGUMENT_INDENT = 12 * " "
_LONGEST_NAME = 128
"""Characters of a job's name"""
_NAME = ": Curvrefl against Cycles"
_REFERENCE = "{{"
"""Where references to parameters begin"""
_PATHS = ("File", "Output")
"""Parameters that farms map to the workers' own paths. They have no defaults: an absolute one would not be mapped"""


@dataclass(frozen=True, slots=True)
class ComparisonJob:
    """A comparison over frames, as a farm is to do it. Texts are as the verb `chunk` takes them."""

    file: Path
    """The .blend file, absolute"""
    output: Path
    """The report's folder, absolute"""
    frames: str
    frames_per_task: int
    reflectors: str
    methods: str
    peers: str
    resolution: str
    samples: int
    light: str
    program: Sequence[str]
    """What runs a verb on the workers: Blender and its arguments before the verb, or the launcher of the source"""
    more: Sequence[str] = ()
    """Other arguments of `chunk`"""
    files: Sequence[Path] = ()
    """What the .blend file reads beside itself, absolute"""


def write_bundle(job: ComparisonJob, folder: Path) -> None:
    """Write the three files into a folder that is there. Raises InputError for arguments that no job can have."""
    program, *before = job.program
    for argument in (*before, *job.more):
        if _REFERENCE in argument:
            raise InputError(f'"{argument}" has "{_REFERENCE}" in it, which means something else to farms: rename it.')
    name = "".join(letter for letter in job.file.stem if letter.isprintable()).replace(_REFERENCE, "{")
    fields = {
        "name": name[: _LONGEST_NAME - len(_NAME)] + _NAME,
        "frames": job.frames,
        "frames_per_task": job.frames_per_task,
        "reflectors": job.reflectors,
        "methods": job.methods,
        "peers": job.peers,
        "resolution": job.resolution,
        "samples": job.samples,
        "light": job.light,
        "program": program,
    }
    template = string.Template(_TEMPLATE.read_text(encoding="utf-8")).substitute(
        {name: _scalar(value) for name, value in fields.items()}, before=_lines(before), more=_lines(job.more)
    )
    # (A list that is empty leaves an empty line.)
    lines = [line for line in template.splitlines() if line]
    values = {"parameterValues": [{"name": name, "value": str(getattr(job, name.lower()))} for name in _PATHS]}
    assets = {
        "assetReferences": {
            "inputs": {"filenames": sorted(map(str, job.files)), "directories": []},
            "outputs": {"directories": []},
        }
    }
    (folder / "template.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    for name, content in (("parameter_values", values), ("asset_references", assets)):
        text = json.dumps(content, indent=2, ensure_ascii=False)
        (folder / f"{name}.yaml").write_text(text + "\n", encoding="utf-8")


def _scalar(value: object) -> str:
    """A text or a number in YAML, which knows all of JSON."""
    return json.dumps(value, ensure_ascii=False)


def _lines(arguments: Sequence[str]) -> str:
    return "\n".join(f"{_ARGUMENT_INDENT}- {_scalar(argument)}" for argument in arguments)
