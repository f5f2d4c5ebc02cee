# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verb `dataset`: make the data set, or judge results by it."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from ..errors import InputError
from ..output import checked_folder
from ..settings_table import MOST_REFERENCE_SAMPLES
from ..streams import STDOUT, dropped
from .arguments import between, resolution

SIZE, SAMPLES = (640, 480), 1024
"""Of the references of version 1"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Of the verb."""
    parser.add_argument("scenes", nargs="*", metavar="NAME", help="all ten of them where none is named")
    parser.add_argument("--output", metavar="DIR", help="folder to write to; what is there and whole stays")
    parser.add_argument("--resolution", type=resolution, metavar="WxH", help="in pixels (640x480)")
    parser.add_argument(
        "--samples",
        type=between(1, MOST_REFERENCE_SAMPLES),
        default=SAMPLES,
        metavar="N",
        help="of Cycles (%(default)s)",
    )
    parser.add_argument(
        "--judge",
        nargs=2,
        metavar=("DIR", "RESULTS"),
        help="compare NAME.exr and NAME_position.exr with the references",
    )
    parser.add_argument("--json", action="store_true", help="print the judgment as JSON")


def dataset(options: argparse.Namespace) -> int:
    """Make scenes with references, or judge somebody's results; see `study.dataset`."""
    if options.judge is not None:
        folder, results = options.judge
        return _judge(folder, results, options.json)
    if options.output is None:
        raise InputError("Name the folder to write to: --output DIR.")
    output = checked_folder(options.output)

    from ..study.dataset.dataset import Size, chosen_scenes, make_dataset

    chosen_scenes(options.scenes)
    width, height = options.resolution or SIZE
    with dropped(STDOUT):
        made = make_dataset(
            options.scenes,
            Size(width, height, options.samples),
            output,
            lambda line: print(line, file=sys.stderr, flush=True),
        )
    print(f"Made: {', '.join(made) or 'nothing, all is there'}")
    print(f"Data set: {output / 'dataset.json'}")
    return 0


def _judge(folder: str, results: str, as_json: bool) -> int:
    from ..study.dataset import judge

    for name in (folder, results):
        if not Path(name).is_dir():
            raise InputError(f'There is no folder "{name}": name the data set and the folder with the results.')
    verdicts = judge.judge(Path(folder).absolute(), Path(results).absolute())
    print(json.dumps(judge.as_json(verdicts), indent=1) if as_json else judge.format_verdicts(verdicts))
    return 0
