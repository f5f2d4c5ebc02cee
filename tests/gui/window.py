# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a script in a Blender window of its own, and gives back what it saw."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from window_blender import WindowBlender

SECONDS = 2400
"""For a whole session: only one that hangs takes so long, also on a software renderer and busy cores"""


@dataclass(frozen=True)
class Session:
    """A session that came to its end."""

    folder: Path
    seen: dict[str, Any]
    """What the script left in `seen.json`"""
    printed: str
    """By Blender and Python together"""


def run_session(
    blender: WindowBlender,
    script: Path,
    folder: Path,
    *arguments: str | Path,
    backend: str = "opengl",
    size: tuple[int, int] = (1280, 800),
    seconds: float = SECONDS,
    flags: tuple[str, ...] = (),
) -> Session:
    """Open a window with factory settings in a home of its own below `folder`; the arguments follow `--`.

    The script quits Blender when it has written `folder/seen.json`. Raises AssertionError with the end of what was
    printed where it did not.
    """
    command = [
        *blender.windowed,
        "--factory-startup",
        *flags,
        *("--gpu-backend", backend),
        *("--window-geometry", "0", "0", str(size[0]), str(size[1])),
        *("--python-exit-code", "1"),
        *("--python", str(script)),
        "--",
        *map(str, arguments),
    ]
    log = folder / "printed.txt"
    with log.open("wb") as stream, contextlib.suppress(subprocess.TimeoutExpired):
        # (what a session that hangs has printed tells where)
        subprocess.run(command, env=home(folder), stdout=stream, stderr=subprocess.STDOUT, timeout=seconds)
    printed = log.read_text(encoding="utf-8", errors="replace")
    found = folder / "seen.json"
    assert found.is_file(), printed[-3000:]
    return Session(folder, json.loads(found.read_text(encoding="utf-8")), printed)


def home(folder: Path) -> dict[str, str]:
    """Environment of a Blender that keeps its settings and extensions below `folder`."""
    place = folder / "home"
    place.mkdir(exist_ok=True)
    return {**os.environ, "HOME": str(place), "BLENDER_USER_RESOURCES": str(place)}
