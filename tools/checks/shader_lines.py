# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of shaders are under 120 characters long, as ruff has it for Python."""

from __future__ import annotations

from pathlib import Path

LONGEST = 119
FOLDERS = ("gpu_shaders", "tools")


def violations(root: Path) -> list[str]:
    """A sentence for each line that is too long, with its file and number."""
    return [
        f"{path.relative_to(root)}:{number}: {len(line)} characters, at most {LONGEST} are wanted."
        for folder in FOLDERS
        for path in sorted((root / folder).rglob("*.glsl"))
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if len(line) > LONGEST
    ]
