# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Words are spelled as in American English, as in Blender's own interface: those of identifiers too."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

BUILT_IN = "clear,rare,en-GB_to_en-US"
MORE = "tools/checks/american.txt"
"""Words that the built-in dictionaries lack"""
WORD = "[A-Z]?[a-z]+|[A-Z]+(?![a-z])"
"""The parts of names such as base_color and BaseColor"""
FOLDERS = ("curvrefl_addon", "docs", "gpu_shaders", "operators", "tests", "tools")
SUFFIXES = (".py", ".glsl", ".md", ".toml", ".sh", ".txt")
NOT_OURS = "atleast,eto,inout,lod,nd,ons,ot,shepard,sur,wronly"
"""Words of GLSL and of systems, names, a title's French, and parts of names"""
BLENDERS = "(?<![A-Z])CANCELLED"


def violations(root: Path) -> list[str]:
    """A sentence for each misspelled word. Raises RuntimeError where codespell itself fails."""
    files = [path for path in root.iterdir() if path.suffix in SUFFIXES]
    files += [path for folder in FOLDERS for path in (root / folder).rglob("*") if path.suffix in SUFFIXES]
    names = [str(path.relative_to(root)) for path in sorted(files) if path.name != Path(MORE).name]
    command = [sys.executable, "-m", "codespell_lib", "--disable-colors", "--builtin", BUILT_IN]
    command += ["--dictionary", "-", "--dictionary", MORE, "--regex", WORD, "--ignore-regex", BLENDERS]
    command += ["--ignore-words-list", NOT_OURS, *names]
    result = subprocess.run(command, cwd=root, capture_output=True, text=True)
    lines = result.stdout.splitlines()
    if result.stderr.strip() or bool(lines) != (result.returncode != 0):
        raise RuntimeError(f"codespell ended with exit code {result.returncode}: {result.stderr.strip()}")
    return lines
