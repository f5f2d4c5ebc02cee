# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustics in a viewport: made by and by, followed, and gone when switched off; by Vulkan, as all else is by OpenGL."""

from __future__ import annotations

from pathlib import Path

import pytest
from window import InWindow, Session

SCRIPT = Path(__file__).resolve().parent / "caustics_session.py"


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory, in_window: InWindow) -> Session:
    folder = tmp_path_factory.mktemp("caustics")
    return in_window(SCRIPT, folder, folder, backend="vulkan", size=(480, 360))


def test_they_come_to_rest(session: Session) -> None:
    assert not session.seen["error"], session.seen["error"]
    assert "Traceback" not in session.printed, session.printed[-3000:]
    for name in ("on", "moved"):
        told = session.seen[name]["Bounced Light"]
        assert "pieces of light" in told and "not settled" not in told, told
    for name in ("off", "off again"):
        assert "caustics of lamps" not in session.seen[name]["Bounced Light"]
