# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: install the zip, mark a mirror, look, orbit, change this and that, switch off, quit.

Arguments after `--`: the zip, the demo's .blend file, the folder for what was seen.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from scripted import Script, arguments, extension, install, play, rests, screenshot, view_3d

ARCHIVE, BLEND, FOLDER = arguments()[:3]
seen: dict[str, Any] = {"steps": []}


def viewport() -> Any:
    return extension("curvrefl_addon.viewport.handlers")


def our_handlers() -> int:
    handlers = bpy.app.handlers
    lists = (handlers.depsgraph_update_post, handlers.frame_change_post, handlers.undo_post, handlers.load_post)
    return sum("curvrefl" in function.__module__ for functions in lists for function in functions)


def note(name: str) -> None:
    seen["steps"].append(
        {
            "name": name,
            "counters": viewport().counters(),
            "messages": viewport().messages(),
            "handlers": our_handlers(),
            "enabled": bpy.context.window_manager.curvrefl_enabled,
        }
    )


def step(name: str, act: Callable[[], None]) -> Script:
    """Do something, wait for its picture, note what it cost."""
    before = viewport().counters()["sub-frames"]
    act()
    yield 0.3
    view_3d()[0].tag_redraw()
    # (moving the camera changes no picture of another view)
    yield lambda: rests() and (name == "moved the camera" or viewport().counters()["sub-frames"] > before)
    note(name)


def closer() -> None:
    data = view_3d()[1].region_3d
    data.view_perspective = "PERSP"
    data.view_distance = 0.7


def farther() -> None:
    view_3d()[1].region_3d.view_distance = 0.9


def move_camera() -> None:
    bpy.context.scene.camera.location.x += 0.01


def move() -> None:
    bpy.data.objects["Ball"].location.z += 0.01


def turn_mirror() -> None:
    bpy.data.objects["Kettle"].rotation_euler.z += 0.1


def edit(name: str) -> None:
    mesh = bpy.data.objects[name].data
    mesh.vertices[0].co.z += 1e-4
    mesh.update()


def paint() -> None:
    tree = bpy.data.objects["Ball"].active_material.node_tree
    node = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    node.inputs["Roughness"].default_value = 0.3


def zebra() -> None:
    bpy.context.scene.curvrefl.show = "ZEBRA"


def use(method: str) -> None:
    bpy.context.scene.curvrefl.method = method


def script() -> Script:
    install(ARCHIVE)
    bpy.ops.wm.open_mainfile(filepath=BLEND, load_ui=False)
    yield 1.0
    _area, space, region = view_3d()
    space.overlay.show_overlays = False
    space.show_gizmo = space.show_region_toolbar = False
    space.show_region_header = space.show_region_tool_header = False
    space.shading.type = "SOLID"
    space.region_3d.view_perspective = "CAMERA"
    yield 2.0
    bpy.data.objects["Kettle"].curvrefl.is_mirror = True
    use("secant_star")
    start = time.perf_counter()
    bpy.context.window_manager.curvrefl_enabled = True
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    # (Of a coarse sketch; what is said belongs to what is still being made.)
    seen["first redraw seconds"] = time.perf_counter() - start
    assert viewport().progress()
    yield lambda: viewport().counters().get("sub-frames", 0) > 0
    seen["first picture seconds"] = time.perf_counter() - start
    yield rests
    yield 1.0
    note("enabled")
    data = space.region_3d
    seen["view"] = {
        "view_matrix": [list(row) for row in data.view_matrix],
        "window_matrix": [list(row) for row in data.window_matrix],
        "region": [region.x, region.y, region.width, region.height],
    }
    screenshot(Path(FOLDER) / "enabled.png")
    yield from step("chose automatically", lambda: use("auto"))
    seen["reason"] = viewport().reason()
    yield from step("followed rays", lambda: use("exact"))
    screenshot(Path(FOLDER) / "exact.png")
    yield from step("moved an object under rays", move)
    yield from step("edited a mesh under rays", lambda: edit("Ball"))
    yield from step("solved vertices again", lambda: use("secant_star"))
    yield from step("moved the view", closer)
    yield from step("moved the view again", farther)
    yield from step("moved the camera", move_camera)
    yield from step("moved an object", move)
    yield from step("moved the mirror", turn_mirror)
    yield from step("edited a mesh", lambda: edit("Ball"))
    yield from step("edited the mirror's mesh", lambda: edit("Kettle"))
    yield from step("painted", paint)
    yield from step("hid an object", lambda: bpy.data.objects["Ball"].hide_set(True))
    yield from step("showed zebra stripes", zebra)
    screenshot(Path(FOLDER) / "zebra.png")
    bpy.context.window_manager.curvrefl_enabled = False
    yield 1.0
    note("disabled")
    seen["finished"] = True


def end(error: str) -> None:
    if error:
        seen["error"] = error
    (Path(FOLDER) / "seen.json").write_text(json.dumps(seen), encoding="utf-8")
    bpy.ops.wm.quit_blender()


play(script(), end)
