# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: plays a film with the mirrors on, frame by frame, and notes what each redraw took.

Arguments after `--`: the zip, a .blend file with mirrors that are marked, the folder for what was seen, and how many
frames lie between two pictures of the window.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from time import perf_counter
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tests" / "gui"))
from scripted import Script, arguments, extension, in_view, install, play, rests, screenshot, view_3d

ARCHIVE, BLEND, FOLDER, EVERY = arguments()[:4]
seen: dict[str, Any] = {"frames": [], "ms": [], "broken": 0, "methods": [], "pixels": [], "messages": []}


def script() -> Script:
    install(ARCHIVE)
    bpy.ops.wm.open_mainfile(filepath=BLEND, load_ui=False)
    yield 1.0
    _area, space, _region = view_3d()
    scene: Any = bpy.context.scene
    scene.frame_set(scene.frame_start)
    space.overlay.show_overlays = False
    space.show_gizmo = space.show_region_header = space.show_region_toolbar = False
    space.show_region_tool_header = space.show_region_ui = False
    space.shading.type, space.shading.color_type, space.shading.light = "SOLID", "TEXTURE", "FLAT"
    space.shading.background_type, space.shading.background_color = "VIEWPORT", (0.35, 0.45, 0.6)
    scene.curvrefl.environment = "SCENE"
    space.region_3d.view_perspective = "CAMERA"
    with in_view():
        bpy.ops.view3d.view_center_camera()
    bpy.context.window_manager.curvrefl_enabled = True
    yield 0.3
    yield rests
    for frame in range(scene.frame_start, scene.frame_end + 1):
        play_frame(scene, frame)
        if (frame - scene.frame_start) % int(EVERY) == 0:
            screenshot(Path(FOLDER) / f"window_{frame:04d}.png")
        yield 0.0
    seen["finished"] = True


def play_frame(scene: Any, frame: int) -> None:
    """Go to a frame and have the view drawn, as while a film is played."""
    viewport = extension("curvrefl_addon.viewport.handlers")
    start = perf_counter()
    scene.frame_set(frame)
    with in_view():
        bpy.ops.wm.redraw_timer(type="DRAW_SWAP", iterations=1)
    seen["ms"].append(1e3 * (perf_counter() - start))
    seen["frames"].append(frame)
    picture = next(iter(viewport.pictures().values()))
    shown = picture.pixels()
    mirrors = shown[..., 3] > 0.5
    seen["broken"] += int((mirrors & ~np.isfinite(shown).all(axis=-1)).sum())
    seen["pixels"].append([shown.shape[1], shown.shape[0], int(mirrors.sum())])
    seen["methods"].append(list(picture.methods))
    for message in viewport.messages():
        if message not in seen["messages"]:
            seen["messages"].append(message)
    save()


def save() -> None:
    Path(FOLDER, "seen.json").write_text(json.dumps(seen), encoding="utf-8")


def end(error: str) -> None:
    seen["error"] = error
    save()
    bpy.ops.wm.quit_blender()


play(script(), end)
