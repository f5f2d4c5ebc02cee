# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bake Look in a window: modal, stopped by Escape, undone; the viewport draws what was baked."""

from __future__ import annotations

from pathlib import Path

import pytest
from window import InWindow, Session

SCRIPT = Path(__file__).resolve().parent / "looks_session.py"


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory, in_window: InWindow) -> Session:
    folder = tmp_path_factory.mktemp("looks")
    return in_window(SCRIPT, folder, folder, flags=("--enable-event-simulate",))


def test_escape_leaves_nothing(session: Session) -> None:
    assert not session.seen["error"], session.seen["error"]
    assert "Traceback" not in session.printed, session.printed[-3000:]
    assert session.seen["is modal"] and session.seen["nothing after escape"]


def test_the_viewport_draws_the_look(session: Session) -> None:
    """A material and an image are new, and nothing is left to say."""
    assert session.seen["new"] == [1, 1, 0, 0, 0]
    assert any("Ambient Occlusion" in cause for cause in session.seen["remarks before"]["Material"])
    assert "Material" not in session.seen["remarks after"]
    assert session.seen["undone"]
