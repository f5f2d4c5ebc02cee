# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""SIGKILL within the frames of a render, and resume: a few times of the twenty of `tests/nightly/kill_verbs.py`.

And a signal that ends it: what is done stays.
"""

from __future__ import annotations

import random
import signal
import sys
from pathlib import Path

import bpy
import pytest
from curvrefl.curvrefl_addon.written_files import is_whole
from nightly.kill_verbs import ROOT, arguments, kill_and_resume, marked_scene, started

pytestmark = [
    pytest.mark.usefixtures("gpu"),
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="signals and /proc of Linux"),
    pytest.mark.skipif(bool(bpy.app.binary_path), reason="the launcher runs the wheel"),
    pytest.mark.skipif(not (ROOT / ".venv" / "curvrefl-installed.txt").is_file(), reason="it would be set up first"),
]


def test_a_range_survives_being_killed(tmp_path: Path) -> None:
    seed = random.SystemRandom().randrange(1 << 31)
    print(f"Seed {seed}")
    folder = tmp_path / "runs"
    folder.mkdir()
    found = kill_and_resume("render", marked_scene(tmp_path), 8, 2, random.Random(seed), folder)
    assert (found.kills, found.wrong) == (2, []), f"seed {seed}"


def test_a_signal_leaves_the_frames_that_are_done(tmp_path: Path) -> None:
    temporary, out = tmp_path / "tmp", tmp_path / "out"
    temporary.mkdir()
    with started(arguments("render", marked_scene(tmp_path), 500, out), temporary) as process:
        assert process.stdout is not None
        assert any(line.startswith("Frame 3 ") for line in process.stdout)
        process.send_signal(signal.SIGTERM)
        assert process.wait(60.0) == 128 + signal.SIGTERM
    names = {path.name for path in out.iterdir()}
    done = [frame for frame in range(1, 501) if {f"f_{frame:04d}.png", f"f_{frame:04d}_position.exr"} <= names]
    assert len(done) >= 2 and len(names) == 2 * len(done) and all(map(is_whole, out.iterdir()))
    assert not list(temporary.iterdir())
