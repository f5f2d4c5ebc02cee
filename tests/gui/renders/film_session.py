# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: a film is set up, rendered in Blender's own thread, edited, undone; then previews are
saved (`previews.py`).

Arguments after `--`: the zip, a .blend file with the mirror Ball, the folder for what was seen and rendered.
"""

from __future__ import annotations

import json
import sys
import threading
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent))
from previews import previews
from scripted import Script, arguments, in_view, install, play

ARCHIVE, BLEND, FOLDER = arguments()[:3]
seen: dict[str, Any] = {"ended": [], "threads": []}


def blocks() -> list[list[str]]:
    return [[block.name for block in kind] for kind in (bpy.data.scenes, bpy.data.collections, bpy.data.node_groups)]


def played() -> Script:
    bpy.context.preferences.view.render_display_type = "NONE"
    bpy.ops.wm.open_mainfile(filepath=BLEND, load_ui=False)
    yield 0.2
    for handlers, what in ((bpy.app.handlers.render_complete, "complete"), (bpy.app.handlers.render_cancel, "cancel")):
        handlers.append(lambda *_arguments, what=what: seen["ended"].append(what))
    bpy.app.handlers.render_post.append(
        lambda *_arguments: seen["threads"].append(threading.current_thread() is threading.main_thread())
    )
    with in_view():
        bpy.ops.ed.undo_push(message="opened")
    seen["before"] = blocks()
    with in_view():
        seen["set up"] = list(bpy.ops.curvrefl.set_up_film("INVOKE_DEFAULT"))
        bpy.ops.ed.undo_push(message="film")
    seen["after"] = blocks()
    yield 0.2
    second = bpy.data.objects.new("second", bpy.data.objects["Ball"].data)
    second.location.x, second.scale = 50.0, (1e-3,) * 3
    second.curvrefl.is_mirror = True
    bpy.context.scene.collection.objects.link(second)
    yield 0.2
    seen["held out"] = [obj.name for obj in bpy.data.collections["Scene Mirrors"].objects]
    with in_view():
        bpy.ops.render.render("INVOKE_DEFAULT", write_still=True)
    while not seen["ended"]:
        yield 0.05
    yield 0.2
    with in_view():
        bpy.ops.ed.undo()
        bpy.ops.ed.undo()
    yield 0.2
    seen["undone"] = blocks()
    # (Previews are renders, too.)
    seen["renders"] = [list(seen["ended"]), list(seen["threads"])]
    (Path(FOLDER) / "previews").mkdir()
    yield from previews(Path(FOLDER) / "previews", seen)


def end(error: str) -> None:
    seen["error"] = error
    Path(FOLDER, "seen.json").write_text(json.dumps(seen, indent=1), encoding="utf-8")
    bpy.ops.wm.quit_blender()


install(ARCHIVE)
play(played(), end)
