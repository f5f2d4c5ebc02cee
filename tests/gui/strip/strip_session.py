# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: the quick start, step by step, with a picture of the window at each.

Played by `./curvrefl images quick_start.jpg`. Arguments after `--`: the zip, the demo's .blend file, the folder for the
pictures.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from scripted import Script, arguments, in_view, install, play, rests, screenshot, view_3d

ARCHIVE, DEMO, FOLDER = arguments()[:3]
CUSHION = 1.0
"""Seconds that panels take to be drawn"""


def keep(name: str) -> None:
    screenshot(Path(FOLDER) / f"step_{name}.png")


def script() -> Script:
    install(ARCHIVE)
    yield from installed()
    bpy.ops.wm.open_mainfile(filepath=DEMO, load_ui=False)
    yield CUSHION
    area, space, _region = view_3d()
    space.shading.type = "MATERIAL"
    space.shading.use_scene_world = space.shading.use_scene_lights = True
    space.region_3d.view_perspective = "CAMERA"
    space.overlay.show_overlays = False
    space.show_gizmo = False
    kettle = bpy.data.objects["Kettle"]
    bpy.context.view_layer.objects.active = kettle
    kettle.select_set(True)
    space.show_region_ui = True
    yield CUSHION
    sidebar = next(region for region in area.regions if region.type == "UI")
    sidebar.active_panel_category = "Curvrefl"
    kettle.curvrefl.is_mirror = True
    bpy.context.window_manager.curvrefl_enabled = True
    yield CUSHION
    yield rests
    area.tag_redraw()
    yield CUSHION
    keep("on")
    # (The step before: by now EEVEE has compiled its shaders.)
    bpy.context.window_manager.curvrefl_enabled = False
    area.tag_redraw()
    yield 4.0 * CUSHION
    keep("mark")
    bpy.context.window_manager.curvrefl_enabled = True
    space.show_region_ui = False
    space.region_3d.view_perspective = "PERSP"
    with in_view():
        bpy.ops.view3d.view_selected()
    yield CUSHION
    yield rests
    area.tag_redraw()
    yield CUSHION
    keep("view")
    settings: Any = bpy.context.scene
    settings.curvrefl.show = "ZEBRA"
    yield CUSHION
    yield rests
    area.tag_redraw()
    yield CUSHION
    keep("inspect")


def installed() -> Script:
    """The list of extensions, in place of the 3D view."""
    preferences: Any = bpy.context.preferences
    bpy.ops.wm.read_homefile(use_splash=False)
    yield CUSHION
    area = view_3d()[0]
    area.type = "PREFERENCES"
    preferences.active_section = "EXTENSIONS"
    yield 3.0 * CUSHION
    keep("install")
    area.type = "VIEW_3D"
    yield CUSHION


def end(error: str) -> None:
    (Path(FOLDER) / "seen.json").write_text(json.dumps({"error": error}), encoding="utf-8")
    bpy.ops.wm.quit_blender()


play(script(), end)
