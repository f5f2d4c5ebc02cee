# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An artist's session imports nothing of what studies the methods."""

from __future__ import annotations

import json
from pathlib import Path

from blender_process import run_script


def test_an_artists_session_imports_no_study() -> None:
    result = run_script(Path(__file__).resolve().parents[1] / "artist_imports.py")
    (line,) = [line for line in result.stdout.splitlines() if line.startswith("IMPORTED ")]
    names = json.loads(line.removeprefix("IMPORTED "))
    assert "curvrefl.curvrefl_addon.viewport.handlers" in names
    assert "curvrefl.operators.compare_with_cycles" in names
    assert [name for name in names if name.startswith("curvrefl.curvrefl_addon.study")] == []
