# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A range of previews in a window: Escape leaves the frames that are done, resuming does the others; a whole video."""

from __future__ import annotations

from pathlib import Path

import pytest
from small_scene import saved
from window import run_session
from window_blender import WindowBlender

SCRIPT = Path(__file__).resolve().parent / "preview_session.py"
ALL = [f"p_{frame}.png" for frame in range(1, 7)]


@pytest.mark.usefixtures("gpu")
def test_previews_in_a_window(tmp_path: Path, window_blender: WindowBlender, archive: Path) -> None:
    session = run_session(
        window_blender,
        SCRIPT,
        tmp_path,
        archive,
        saved(tmp_path),
        tmp_path,
        size=(480, 360),
        flags=("--enable-event-simulate",),
    )
    seen = session.seen
    assert not seen["error"], seen["error"] + session.printed[-3000:]
    assert seen["started"] == ["RUNNING_MODAL"] and seen["is modal"]
    stopped, frame = seen["after escape"]
    assert stopped == ALL[: len(stopped)] and 2 <= len(stopped) < 6 and frame == 4
    assert seen["asked for a file"] == ["curvrefl_preview.png", 1]
    assert seen["resumed"] == [ALL, 4]
    assert seen["canceled video"] == [[], []]
    assert seen["video"] == [["film.mp4"], 4, ["Scene"]]
    assert seen["frames"] == 6
