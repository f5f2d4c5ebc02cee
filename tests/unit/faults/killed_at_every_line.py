# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Publishes a frame of several files again and again, each time killed one line later, and resumes.

Arguments: a folder to work in, and "old" where the frame of an older run is there already. Prints how many lines there
were to be killed at, and a line for each time that something was wrong.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tools"))

import bootstrap

bootstrap.load_package()

from curvrefl.curvrefl_addon import held_folders, output, supervised, written_files  # noqa: E402

NAMES = ("f_0001.txt", "f_0001_object.txt", "f_0001_position.txt")
WATCHED = {module.__file__ for module in (held_folders, output, supervised, written_files, shutil)}
OLD, KILLED, RESUMED = "old", "killed", "resumed"


def frame(folder: Path, text: str) -> None:
    output.clean_up(folder)
    with output.folder_to_publish(folder) as part:
        for name in NAMES:
            (part / name).write_text(text)


def resume(folder: Path) -> None:
    output.clean_up(folder)
    if not is_done(folder):
        frame(folder, RESUMED)


def is_done(folder: Path) -> bool:
    return all(written_files.is_whole(folder / name) for name in NAMES)


def killed_at(line: int, work: Callable[[], None]) -> bool:
    """Have another process do the work and be killed at that line of ours; False where it has come to its end."""
    process = os.fork()
    if not process:
        count = 0

        def trace(_frame: FrameType, event: str, _argument: Any) -> Any:
            nonlocal count
            if _frame.f_code.co_filename not in WATCHED:
                return None
            if event == "line":
                count += 1
                if count == line:
                    os.kill(os.getpid(), signal.SIGKILL)
            return trace

        try:
            sys.settrace(trace)
            work()
            sys.settrace(None)
            os._exit(0)
        finally:
            os._exit(1)
    _process, status = os.waitpid(process, 0)
    if os.WIFSIGNALED(status):
        return True
    assert os.WEXITSTATUS(status) == 0, "the work failed by itself"
    return False


def problems(folder: Path, seen: set[str]) -> str:
    """What is wrong with a folder in which a frame may be and other things must be."""
    here = {path.name for path in folder.iterdir()} if folder.is_dir() else set()
    if visible := {name for name in here if not name.startswith(".curvrefl-")} - {*NAMES}:
        return f"{visible} can be seen"
    if is_done(folder):
        texts = {(folder / name).read_text() for name in NAMES}
        if len(texts) != 1 or not texts <= seen:
            return f"a frame that is done is of {texts}"
    return ""


def main(base: Path, has_old: bool) -> None:
    os.fsync = lambda _number: None  # (the power does not fail here)
    folder = base / "out"
    line = 0
    while True:
        line += 1
        shutil.rmtree(folder, ignore_errors=True)
        if has_old:
            frame(folder, OLD)
        output._cleaned.clear()
        # (What else is in those is nothing to be killed at.)
        output._cleaned.update(base.parents)
        # Of a run that goes on meanwhile, as of another worker:
        alive, held = held_folders.hold_new_folder(base)
        (alive / "files").mkdir()
        (alive / "files" / "f_0002.txt").write_text("half")
        if not killed_at(line, lambda: frame(folder, KILLED)):
            break
        if wrong := problems(folder, {OLD, KILLED}):
            print(f"killed at line {line}: {wrong}")
        killed_at(0, lambda: resume(folder))
        if wrong := problems(folder, {OLD, KILLED, RESUMED}) or ("" if is_done(folder) else "it is not done"):
            print(f"resumed after line {line}: {wrong}")
        left = {path.name for path in (*base.iterdir(), *folder.iterdir())} - {"out", *NAMES}
        if left != {alive.name} or (alive / "files" / "f_0002.txt").read_text() != "half":
            print(f"resumed after line {line}: {left} are left, and not {alive.name} alone")
        held_folders.let_go(held)
        held_folders.remove_abandoned(base)
        if alive.exists():
            print(f"resumed after line {line}: {alive.name} is held no more and stays")
    print(line - 1)


main(Path(sys.argv[1]), sys.argv[2] == OLD)
