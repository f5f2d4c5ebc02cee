# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tool in the toolbar: a drag over a mirror, as hands do it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from window import InWindow, Session

SCRIPT = Path(__file__).resolve().parent / "lights_session.py"


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory, in_window: InWindow) -> Session:
    folder = tmp_path_factory.mktemp("lights")
    found = in_window(SCRIPT, folder, folder, flags=("--enable-event-simulate",))
    assert not found.seen["error"], found.seen["error"]
    assert "Traceback" not in found.printed, found.printed[-3000:]
    return found


def test_the_lamp_is_seen_under_the_cursor(session: Session) -> None:
    assert session.seen["tool"] == "curvrefl.lights" and session.seen["is modal"]
    assert session.seen["missed by"] < 0.5
    assert session.seen["missed by, farther"] < 0.5


def test_the_wheel_changes_distance_size_and_power(session: Session) -> None:
    before, dragged, after = session.seen["moved"]
    assert dragged[:3] != before[:3] and dragged[3:] == before[3:]
    assert after[:3] != dragged[:3]
    assert after[3] == pytest.approx(before[3] / 1.1) and after[4] == pytest.approx(before[4] * 1.1)


def test_one_step_of_undo_and_escape_bring_it_back(session: Session) -> None:
    assert session.seen["undone"]
    assert session.seen["is away before escape"] and session.seen["back after escape"]


def test_lights_are_shown_in_the_mirror_and_picked_there(session: Session) -> None:
    shown = dict(session.seen["lights shown"])
    assert np.linalg.norm(np.array(shown["Light"]) - session.seen["middle"], axis=1).min() < 0.5
    assert session.seen["picked"] == ["Light", True]
    assert session.seen["missed by, taken along"] < 0.5
