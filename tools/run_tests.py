# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the source (see checks/source.py), then runs pytest on the layers asked for."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from checks import source  # noqa: E402

TOOLS = ("pytest", "hypothesis", "flip_evaluator", "matplotlib")
CHECKED = "unit"
"""The checks need no Blender: they go with this layer"""
NO_TESTS_COLLECTED = 5
MOST_PROCESSES = 4
"""Each holds a Blender: about 1 GB"""
THREADS = ("LP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS")
"""Variables that say how many threads a software renderer and numpy may start"""


def run(layers: Sequence[str]) -> int:
    """Exit code 0 when everything asked for passes, 1 when not, 2 when this Python cannot run tests at all."""
    missing = [name for name in TOOLS if importlib.util.find_spec(name) is None]
    for name in missing:
        print(f"curvrefl: this Python ({sys.executable}) lacks {name}: what needs it is skipped.", file=sys.stderr)
    if "pytest" in missing:
        print("curvrefl: without pytest no test can run: install it into that Python.", file=sys.stderr)
        return 2
    passed = CHECKED not in layers or source.run() == 0
    folders = [ROOT / "tests" / layer for layer in layers]
    folders = [folder for folder in folders if any(folder.glob("**/test_*.py"))]
    if folders:
        passed &= _run_pytest(folders)
    elif set(layers) != {CHECKED}:
        print(f"curvrefl: there are no tests in {', '.join(layers)}.", file=sys.stderr)
    print("All checks passed." if passed else "Some checks failed.", flush=True)
    return 0 if passed else 1


def try_awkward(names: Sequence[str], keep: str | None) -> int:
    """Tries awkward scenes, all where none is named; exit code as of `run`, and 2 for a name that there is not."""
    sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "blender")]
    from awkward import judge

    return judge.judge(names, None if keep is None else Path(keep))


def _run_pytest(folders: Sequence[Path]) -> bool:
    # The windows first: they take longest, and one after the other.
    folders = sorted(folders, key=lambda folder: folder.name != "gui")
    arguments = ["-q", "-p", "no:cacheprovider", "--rootdir", str(ROOT), *map(str, folders)]
    if _is_blender_application():
        # The tests must run in this very process.
        import pytest

        code = int(pytest.main(arguments))
    else:
        shared, environment = _shared_out()
        command = [sys.executable, str(ROOT / "tools" / "run_pytest.py"), *arguments, *shared]
        code = subprocess.run(command, cwd=ROOT, env=environment).returncode
        if code not in (0, 1, NO_TESTS_COLLECTED):
            print(f"curvrefl: pytest ended with exit code {code}.", file=sys.stderr)
    return code in (0, NO_TESTS_COLLECTED)


def _shared_out() -> tuple[list[str], dict[str, str]]:
    """Options and environment for a pytest that runs files side by side, in one process for each core.

    A thread each is cheaper for them than threads that wait for one another. A process that crashes is replaced, and
    the test it ran has failed. (tests/conftest.py says what must stay together.)
    """
    processes = min(os.cpu_count() or 1, MOST_PROCESSES)
    if processes == 1 or importlib.util.find_spec("xdist") is None:
        return [], dict(os.environ)
    threads = str(max((os.cpu_count() or 1) // processes, 1))
    options = ["-n", str(processes), "--dist", "loadfile", "--no-loadscope-reorder"]
    return options, dict.fromkeys(THREADS, threads) | os.environ


def _is_blender_application() -> bool:
    if importlib.util.find_spec("bpy") is None:
        return False
    import bpy

    return bool(bpy.app.binary_path)
