# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene of a few pixels, as a file, for tests of the command line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np

RUN_VERB = Path(__file__).resolve().parents[2] / "tools" / "run_verb.py"
SIZE = (32, 24)

type Change = Callable[[bpy.types.Object], None]


def build_scene() -> bpy.types.Object:
    """A mirror ball of radius 1 at the origin, a red block beside it, a white world, no indirect light; returns the
    ball."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.cycles.diffuse_bounces = 0
    scene.world = bpy.data.worlds.new("world")
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=1.0)
    ball = bpy.context.object
    ball.name = "Mirror Ball"
    bpy.ops.object.shade_smooth()
    chrome = bpy.data.materials.new("chrome")
    shader = chrome.node_tree.nodes["Principled BSDF"]
    shader.inputs["Metallic"].default_value = 1.0
    shader.inputs["Roughness"].default_value = 0.0
    ball.data.materials.append(chrome)
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(2.0, -1.0, 0.0))
    block = bpy.context.object
    block.name = "Block"
    camera = bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    camera.location = (0.0, -6.0, 0.0)
    camera.rotation_euler = (np.pi / 2.0, 0.0, 0.0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    return ball


def saved(folder: Path, change: Change | None = None) -> Path:
    """The scene with a change, as a file in a folder of its own."""
    ball = build_scene()
    if change:
        change(ball)
    path = folder / "files" / "scene.blend"
    path.parent.mkdir(exist_ok=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False)
    return path
