# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the source that need neither Blender nor a GPU: what `./curvrefl check` runs, and `test` first."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from checks import imports, programs, shader_lines, sizes, spelling  # noqa: E402

RULES: dict[str, Callable[[Path], list[str]]] = {
    "shaders": shader_lines.violations,
    "imports": imports.violations,
    "sizes": sizes.violations,
    "spelling": spelling.violations,
}
PROGRAMS: dict[str, Callable[[Path], bool]] = {"lint": programs.lint, "types": programs.types}
NEEDS = {"lint": "ruff", "types": "mypy", "spelling": "codespell_lib"}
"""Modules that this Python may lack: then the check is left out, and said to be"""
NAMES = (*PROGRAMS, *RULES)


def run(names: Sequence[str] = NAMES, root: Path = ROOT) -> int:
    """Run these checks on the repository `root`; exit code 0 when all pass that can run, 1 when not."""
    passed = True
    for name in names:
        if name in NEEDS and importlib.util.find_spec(NEEDS[name]) is None:
            print(f"curvrefl: this Python ({sys.executable}) lacks {NEEDS[name]}: {name} is skipped.", file=sys.stderr)
        elif name in PROGRAMS:
            passed &= PROGRAMS[name](root)
        else:
            found = RULES[name](root)
            print("".join(f"{line}\n" for line in found), end="")
            print(f"{name}: {f'FAILED ({len(found)})' if found else 'passed'}", flush=True)
            passed &= not found
    return 0 if passed else 1
