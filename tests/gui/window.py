# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a script in a Blender window of its own, and gives back what it saw."""

from __future__ import annotations

import json
import os
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from window_blender import WindowBlender

SECONDS = 2400
"""For a whole session: only one that hangs takes so long, also on a software renderer and busy cores"""
SITUATION_SECONDS = 700
"""For one of a session's situations; the script itself gives up on a condition some time before"""


@dataclass(frozen=True)
class Session:
    """What a session left; whether it came to its end is for the script to say."""

    folder: Path
    seen: dict[str, Any]
    """What the script left in `seen.json`"""
    printed: str
    """By Blender and Python together"""


type InWindow = Callable[..., Session]
"""`run_session` of the Blender and the extension's zip that tests have: `in_window(script, folder, *more, ..)`"""


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

    The script quits Blender when it has written `folder/seen.json`; it may write that file often before, and is
    stopped after so many seconds without another. Raises AssertionError with the end of what was printed where there
    is none.
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
    log, found = folder / "printed.txt", folder / "seen.json"
    with log.open("wb") as stream:
        process = subprocess.Popen(command, env=home(folder), stdout=stream, stderr=subprocess.STDOUT)
        try:
            _wait(process, found, seconds)
        finally:
            process.kill()
            process.wait()
    printed = log.read_text(encoding="utf-8", errors="replace")
    assert found.is_file(), printed[-3000:]
    return Session(folder, json.loads(found.read_text(encoding="utf-8")), printed)


def run_interface_session(blender: WindowBlender, folder: Path, archive: Path) -> Session:
    """The panels over the demo, clicks and a comparison, in `folder`; `archive`: the extension, packed."""
    from curvrefl.curvrefl_addon.demo.scene import build_demo
    from small_scene import saved

    script, demo = Path(__file__).resolve().parent / "interface_session.py", folder / "demo.blend"
    build_demo(demo)
    small = saved(folder, lambda ball: ball.data.uv_layers.remove(ball.data.uv_layers[0]))
    return run_session(blender, script, folder, archive, demo, small, folder, flags=("--enable-event-simulate",))


def _wait(process: subprocess.Popen[bytes], found: Path, seconds: float) -> None:
    """Until the process ends, or `found` has not changed for so many seconds."""
    written, changed = 0, time.monotonic()
    while time.monotonic() - changed < seconds:
        try:
            process.wait(timeout=1.0)
            return
        except subprocess.TimeoutExpired:
            latest = found.stat().st_mtime_ns if found.is_file() else 0
            if latest != written:
                written, changed = latest, time.monotonic()


def play_situations(names: Sequence[str], play: Callable[[Sequence[str]], Session]) -> Session:
    """All situations, also where one takes Blender with it: what comes after it is played in another window.

    `play` runs those it is given in one session, whose script notes each in `seen["situations"]` before it plays it.
    One that Blender did not survive has an "error". Raises AssertionError where a session played none.
    """
    seen: dict[str, Any] = {"situations": {}}
    printed = ""
    left = list(names)
    while left:
        session = play(left)
        situations = session.seen["situations"]
        assert situations, session.printed[-3000:]
        if not session.seen.get("finished"):
            last = list(situations)[-1]
            reason = session.seen.get("error") or f"Blender crashed or hung:\n{session.printed[-3000:]}"
            situations[last].setdefault("error", reason)
        seen = {**seen, **session.seen, "situations": {**seen["situations"], **situations}}
        printed += session.printed
        left = [name for name in left if name not in situations]
    return Session(session.folder, seen, printed)


def home(folder: Path) -> dict[str, str]:
    """Environment of a Blender that keeps its settings and extensions below `folder`."""
    place = folder / "home"
    place.mkdir(exist_ok=True)
    # (Blender as a module puts its own color configuration there.)
    inherited = {name: value for name, value in os.environ.items() if name != "OCIO"}
    return {**inherited, "HOME": str(place), "BLENDER_USER_RESOURCES": str(place)}
