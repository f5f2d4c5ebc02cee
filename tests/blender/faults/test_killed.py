# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""SIGKILL within the frames of a render, and resume: a few times of the twenty of `tests/nightly/kill_verbs.py`."""

from __future__ import annotations

import random
import sys
from pathlib import Path

import bpy
import pytest
from nightly.kill_verbs import ROOT, kill_and_resume, marked_scene

pytestmark = [
    pytest.mark.usefixtures("gpu"),
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="signals and /proc of Linux"),
]


@pytest.mark.skipif(bool(bpy.app.binary_path), reason="the launcher runs the wheel")
def test_a_range_survives_being_killed(tmp_path: Path) -> None:
    if not (ROOT / ".venv" / "curvrefl-installed.txt").is_file():
        pytest.skip("the launcher would set itself up first")
    seed = random.SystemRandom().randrange(1 << 31)
    print(f"Seed {seed}")
    folder = tmp_path / "runs"
    folder.mkdir()
    found = kill_and_resume("render", marked_scene(tmp_path), 12, 3, random.Random(seed), folder)
    assert (found.kills, found.wrong) == (3, []), f"seed {seed}"
