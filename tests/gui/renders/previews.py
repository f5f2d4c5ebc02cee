# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Part of a script inside a Blender window: previews that Escape stops, that are resumed, and that become a video."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
from scripted import Script, in_view

NAME = "CURVREFL_OT_save_preview"


def is_modal() -> bool:
    return any(operator.bl_idname == NAME for operator in bpy.context.window_manager.windows[0].modal_operators)


def escape() -> Script:
    for value in ("PRESS", "RELEASE"):
        bpy.context.window_manager.windows[0].event_simulate(type="ESC", value=value, x=200, y=200)
        yield 0.2


def saved(folder: Path, ending: str) -> list[str]:
    return sorted(path.name for path in folder.iterdir() if path.suffix == ending)


def start(path: Path) -> list[str]:
    with in_view():
        return list(bpy.ops.curvrefl.save_preview("INVOKE_DEFAULT", filepath=str(path), animation=True, samples=1))


def browser() -> Any:
    areas = bpy.context.window_manager.windows[0].screen.areas
    return next((area for area in areas if area.type == "FILE_BROWSER"), None)


def previews(folder: Path, seen: dict[str, Any]) -> Script:
    """All of it, of the open file, which has a mirror; what was seen goes into `seen`."""
    bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
    scene = bpy.context.scene
    scene.frame_end = 6
    scene.frame_set(4)
    seen["started"] = start(folder / "p_#.png")
    seen["is modal"] = is_modal()
    yield lambda: len(saved(folder, ".png")) >= 2
    yield from escape()
    yield lambda: not is_modal()
    seen["after escape"] = [saved(folder, ".png"), scene.frame_current]
    # By the file browser, as a user does.
    with in_view():
        bpy.ops.curvrefl.save_preview("INVOKE_DEFAULT", animation=True, samples=1, resume=True)
    yield lambda: browser() is not None
    yield 0.5
    space = browser().spaces[0]
    seen["asked for a file"] = [space.params.filename, space.active_operator.frame_start]
    space.params.filename = "p_#.png"
    space.params.directory = str(folder).encode()
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=browser()):
        bpy.ops.file.execute()
    yield lambda: browser() is None
    yield 0.5
    yield lambda: not is_modal()
    yield 0.2
    seen["resumed"] = [saved(folder, ".png"), scene.frame_current]
    start(folder / "film.mp4")
    yield 1.0
    yield from escape()
    yield lambda: not is_modal()
    seen["canceled video"] = [saved(folder, ".mp4"), [path.name for path in folder.glob(".curvrefl-*")]]
    start(folder / "film.mp4")
    yield lambda: not is_modal()
    yield 0.2
    seen["video"] = [saved(folder, ".mp4"), scene.frame_current, [scene.name for scene in bpy.data.scenes]]
    seen["frames"] = bpy.data.movieclips.load(str(folder / "film.mp4")).frame_duration
