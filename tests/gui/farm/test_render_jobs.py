# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Animations by the engine as render farms render them: the commands of Flamenco 3's own job type for Blender."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from window import SECONDS
from window_blender import WindowBlender

pytestmark = pytest.mark.usefixtures("gpu")

BLENDER_ARGS = ("-b", "-y")
"""Flamenco's variable of that name, as its Manager sets it up"""

type Start = Callable[[Path, Path, str], subprocess.Popen[str]]


@pytest.fixture
def start(window_blender: WindowBlender, installed: dict[str, str]) -> Start:
    """Starts the command `blender-render` of a task: a file, where to, and frames A..B."""

    def run(file: Path, output: Path, frames: str) -> subprocess.Popen[str]:
        args = ("--render-output", str(output), "--render-format", "PNG", "--render-frame", frames)
        return subprocess.Popen(
            [*window_blender.headless, *BLENDER_ARGS, str(file), *args],
            env=installed,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )

    return run


def ended(process: subprocess.Popen[str]) -> str:
    printed, _ = process.communicate(timeout=SECONDS)
    assert process.returncode == 0, printed[-3000:]
    return printed


def animated(folder: Path, name: str, is_kept: bool) -> Path:
    """The small scene with a ball that goes up, by the engine; `is_kept`: Overwrite is off, Placeholders on."""
    import bpy
    from curvrefl.curvrefl_addon import registration
    from rendered import mark
    from small_scene import build_scene

    registration.register()
    try:
        ball = build_scene()
        for frame in (1, 3):
            ball.location.z = 0.1 * frame
            ball.keyframe_insert("location", frame=frame)
        scene = bpy.context.scene
        mark(scene, ball.name)
        # What Blender writes into pictures of where, when and how fast they came about
        for stamp in ("date", "time", "render_time", "frame", "memory", "hostname", "filename"):
            setattr(scene.render, f"use_stamp_{stamp}", False)
        scene.render.use_overwrite, scene.render.use_placeholder = not is_kept, is_kept
        file = folder / f"{name}.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(file), check_existing=False)
    finally:
        registration.unregister()
    return file


def test_chunks_of_two_workers_are_the_frames_of_one(start: Start, tmp_path: Path) -> None:
    folder = tmp_path / "of shot 1"
    folder.mkdir()
    file, kept = animated(folder, "a ball", False), animated(folder, "kept", True)
    # Its second frame is there already, as another worker's placeholder.
    (folder / "kept").mkdir()
    (folder / "kept" / "000002.png").touch()
    runs = [start(file, folder / "farm" / "######", frames) for frames in ("1..2", "3")]
    printed = [ended(run) for run in runs]
    one = start(file, folder / "one" / "######", "1..3")
    ended(start(kept, folder / "kept" / "######", "2..3"))
    ended(one)
    # (By such lines Flamenco knows what a task has rendered.)
    assert [text.count("Saved: ") for text in printed] == [2, 1]
    frames = {}
    for name in ("farm", "one"):
        paths = sorted((folder / name).iterdir())
        assert [path.name for path in paths] == [f"00000{frame}.png" for frame in range(1, 4)]
        frames[name] = [path.read_bytes() for path in paths]
    assert frames["farm"] == frames["one"]
    assert len(set(frames["one"])) == 3, "the ball goes up"
    assert (folder / "kept" / "000002.png").read_bytes() == b""
    assert (folder / "kept" / "000003.png").read_bytes() == frames["one"][2]
