# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A file to compare, which several tests open."""

from __future__ import annotations

from pathlib import Path

import bpy
import gpu
import numpy as np
import pytest


@pytest.fixture(scope="module")
def _gpu_context() -> None:
    gpu.init()


@pytest.fixture
def blend(_gpu_context: None, tmp_path: Path) -> Path:
    """A chrome ball over a red floor in a gray world, saved as a file."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.3, 0.4, 0.5, 1)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    ball = bpy.context.object
    ball.name = "ball"
    bpy.ops.object.shade_smooth()
    chrome = bpy.data.materials.new("chrome")
    shader = chrome.node_tree.nodes["Principled BSDF"]
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 1.0, 0.0
    ball.data.materials.append(chrome)
    bpy.ops.mesh.primitive_plane_add(size=12, location=(0, 0, -1.1))
    bpy.context.object.name = "floor"
    red = bpy.data.materials.new("red")
    red.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.8, 0.1, 0.1, 1)
    bpy.context.object.data.materials.append(red)
    bpy.ops.object.light_add(type="POINT", location=(2, -2, 4))
    bpy.context.object.data.energy = 500
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (0, -5, 1.5), (np.radians(75.0), 0, 0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    path = tmp_path / "ball & floor.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)
    return path
