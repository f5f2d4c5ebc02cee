# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: a range of previews that Escape stops, that is resumed, and that becomes a video.

Arguments after `--`: the zip, a .blend file with a Mirror Ball, the folder for what was seen and saved.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from scripted import Script, arguments, in_view, install, play

ARCHIVE, BLEND, FOLDER = arguments()[:3]
NAME = "CURVREFL_OT_save_preview"
seen: dict[str, Any] = {}


def is_modal() -> bool:
    return any(operator.bl_idname == NAME for operator in bpy.context.window_manager.windows[0].modal_operators)


def escape() -> Script:
    for value in ("PRESS", "RELEASE"):
        bpy.context.window_manager.windows[0].event_simulate(type="ESC", value=value, x=200, y=200)
        yield 0.2


def saved(*ending: str) -> list[str]:
    return sorted(path.name for path in Path(FOLDER).iterdir() if path.suffix in ending)


def start(name: str, **more: Any) -> None:
    with in_view():
        path = str(Path(FOLDER) / name)
        seen["started"] = list(
            bpy.ops.curvrefl.save_preview("INVOKE_DEFAULT", filepath=path, animation=True, samples=1, **more)
        )


def browser() -> Any:
    areas = bpy.context.window_manager.windows[0].screen.areas
    return next((area for area in areas if area.type == "FILE_BROWSER"), None)


def played() -> Script:
    bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
    bpy.ops.wm.open_mainfile(filepath=BLEND, load_ui=False)
    yield 0.2
    scene = bpy.context.scene
    bpy.data.objects["Mirror Ball"].curvrefl.is_mirror = True
    scene.frame_end = 6
    scene.frame_set(4)
    start("p_#.png")
    seen["is modal"] = is_modal()
    yield lambda: len(saved(".png")) >= 2
    yield from escape()
    yield lambda: not is_modal()
    seen["after escape"] = [saved(".png"), scene.frame_current]
    # By the file browser, as a user does.
    with in_view():
        bpy.ops.curvrefl.save_preview("INVOKE_DEFAULT", animation=True, samples=1, resume=True)
    yield lambda: browser() is not None
    yield 0.5
    space = browser().spaces[0]
    seen["asked for a file"] = [space.params.filename, space.active_operator.frame_start]
    space.params.filename = "p_#.png"
    space.params.directory = FOLDER.encode()
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=browser()):
        bpy.ops.file.execute()
    yield lambda: browser() is None
    yield 0.5
    yield lambda: not is_modal()
    yield 0.2
    seen["resumed"] = [saved(".png"), scene.frame_current]
    start("film.mp4")
    yield 1.0
    yield from escape()
    yield lambda: not is_modal()
    seen["canceled video"] = [saved(".mp4"), [path.name for path in Path(FOLDER).glob(".curvrefl-*")]]
    start("film.mp4")
    yield lambda: not is_modal()
    yield 0.2
    seen["video"] = [saved(".mp4"), scene.frame_current, [scene.name for scene in bpy.data.scenes]]
    seen["frames"] = bpy.data.movieclips.load(str(Path(FOLDER) / "film.mp4")).frame_duration


def end(error: str) -> None:
    seen["error"] = error
    Path(FOLDER, "seen.json").write_text(json.dumps(seen, indent=1), encoding="utf-8")
    bpy.ops.wm.quit_blender()


install(ARCHIVE)
play(played(), end)
