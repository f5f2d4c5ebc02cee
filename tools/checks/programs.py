# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""ruff's rules and format, and mypy's types."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

TYPE_CHECKED = ("__init__.py", "curvrefl_addon", "gpu_shaders", "operators")


def lint(root: Path) -> bool:
    """Whether the source obeys ruff, in rules and format."""
    rules = _passes("ruff check", root, "ruff", "check", "--quiet", ".")
    return _passes("ruff format", root, "ruff", "format", "--check", "--quiet", ".") and rules


def types(root: Path) -> bool:
    """Whether types fit in what ships and in the tools."""
    # mypy wants a folder that is called like the package: links to what ships.
    package = root / "build" / "mypy" / "curvrefl"
    shutil.rmtree(package, ignore_errors=True)
    package.mkdir(parents=True)
    for name in TYPE_CHECKED:
        (package / name).symlink_to(root / name)
    command = ("mypy", "--config-file", str(root / "pyproject.toml"), "--cache-dir", str(root / ".mypy_cache"))
    ships = _passes("mypy", package.parent, *command, "-p", "curvrefl")
    tools = [str(path) for path in sorted((root / "tools").rglob("*.py"))]
    # (In the stubs of bpy nearly everything may be None.)
    loose = ("--namespace-packages", "--explicit-package-bases", "--disable-error-code", "union-attr")
    folders = os.pathsep.join(
        str(folder)
        for folder in (
            package.parent,
            root / "tools",
            root / "tools" / "measure",
            root / "tests",
            root / "tests" / "blender",
            root / "tests" / "gui",
        )
    )
    return _passes("mypy of the tools", root, *command, *loose, *tools, paths=folders) and ships


def _passes(label: str, cwd: Path, *command: str, paths: str = "") -> bool:
    """Run a tool of this Python in `cwd`, `paths` for mypy to find modules on; its output comes through."""
    environment = os.environ | ({"MYPYPATH": paths} if paths else {})
    passed = subprocess.run([sys.executable, "-m", *command], cwd=cwd, env=environment).returncode == 0
    print(f"{label}: {'passed' if passed else 'FAILED'}", flush=True)
    return passed
