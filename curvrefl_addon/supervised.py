# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is told to the supervisor (tools/supervise.py) of a run that may be ended at any moment, where there is one.

It is told by files in the run's folder, which the variable CURVREFL_RUN names. What a run is writing is also kept here,
for where nobody supervises it: in Blender itself.
"""

from __future__ import annotations

import contextlib
import os
import shutil
from collections.abc import Iterator
from pathlib import Path

_RUN_FOLDER = "CURVREFL_RUN"
_LEFTOVERS = "leftovers"
"""Paths to remove, each with a zero byte behind it"""
_PUBLISHING = "publishing"
"""Is there while results are moved into place, for which the supervisor waits"""
_SOFTLY = "softly"
"""Is there where programs that are ended need a moment to clean up"""
_STAGE = "stage"
"""What Blender is about, should it die of it"""

_parts: set[Path] = set()


def is_supervised() -> bool:
    """Whether a supervisor answers signals, and removes what is left."""
    return _run_folder() is not None


@contextlib.contextmanager
def removed_at_end(part: Path) -> Iterator[Path]:
    """A file or folder, about to be made, that is not there any more at the end, however the run ends."""
    _parts.add(part)
    if (run := _run_folder()) is not None:
        with (run / _LEFTOVERS).open("ab") as file:
            file.write(os.fsencode(part) + b"\0")
    try:
        yield part
    finally:
        _remove(part)
        _parts.discard(part)


def remove_parts() -> None:
    """Remove what is being written, for a program that ends at once."""
    for part in tuple(_parts):
        _remove(part)


@contextlib.contextmanager
def publishing() -> Iterator[None]:
    """Something that takes milliseconds and whose half would be a mix of old and new: it is let come to its end."""
    with _sign(_PUBLISHING, ""):
        yield


@contextlib.contextmanager
def ended_softly() -> Iterator[None]:
    """Who ends the run meanwhile sends SIGTERM to all its programs, and gives them a moment before they are killed."""
    with _sign(_SOFTLY, ""):
        yield


@contextlib.contextmanager
def stage(doing: str) -> Iterator[None]:
    """What is said of a Blender that dies meanwhile: that it ended "while it {doing}"."""
    with _sign(_STAGE, doing):
        yield


@contextlib.contextmanager
def _sign(name: str, text: str) -> Iterator[None]:
    run = _run_folder()
    if run is None:
        yield
        return
    (run / name).write_text(text, encoding="utf-8", errors="surrogateescape")
    try:
        yield
    finally:
        (run / name).unlink(missing_ok=True)


def _run_folder() -> Path | None:
    folder = os.environ.get(_RUN_FOLDER)
    return Path(folder) if folder and os.path.isdir(folder) else None


def _remove(part: Path) -> None:
    if part.is_dir():
        shutil.rmtree(part, ignore_errors=True)
    else:
        part.unlink(missing_ok=True)
