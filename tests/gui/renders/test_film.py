# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A film in a window: F12 renders it in a thread of its own, it follows edits, and undo takes it away.

And a range of previews there: Escape leaves the frames that are done, resuming does the others; a video is whole.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.report.display import display_transform
from curvrefl.curvrefl_addon.report.images import load_exr
from film.film_scene import SIZE, WORLD, build
from window import run_session
from window_blender import WindowBlender

SCRIPT = Path(__file__).resolve().parent / "film_session.py"


def saved(folder: Path) -> Path:
    registration.register()
    try:
        scene: Any = build()
        settings = scene.render.image_settings
        settings.media_type, settings.file_format, settings.color_depth = "IMAGE", "OPEN_EXR", "32"
        settings.color_mode, scene.render.filepath = "RGBA", str(folder / "film.exr")
        path = folder / "film.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False)
    finally:
        registration.unregister()
    return path


@pytest.mark.usefixtures("gpu")
def test_a_film_in_a_window(tmp_path: Path, window_blender: WindowBlender, archive: Path) -> None:
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
    assert seen["set up"] == ["FINISHED"] and "Scene Mirrors" in seen["after"][0]
    assert sorted(seen["held out"]) == ["Ball", "second"]
    ended, in_main_thread = seen["renders"]
    assert ended == ["complete"] and not any(in_main_thread)
    film = load_exr(tmp_path / "film.exr")
    assert film.shape == (SIZE, SIZE, 4)
    seam = np.abs(display_transform(film[..., :3]) - display_transform(np.array(WORLD, np.float32))).max()
    assert seam < 2.0 / 255.0
    assert seen["undone"] == seen["before"]
    assert seen["started"] == ["RUNNING_MODAL"] and seen["is modal"]
    pictures = [f"p_{frame}.png" for frame in range(1, 7)]
    stopped, frame = seen["after escape"]
    assert stopped == pictures[: len(stopped)] and 2 <= len(stopped) < 6 and frame == 4
    assert seen["asked for a file"] == ["curvrefl_preview.png", 1]
    assert seen["resumed"] == [pictures, 4]
    assert seen["canceled video"] == [[], []]
    assert seen["video"][:2] == [["film.mp4"], 4] and seen["video"][2] == seen["before"][0]
    assert seen["frames"] == 6
