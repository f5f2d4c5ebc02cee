# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the extension with the tool that Blender ships for it, which also checks the manifest."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import bpy
from curvrefl.curvrefl_addon.written_files import NO_ROOM, error_in

ROOT = Path(__file__).resolve().parent.parent


def build(folder: Path) -> Path:
    """Validate the manifest, pack the source into `folder` (which exists), validate the pack, return its path."""
    tool = _shipped("addons_core", "bl_pkg", "cli", "blender_ext.py")
    tags = f"--valid-tags={_shipped('modules', '_bpy_internal', 'extensions', 'tags.py')}"
    _call(folder, tool, "validate", tags, str(ROOT))
    _call(folder, tool, "build", tags, "--source-dir", str(ROOT), "--output-dir", str(folder))
    (package,) = folder.glob("*.zip")
    _call(folder, tool, "validate", tags, str(package))
    return package


def _shipped(*parts: str) -> str:
    """A script that comes with Blender."""
    return str(Path(bpy.utils.system_resource("SCRIPTS"), *parts))  # type: ignore[attr-defined]  # (the stubs lack it)


def _call(folder: Path, tool: str, *arguments: str) -> None:
    """Raises OSError where there is no room in the folder it writes to."""
    command = [sys.executable, tool, *arguments]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        error = error_in(result.stdout + result.stderr, folder)
        if error.errno in NO_ROOM:
            raise error
        raise RuntimeError(f"{' '.join(command)} failed:\n{result.stdout}{result.stderr}")
