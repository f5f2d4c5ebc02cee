# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""SIGKILL at every line of what publishes results: nothing lost, nothing mixed, nothing left, others left alone."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from curvrefl.curvrefl_addon import held_folders

SCRIPT = Path(__file__).resolve().parent / "killed_at_every_line.py"

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are forked")


@pytest.mark.parametrize(("start", "least"), [("new", 60), ("old", 100)])
def test_a_frame_is_published_whole_or_done_again(start: str, least: int, tmp_path: Path) -> None:
    result = subprocess.run([sys.executable, str(SCRIPT), str(tmp_path), start], capture_output=True, text=True)
    assert (result.returncode, result.stderr) == (0, "")
    *wrong, lines = result.stdout.splitlines()
    assert wrong == []
    assert int(lines) > least


@pytest.mark.parametrize(
    ("name", "age", "has_lock", "stays"),
    [
        (".curvrefl-00000000-0123456789abcdef", 3600.0, True, True),  # (another machine may work in it)
        (".curvrefl-00000000-0123456789abcdef", 2.0 * held_folders.FORGOTTEN, True, False),
        ("{here}", 0.0, True, False),
        ("{here}", 0.0, False, False),
        (".curvrefl-mine", 2.0 * held_folders.FORGOTTEN, True, True),
        ("curvrefl-0123456789abcdef", 2.0 * held_folders.FORGOTTEN, True, True),
    ],
)
def test_what_is_taken_for_left(name: str, age: float, has_lock: bool, stays: bool, tmp_path: Path) -> None:
    folder = held_folders.new_name(tmp_path) if name == "{here}" else tmp_path / name
    (folder / "files").mkdir(parents=True)
    if has_lock:
        (folder / held_folders.LOCK).touch()
    (folder / "files" / "a.png").touch()
    then = time.time() - age
    for path in (*folder.rglob("*"), folder):
        os.utime(path, (then, then))
    held_folders.remove_abandoned(tmp_path)
    assert folder.exists() is stays
