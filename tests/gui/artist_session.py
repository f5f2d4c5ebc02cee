# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: install the zip, mark a mirror, look, orbit, move something, switch off, quit.

Arguments after `--`: the zip, a .blend file with an object Kettle, the folder for what was seen.
"""

import json
import shutil
import subprocess
import sys
import time
import traceback
from pathlib import Path

import bpy

ARCHIVE, BLEND, FOLDER = sys.argv[sys.argv.index("--") + 1 :]
RESTING = 6.0
"""Seconds in which a view comes to rest on a software renderer"""
seen: dict = {"steps": []}


def viewport():
    return next(module for name, module in sys.modules.items() if name.endswith(".curvrefl_addon.viewport"))


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


def view_3d():
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return area, area.spaces[0], next(region for region in area.regions if region.type == "WINDOW")


def screenshot(name: str) -> None:
    """Blender's own is black on a virtual screen."""
    if shutil.which("import"):
        subprocess.run(["import", "-window", "root", str(Path(FOLDER) / name)], check=True)


def prepare():
    _area, space, _ = view_3d()
    space.overlay.show_overlays = False
    space.show_gizmo = False
    space.show_region_toolbar = False
    space.show_region_header = False
    space.show_region_tool_header = False
    space.shading.type = "SOLID"
    space.region_3d.view_perspective = "CAMERA"
    return 2.0


def enable():
    bpy.data.objects["Kettle"].curvrefl.is_mirror = True
    start = time.perf_counter()
    bpy.context.window_manager.curvrefl_enabled = True
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    seen["first picture seconds"] = time.perf_counter() - start
    assert viewport().counters()["sub-frames"] == 1
    return 2 * RESTING


def look():
    note("enabled")
    _area, space, region = view_3d()
    data = space.region_3d
    seen["view"] = {
        "view_matrix": [list(row) for row in data.view_matrix],
        "window_matrix": [list(row) for row in data.window_matrix],
        "region": [region.x, region.y, region.width, region.height],
    }
    screenshot("enabled.png")
    data.view_perspective = "PERSP"
    data.view_distance = 0.7
    return RESTING


def orbit():
    note("moved the view")
    area, space, _ = view_3d()
    space.region_3d.view_distance = 0.9
    area.tag_redraw()
    return RESTING


def move_camera():
    note("moved the view again")
    bpy.context.scene.camera.location.x += 0.01
    return 3.0


def move():
    note("moved the camera")
    bpy.data.objects["Ball"].location.z += 0.01
    return RESTING


def move_mirror():
    note("moved an object")
    bpy.data.objects["Kettle"].rotation_euler.z += 0.1
    return RESTING


def edit():
    note("moved the mirror")
    mesh = bpy.data.objects["Ball"].data
    mesh.vertices[0].co.z += 0.001
    mesh.update()
    return RESTING


def edit_mirror():
    note("edited a mesh")
    mesh = bpy.data.objects["Kettle"].data
    mesh.vertices[0].co.z += 0.0001
    mesh.update()
    return RESTING


def paint():
    note("edited the mirror's mesh")
    material = bpy.data.objects["Ball"].active_material
    node = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    node.inputs["Roughness"].default_value = 0.3
    return RESTING


def hide():
    note("painted")
    bpy.data.objects["Ball"].hide_set(True)
    return RESTING


def zebra():
    note("hid an object")
    bpy.context.scene.curvrefl.show = "ZEBRA"
    return RESTING


def disable():
    note("showed zebra stripes")
    screenshot("zebra.png")
    bpy.context.window_manager.curvrefl_enabled = False
    return 2.0


def finish():
    note("disabled")
    seen["finished"] = True
    end()


def end() -> None:
    (Path(FOLDER) / "seen.json").write_text(json.dumps(seen), encoding="utf-8")
    bpy.ops.wm.quit_blender()


steps = [
    prepare,
    enable,
    look,
    orbit,
    move_camera,
    move,
    move_mirror,
    edit,
    edit_mirror,
    paint,
    hide,
    zebra,
    disable,
    finish,
]


def advance():
    try:
        return steps.pop(0)()
    except Exception:
        seen["error"] = traceback.format_exc()
        end()
        return None


bpy.context.preferences.view.show_splash = False
bpy.ops.extensions.package_install_files(repo="user_default", filepath=ARCHIVE, enable_on_install=True)
bpy.ops.wm.open_mainfile(filepath=BLEND, load_ui=False)
bpy.app.timers.register(advance, first_interval=3.0, persistent=True)
