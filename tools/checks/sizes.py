# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A file that is read in one sitting, a folder that is seen at a glance."""

from __future__ import annotations

from pathlib import Path

MOST_LINES = 350
MOST_FILES = 14
FOLDERS = ("curvrefl_addon", "gpu_shaders", "operators", "tests", "tools")
SOURCE = (".py", ".glsl", ".sh")


def violations(root: Path) -> list[str]:
    """A sentence for each file with too many lines and each folder with too many files (its subfolders aside)."""
    found = []
    for path in sorted(path for folder in FOLDERS for path in (root / folder).rglob("*")):
        if path.suffix in SOURCE:
            lines = len(path.read_text(encoding="utf-8").splitlines())
            if lines > MOST_LINES:
                found.append(f"{path.relative_to(root)}: {lines} lines, at most {MOST_LINES} are wanted.")
    for folder in sorted(
        path for name in FOLDERS for path in (root / name, *(root / name).rglob("*")) if path.is_dir()
    ):
        if folder.name == "__pycache__":
            continue
        files = sum(path.is_file() and not path.name.startswith(".") for path in folder.iterdir())
        if files > MOST_FILES:
            found.append(f"{folder.relative_to(root)}: {files} files, at most {MOST_FILES} are wanted.")
    return found
