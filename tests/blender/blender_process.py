# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a script in a Blender of its own, of the same kind as the one that runs the tests."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import bpy


def run_script(script: Path, *arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run `script` with `arguments` as the end of sys.argv and `variables` in its environment."""
    command = script_command(script, *arguments)
    return subprocess.run(command, env=os.environ | variables, capture_output=True, text=True, timeout=300)


def script_command(script: Path, *arguments: str) -> list[str]:
    """The command that runs `script` in such a Blender, with `arguments` as the end of sys.argv."""
    if bpy.app.binary_path:
        command = [bpy.app.binary_path, "--background", "--factory-startup", "--python-exit-code", "1"]
        return [*command, "--python", str(script), "--", *arguments]
    return [sys.executable, str(script), *arguments]
