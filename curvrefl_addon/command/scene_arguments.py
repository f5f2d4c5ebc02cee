# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments that several verbs have: the file with its mirrors and frames, settings of the renderer, references."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

from ..errors import InputError
from ..optics.catalog import DEFAULT_COMPARED
from ..setting import Flag, Setting
from ..settings_table import MOST_REFERENCE_SAMPLES, RENDERER
from ..streams import readable
from .arguments import between, frames_of, resolution
from .inputs import SETTING

MAX_FRAME = 1048574
"""Blender's own limit"""
PEERS_HELP = "eevee, cycles1, cycles2, cycles4 and so on to cycles64; or none (%(default)s)"


def add_scene_options(parser: argparse.ArgumentParser, is_marked: bool = False) -> None:
    """`is_marked`: mirrors are those that the file marks where none are named."""
    add_file(parser, is_marked)
    which = parser.add_mutually_exclusive_group()
    which.add_argument(
        "--frame", type=between(-MAX_FRAME, MAX_FRAME), metavar="N", help="frame of the animation (the file's)"
    )
    which.add_argument("--frames", type=frames_of, metavar="A-B[:STEP]", help="frames, one after the other")
    parser.add_argument("--resume", action="store_true", help="leave out frames whose results are there whole")


def add_file(parser: argparse.ArgumentParser, is_marked: bool = False) -> None:
    """What is seen of which file; `is_marked` as for `add_scene_options`."""
    marked = " (those marked)" if is_marked else ""
    parser.add_argument("file", metavar="FILE.blend")
    parser.add_argument(
        "--reflector", required=not is_marked, metavar="A[,B..]", help=f"names of the mirror objects{marked}"
    )
    parser.add_argument("--camera", type=readable, metavar="C", help="name of a camera object (the scene's)")
    parser.add_argument("--resolution", type=resolution, metavar="WxH", help="in pixels (the scene's)")


def add_comparison(parser: argparse.ArgumentParser) -> None:
    """What is compared with what."""
    parser.add_argument("--method", default=",".join(DEFAULT_COMPARED), metavar="M[,M..]", help="or all (%(default)s)")
    add_settings(parser, "compare")
    add_reference_samples(parser, 256, "of the reference")
    parser.add_argument(
        "--light",
        default="full",
        metavar="L",
        help="direct: no indirect diffuse light; full: as the scene renders in Cycles (%(default)s)",
    )
    parser.add_argument("--peers", default="eevee,cycles1,cycles8", metavar="P[,P..]", help=PEERS_HELP)


def add_settings(parser: argparse.ArgumentParser, verb: str) -> None:
    """The verb's arguments that the table of settings knows. What `render` is not told is as the file has it."""
    for item in RENDERER:
        for flag in item.flags:
            if flag.verb == verb:
                _add_setting(parser, item, flag, is_of_file=verb == "render")


def _add_setting(parser: argparse.ArgumentParser, item: Setting, flag: Flag, is_of_file: bool) -> None:
    value = item.flag_value(flag)
    dest = f"{SETTING}{item.name}"
    default = argparse.SUPPRESS if is_of_file else value
    if isinstance(value, bool):
        action = "store_false" if value else "store_true"
        parser.add_argument(flag.spelling, dest=dest, action=action, default=default, help=flag.text)
        return
    parser.add_argument(
        flag.spelling,
        dest=dest,
        type=_value_of(item),
        default=default,
        metavar=flag.metavar,
        help=f"{flag.text} ({"the scene's" if is_of_file else value})",
    )


def _value_of(item: Setting) -> Callable[[str], Any]:
    """The argument type of a setting's values."""
    if isinstance(item.default, int):
        least, most = item.hard
        assert least is not None and most is not None, f"{item.name} is a whole number without a range"
        return between(int(least), int(most))

    def value(text: str) -> Any:
        if item.choices:
            item.check(text)
            return text
        try:
            item.check(float(text))
        except (ValueError, InputError) as error:
            raise argparse.ArgumentTypeError(f"'{text}' is not a number in range: choose {item.range_text}") from error
        return float(text)

    return value


def add_reference_samples(parser: argparse.ArgumentParser, default: int, text: str) -> None:
    parser.add_argument(
        "--samples",
        type=between(1, MOST_REFERENCE_SAMPLES),
        default=default,
        metavar="N",
        help=f"{text} (%(default)s)",
    )
