# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender that opens windows, or a skip with the reason; and the extension's zip."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))

from window import SECONDS, InWindow, Session, home, run_session
from window_blender import NoWindowBlenderError, WindowBlender, find_or_make


@pytest.fixture(scope="session")
def window_blender() -> WindowBlender:
    """Found or made on the first use (a Debian root takes some minutes, once)."""
    try:
        return find_or_make()
    except NoWindowBlenderError as error:
        pytest.skip(f"no Blender window: {error}")


@pytest.fixture(scope="session")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The extension, packed from this source."""
    pytest.importorskip("bpy", reason="packing the extension needs a Python with Blender")
    import build_extension

    return build_extension.build(tmp_path_factory.mktemp("zip"))


@pytest.fixture(scope="session")
def installed(tmp_path_factory: pytest.TempPathFactory, window_blender: WindowBlender, archive: Path) -> dict[str, str]:
    """Environment of Blenders without a window that have the extension, installed by Blender's own command."""
    environment = home(tmp_path_factory.mktemp("installed"))
    install = ("extension", "install-file", "-r", "user_default", "--enable", str(archive))
    command = [*window_blender.headless, "--command", *install]
    result = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=SECONDS)
    assert result.returncode == 0, result.stdout + result.stderr
    return environment


@pytest.fixture(scope="session")
def in_window(window_blender: WindowBlender, archive: Path) -> InWindow:
    """Runs a script of a session, which gets the zip before the other arguments."""

    def run(script: Path, folder: Path, *arguments: str | Path, **chosen: Any) -> Session:
        return run_session(window_blender, script, folder, archive, *arguments, **chosen)

    return run
