# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A setting that is added to the table, in a copy of the repository, is everywhere where a setting can be."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from blender_process import run_script

ROOT = Path(__file__).resolve().parents[3]
COPIED = ("__init__.py", "curvrefl_addon", "gpu_shaders", "operators", "tools")
ENTRY = """    glow: float = setting(
        1.5,
        first=2.0,
        label="Glow",
        text="How much mirrors glow",
        hard=(0.25, 8.0),
        soft=(0.5, 4.0),
        panel="Quality",
        preference=True,
        flags=(Flag("render", "--glow", "of mirrors"),),
    )
"""
BEFORE = "    bounces: int = setting("
FLAG_REFUSED = "Argument --glow: '{}' is not a number in range: choose 0.25 to 8: see curvrefl render --help."


def test_a_setting_is_added_in_one_place(tmp_path: Path) -> None:
    root = tmp_path / "copy"
    root.mkdir()
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, root / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(ROOT / name, root)
    table = root / "curvrefl_addon" / "settings_table.py"
    text = table.read_text(encoding="utf-8")
    assert text.count(BEFORE) == 1
    table.write_text(text.replace(BEFORE, ENTRY + BEFORE), encoding="utf-8")

    result = run_script(ROOT / "tests" / "blender" / "new_setting.py", str(root))
    lines = [line for line in result.stdout.splitlines() if line.startswith("SEEN ")]
    assert len(lines) == 1, result.stdout + result.stderr
    assert json.loads(lines[0].removeprefix("SEEN ")) == {
        "copy": True,
        "settings": 1.5,
        "refused": "A value of 8.5 for Glow is out of range: choose 0.25 to 8.",
        "taken": "",
        "scene": ["Glow", "How much mirrors glow", 2.0, 0.25, 8.0, 0.5, 4.0],
        "preferences": ["Glow", "In new scenes: how much mirrors glow", 2.0, 0.25, 8.0, 0.5, 4.0],
        "new scenes": 2.0,
        "rendered": [2.0, 3.0],
        "panel": True,
        "command line": [1.5, 4.5, FLAG_REFUSED.format("9"), FLAG_REFUSED.format("much")],
        "page": True,
    }
