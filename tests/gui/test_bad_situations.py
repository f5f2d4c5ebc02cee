# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever happens to the scene or the GPU: Blender lives, the user is told once, and drawing can go on."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from window import SITUATION_SECONDS, Session, play_situations, run_session
from window_blender import WindowBlender

SCRIPT = Path(__file__).resolve().parent / "bad_situations_session.py"
WINDOW = (480, 360)


@dataclass(frozen=True)
class Expected:
    draws: bool | None
    """Whether there still is something to draw; None where the counts start anew"""
    says: str = ""
    """Found in the one message; nothing is said where this is empty"""
    stays_on: bool = True


GOES_ON = Expected(draws=True)
EXPECTED = {
    "scenery_deleted": Expected(True, "nothing to reflect"),
    "mirror_deleted": Expected(False),
    "scenery_emptied": Expected(True, "nothing to reflect"),
    "mirror_emptied": Expected(False, '"Mirror Ball" has no faces'),
    "scenery_in_edit_mode": GOES_ON,
    "mirror_in_edit_mode": GOES_ON,
    "scenery_in_sculpt_mode": GOES_ON,
    "mirror_in_sculpt_mode": GOES_ON,
    "scenery_linked": GOES_ON,
    "mirror_linked": GOES_ON,
    "mirror_open": Expected(False, '"Mirror Ball" is open'),
    "mirror_open_under_rays": GOES_ON,
    "mirror_not_manifold": GOES_ON,
    "scenery_open_and_not_manifold": GOES_ON,
    "scenery_scaled_negative": GOES_ON,
    "mirror_scaled_negative": GOES_ON,
    "mirror_scaled_to_nothing": Expected(False, '"Mirror Ball" is flattened'),
    "scenery_with_nan": Expected(True, 'triangles of "Block"'),
    "mirror_with_nan": Expected(False, '"Mirror Ball" has vertices at no finite place'),
    "playback": GOES_ON,
    "render_while_drawing": GOES_ON,
    "animation_rendered_while_drawing": GOES_ON,
    "disabled_while_drawing": Expected(None, stays_on=False),
    "shader_compile_failure": Expected(False, "[Ss]hader", stays_on=False),
    "no_compute_support": Expected(False, "[Cc]ompute", stays_on=False),
    "gpu_memory_exhausted": Expected(False, "memory", stays_on=False),
    "undo_and_redo": GOES_ON,
    "new_file": Expected(False),
    "file_loaded_while_drawing": GOES_ON,
    "file_of_a_newer_version": Expected(True, "newer"),
}
MAY_SAY_SO = {"mirror_deleted", "new_file"}
"""That there is no mirror may be said"""


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory, window_blender: WindowBlender, archive: Path) -> Session:
    from small_scene import saved

    file = saved(tmp_path_factory.mktemp("bad_situations"))

    def play(names: Sequence[str]) -> Session:
        folder = tmp_path_factory.mktemp("bad_situations")
        only = ("--only", ",".join(names))
        return run_session(
            window_blender, SCRIPT, folder, archive, file, folder, *only, size=WINDOW, seconds=SITUATION_SECONDS
        )

    return play_situations(list(EXPECTED), play)


def situation(session: Session, name: str) -> dict[str, Any]:
    found = session.seen["situations"][name]
    assert "error" not in found, found["error"]
    return found


def printed(session: Session, name: str) -> str:
    """From the opening of the file to the next situation's."""
    start = session.printed.index(f"== opened {name}\n")
    return session.printed[start:].split("\n== opened ", 2)[0]


def test_blender_lives_to_the_end(session: Session) -> None:
    errors = {name: found["error"] for name, found in session.seen["situations"].items() if "error" in found}
    assert errors == {}
    assert session.seen["finished"]
    assert set(session.seen["all"]) == set(session.seen["situations"]) == set(EXPECTED)


@pytest.mark.parametrize("name", EXPECTED)
def test_user_is_told_once(session: Session, name: str) -> None:
    found = situation(session, name)
    assert found["at start"]["messages"] == []
    expected = EXPECTED[name]
    messages = found["caused"]["messages"]
    if expected.says:
        assert len(messages) == 1
        assert re.search(expected.says, messages[0])
        assert messages[0].endswith(".")
    elif name not in MAY_SAY_SO:
        assert messages == []
    # The traceback of a failure is for the console, and comes once, not with every redraw.
    assert printed(session, name).count("Traceback") <= (0 if expected.stays_on else 1)


@pytest.mark.parametrize("name", EXPECTED)
def test_what_can_be_drawn_is_drawn(session: Session, name: str) -> None:
    found = situation(session, name)["caused"]
    assert EXPECTED[name].draws in (None, found["drawn"] > 0)
    assert found["enabled"] == EXPECTED[name].stays_on


@pytest.mark.parametrize("name", EXPECTED)
def test_it_draws_again_when_the_cause_is_gone(session: Session, name: str) -> None:
    found = situation(session, name)["repaired"]
    assert found["enabled"]
    assert found["drawn"] >= 2
    if name != "scenery_deleted":
        assert found["messages"] == []


def test_disabling_leaves_nothing(session: Session) -> None:
    assert session.seen["handlers after disable"] == []
    assert not session.seen["switch after disable"]
    assert not session.seen["switch when enabled again"], "it would say that it draws"


def test_undo_brings_the_object_back(session: Session) -> None:
    assert session.seen["block after undo"]
