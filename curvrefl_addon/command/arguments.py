# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Types of arguments on the command line: each makes a value of a text, or says in a sentence's part why not."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable

from ..settings_table import LARGEST_SIDE


def between(least: int, most: int) -> Callable[[str], int]:
    """An argument type: a whole number in this range."""

    def number(text: str) -> int:
        # (a dozen digits are out of any range)
        if not re.fullmatch(r"[+-]?\d{1,12}", text) or not least <= int(text) <= most:
            raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from {least} to {most}")
        return int(text)

    return number


def positive(text: str) -> float:
    """A number above zero."""
    if not re.fullmatch(r"\d{1,9}(\.\d{1,9})?", text) or float(text) == 0.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number above 0")
    return float(text)


def resolution(text: str) -> tuple[int, int]:
    """Width and height in pixels."""
    match = re.fullmatch(r"(\d{1,9})[xX](\d{1,9})", text)
    if not match:
        raise argparse.ArgumentTypeError(f"'{text}' is not a resolution like 640x480")
    width, height = int(match[1]), int(match[2])
    if not (1 <= width <= LARGEST_SIDE and 1 <= height <= LARGEST_SIDE):
        raise argparse.ArgumentTypeError(f"{width}x{height} is out of range: 1 to {LARGEST_SIDE} pixels a side")
    return width, height


def frames_of(text: str) -> range:
    """An argument type: A, A-B or A-B:STEP, both ends counted in; or several of these with commas between them, which
    farms make of chunks: frames as far apart as the first two."""
    if "," not in text:
        return _frames_of(text, text)
    frames = sorted({frame for part in text.split(",") for frame in _frames_of(part, text)})
    step = frames[1] - frames[0] if len(frames) > 1 else 1
    found = range(frames[0], frames[-1] + 1, step)
    if frames != list(found):
        raise argparse.ArgumentTypeError(f"'{text}' are no frames as far apart as the first two")
    return found


def _frames_of(part: str, text: str) -> range:
    match = re.fullmatch(r"(-?\d{1,7})(?:-(-?\d{1,7})(?::(\d{1,7}))?)?", part.strip())
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' are no frames like 1-24 or 1-24:2")
    first, last, step = int(match[1]), int(match[2] or match[1]), int(match[3] or 1)
    if last < first or step < 1:
        raise argparse.ArgumentTypeError(f"'{text}' has no frames: the last comes after the first")
    return range(first, last + 1, step)


def numbers(count: int) -> Callable[[str], tuple[float, ...]]:
    """An argument type: so many numbers with commas between them."""

    def read(text: str) -> tuple[float, ...]:
        parts = text.split(",")
        if len(parts) != count or not all(re.fullmatch(r"[+-]?\d{1,9}(\.\d{1,9})?", part) for part in parts):
            raise argparse.ArgumentTypeError(f"'{text}' is not {count} numbers like {','.join(['0.25'] * count)}")
        return tuple(map(float, parts))

    return read
