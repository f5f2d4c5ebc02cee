# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: renders by the engine in Blender's own thread, while the viewport draws reflections.

Arguments after `--`: the zip, a .blend file with the objects Mirror Ball and Block, the folder for what was seen and
rendered. The file as it was rendered is `marked.blend` there.
"""

from __future__ import annotations

import json
import sys
import threading
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from scripted import Script, arguments, extension, in_view, install, play, rests, view_3d

ARCHIVE, BLEND, FOLDER = arguments()[:3]
FRAMES = 4
seen: dict[str, Any] = {"threads": [], "ended": []}


def drawn() -> int:
    return extension("curvrefl_addon.viewport.handlers").counters().get("sub-frames", 0)


def marked() -> None:
    """The file with its mirror, the engine, and something that moves."""
    scene = bpy.context.scene
    ball = bpy.data.objects["Mirror Ball"]
    ball.curvrefl.is_mirror = True
    for frame in (1, FRAMES):
        ball.location.x = 0.3 * (frame - 1)
        ball.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    scene.frame_end = FRAMES
    scene.render.engine = "CURVREFL"
    scene.render.resolution_x, scene.render.resolution_y = 64, 48
    scene.curvrefl.render_samples, scene.curvrefl.samples = 4, 2
    bpy.context.view_layer.curvrefl.use_pass_mirror = bpy.context.view_layer.curvrefl.use_pass_object = True
    settings = scene.render.image_settings
    settings.media_type, settings.file_format, settings.color_depth = "MULTI_LAYER_IMAGE", "OPEN_EXR_MULTILAYER", "32"
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(FOLDER) / "marked.blend"))


def rendered(name: str, animation: bool = False) -> Script:
    """As F12 does; the viewport is drawn again and again meanwhile, and what it shows changes."""
    scene = bpy.context.scene
    scene.render.filepath = str(Path(FOLDER) / name)
    count = len(seen["ended"])
    before = drawn()
    with in_view():
        bpy.ops.render.render("INVOKE_DEFAULT", animation=animation, write_still=not animation)
    region = view_3d()[1].region_3d
    while len(seen["ended"]) == count:
        region.view_distance *= 1.01
        view_3d()[0].tag_redraw()
        yield 0.05
    yield 0.2
    seen[f"drawn during {name}"] = drawn() - before


def played() -> Script:
    bpy.context.preferences.view.render_display_type = "NONE"
    bpy.ops.wm.open_mainfile(filepath=BLEND, load_ui=False)
    yield 0.2
    marked()
    for handlers, what in ((bpy.app.handlers.render_complete, "complete"), (bpy.app.handlers.render_cancel, "cancel")):
        handlers.append(lambda *_arguments, what=what: seen["ended"].append(what))
    bpy.app.handlers.render_post.append(
        lambda *_arguments: seen["threads"].append(threading.current_thread() is threading.main_thread())
    )
    yield from rendered("alone")
    _area, space, _region = view_3d()
    space.shading.type = "SOLID"
    bpy.context.window_manager.curvrefl_enabled = True
    yield rests
    yield from rendered("beside")
    yield from rendered("frame_", animation=True)
    bpy.context.scene.frame_set(1)
    yield rests
    yield from rendered("again")
    bpy.context.scene.frame_set(FRAMES)
    yield rests
    yield from rendered("last")
    seen["messages"] = extension("curvrefl_addon.viewport.handlers").messages()
    seen["sessions"] = extension("curvrefl_addon.engine.engine").sessions_kept()
    seen["enabled"] = bpy.context.window_manager.curvrefl_enabled


def end(error: str) -> None:
    seen["error"] = error
    Path(FOLDER, "seen.json").write_text(json.dumps(seen, indent=1), encoding="utf-8")
    bpy.ops.wm.quit_blender()


install(ARCHIVE)
play(played(), end)
