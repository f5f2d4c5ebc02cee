# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Minutes of work in a window, or an hour (tools/nightly.py): nothing grows, nothing is left, nothing fails."""

from __future__ import annotations

import os
import shutil
import statistics
from pathlib import Path
from typing import Any

import pytest
from window import InWindow, Session

SCRIPT = Path(__file__).resolve().parent / "long_session.py"
SECONDS = float(os.environ.get("CURVREFL_LONG_SECONDS", "600"))
"""Of each backend that is asked for"""
BACKENDS = os.environ.get("CURVREFL_LONG_BACKENDS", "opengl").split(",")
"""Not `vulkan`: on Mesa's software driver Blender 5.2.2 dies in this session within a minute, whether or not Curvrefl
draws"""
WINDOW = (480, 360)
WARM = 2
"""Rounds in which caches of Blender and the driver fill"""
GROWTH = 0.04
"""Of the memory in use: how much noise the halves of a session may differ by"""


@pytest.fixture(scope="module", params=BACKENDS)
def session(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, in_window: InWindow) -> Session:
    from small_scene import saved

    folder = tmp_path_factory.mktemp(f"long-{request.param}")
    blend = saved(folder)
    other = blend.with_name("other.blend")
    shutil.copyfile(blend, other)
    return in_window(SCRIPT, folder, blend, other, folder, str(SECONDS), backend=request.param, size=WINDOW)


def rounds_of(session: Session) -> list[dict[str, Any]]:
    return list(session.seen["rounds"])


def test_it_goes_on_to_its_end(session: Session) -> None:
    assert "error" not in session.seen, session.seen["error"]
    assert session.seen.get("finished"), session.printed[-3000:]
    assert "Traceback" not in session.printed, session.printed[-3000:]
    assert len(rounds_of(session)) > WARM
    for each in rounds_of(session):
        assert each["drawn"] > 0
        assert each["messages"] == rounds_of(session)[0]["messages"]


def test_nothing_more_is_alive_after_later_rounds(session: Session) -> None:
    first, *later = [each["alive"] for each in rounds_of(session)[WARM - 1 :]]
    for each in later:
        grown = {kind: (first.get(kind, 0), count) for kind, count in each.items() if count > first.get(kind, 0)}
        assert not grown


def test_memory_stays(session: Session) -> None:
    """The second half of the rounds takes what the first took (a leak of a round's textures would be far more)."""
    memory = [each["memory"] for each in rounds_of(session)[WARM:]]
    if len(memory) < 4:
        pytest.skip(f"only {len(memory)} rounds on this machine: too few to tell")
    half = len(memory) // 2
    early, late = statistics.median(memory[:half]), statistics.median(memory[half:])
    assert late <= early * (1.0 + GROWTH), memory
