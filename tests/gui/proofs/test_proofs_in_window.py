# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The device is proven in a window, on both graphics interfaces, and the report is copied."""

from __future__ import annotations

from pathlib import Path

import pytest
from window import InWindow, Session

SCRIPT = Path(__file__).resolve().parent / "proofs_session.py"


@pytest.fixture(scope="module", params=["opengl", "vulkan"])
def session(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, in_window: InWindow) -> Session:
    folder = tmp_path_factory.mktemp("proofs")
    return in_window(SCRIPT, folder, folder, backend=request.param)


def test_all_ways_are_right(session: Session) -> None:
    assert not session.seen["error"], session.seen["error"]
    assert "Traceback" not in session.printed, session.printed[-3000:]
    for name in ("without all", "without atomics"):
        proven = session.seen[name]
        assert proven["failures"] == [], proven["found"]
        assert len(proven["found"]) > 10 and proven["slices"] > 25
        # Nobody has taken what was found.
        assert proven["used"] == []


def test_a_driver_without_atomics_is_told_and_reported(session: Session) -> None:
    seen = session.seen["operator"]
    assert seen["missing"] == ["atomics"]
    assert "Not in use: atomics" in seen["report"] and "WRONG" not in seen["report"]
    assert "lists by image atomics" in seen["message"]
    # With the right shaders again all is in use, as it is without anything wrong.
    assert seen["after"] == []
