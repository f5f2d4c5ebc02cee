# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: Bake Look as its button starts it, stopped by Escape and to its end; in the viewport.

Events are simulated (`--enable-event-simulate`). Arguments after `--`: the zip, a folder for what was seen.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from scripted import Script, arguments, extension, in_view, install, play, rests, screenshot, view_3d

ARCHIVE, FOLDER = arguments()[:2]
seen: dict[str, Any] = {}


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def is_modal() -> bool:
    return any(operator.bl_idname == "CURVREFL_OT_bake_look" for operator in window().modal_operators)


def ends() -> bool:
    return not is_modal()


def counts() -> list[int]:
    return [len(getattr(bpy.data, name)) for name in ("materials", "images", "scenes", "objects", "meshes")]


def build() -> bpy.types.Material:
    """A mirror beside a cube whose color is ambient occlusion's."""
    cube = bpy.data.objects["Cube"]
    material = cube.active_material
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeAmbientOcclusion")
    node.inputs["Color"].default_value = (0.9, 0.3, 0.1, 1.0)
    node.inputs["Distance"].default_value = 3.0
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    bpy.ops.mesh.primitive_plane_add(size=12.0, location=(0.0, 0.0, -1.0))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, location=(2.5, 2.0, 0.0))
    bpy.ops.object.shade_smooth()
    ball = bpy.context.object
    chrome = bpy.data.materials.new("Chrome")
    shader = chrome.node_tree.nodes["Principled BSDF"]
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 1.0, 0.0
    ball.data.materials.append(chrome)
    ball.curvrefl.is_mirror = True
    return material


def remarks() -> dict[str, list[str]]:
    return dict(extension("curvrefl_addon.viewport.handlers").material_remarks())


def script() -> Script:
    install(ARCHIVE)
    with in_view():
        material = build()
    name = material.name
    # (A file that is opened closes the splash screen.)
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(FOLDER) / "scene.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(Path(FOLDER) / "scene.blend"), load_ui=False)
    yield 1.0
    area, space, _region = view_3d()
    space.shading.type = "MATERIAL"
    space.shading.use_scene_world = space.shading.use_scene_lights = True
    space.show_region_ui = True
    bpy.context.window_manager.curvrefl_enabled = True
    yield rests
    sidebar = next(region for region in area.regions if region.type == "UI")
    sidebar.active_panel_category = "Curvrefl"
    yield 2.0
    seen["remarks before"] = remarks()
    screenshot(Path(FOLDER) / "before.png")
    before = counts()
    with in_view():
        bpy.ops.curvrefl.bake_look("INVOKE_DEFAULT", material=name, resolution=256, samples=4)
    seen["is modal"] = is_modal()
    window().event_simulate(type="ESC", value="PRESS", x=400, y=400)
    yield ends
    seen["nothing after escape"] = counts() == before
    with in_view():
        bpy.ops.curvrefl.bake_look("INVOKE_DEFAULT", material=name, resolution=256, samples=16)
    yield ends
    seen["new"] = [after - count for after, count in zip(counts(), before, strict=True)]
    yield rests
    yield 2.0
    seen["remarks after"] = remarks()
    screenshot(Path(FOLDER) / "after.png")
    bpy.ops.ed.undo()
    yield 1.0
    seen["undone"] = "curvrefl_look" not in bpy.data.materials[name]


def finish(error: str) -> None:
    seen["error"] = error
    Path(FOLDER, "seen.json").write_text(json.dumps(seen), encoding="utf-8")
    bpy.ops.wm.quit_blender()


play(script(), finish)
