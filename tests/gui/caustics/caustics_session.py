# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: caustics are switched on, their mirror is moved, they are switched off.

Arguments after `--`: the zip, a folder for what was seen.
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


def material(name: str, metallic: float, roughness: float) -> bpy.types.Material:
    made = bpy.data.materials.new(name)
    inputs = made.node_tree.nodes["Principled BSDF"].inputs
    inputs["Metallic"].default_value, inputs["Roughness"].default_value = metallic, roughness
    return made


def build() -> None:
    """A ring on a floor under a sun."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.mesh.primitive_plane_add(size=8.0)
    bpy.context.object.data.materials.append(material("Matt", 0.0, 1.0))
    bpy.ops.mesh.primitive_cylinder_add(vertices=96, radius=1.0, depth=0.6, end_fill_type="NOTHING")
    bpy.ops.object.shade_smooth()
    ring = bpy.context.object
    ring.name, ring.location = "Ring", (0.0, 0.0, 0.301)
    ring.data.materials.append(material("Chrome", 1.0, 0.0))
    ring.curvrefl.is_mirror = True
    lamp = bpy.data.objects["Light"].data
    lamp.type = "SUN"
    lamp.energy = 3.0
    scene = bpy.context.scene
    scene.curvrefl.samples, scene.curvrefl.caustic_patches = 2, 4096


def statistics() -> dict[str, str]:
    return dict(extension("curvrefl_addon.viewport.handlers").statistics())


def script() -> Script:
    install(ARCHIVE)
    with in_view():
        build()
    _area, space, _region = view_3d()
    space.shading.type = "SOLID"
    bpy.context.window_manager.curvrefl_enabled = True
    yield rests
    seen["off"] = statistics()
    bpy.context.scene.curvrefl.caustics = True
    yield 0.3
    yield rests
    seen["on"] = statistics()
    screenshot(Path(FOLDER) / "on.png")
    ring = bpy.data.objects["Ring"]
    for _ in range(4):
        ring.location.x += 0.2
        yield 0.1
    yield rests
    seen["moved"] = statistics()
    screenshot(Path(FOLDER) / "moved.png")
    bpy.context.scene.curvrefl.caustics = False
    yield 0.3
    yield rests
    seen["off again"] = statistics()


def finish(error: str) -> None:
    seen["error"] = error
    Path(FOLDER, "seen.json").write_text(json.dumps(seen), encoding="utf-8")
    bpy.ops.wm.quit_blender()


play(script(), finish)
