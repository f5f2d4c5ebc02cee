# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A chrome ball among shining cubes before a camera with an aperture, at rest or in motion.

Nothing is lit, so that pictures differ by what is seen alone.
"""

from __future__ import annotations

from math import radians
from typing import Any

import bpy

CUBES = (
    (-1.6, -1.5, (0.0, 1.0, 0.0, 1.0)),
    (1.5, -2.2, (0.0, 0.0, 1.0, 1.0)),
    (1.8, 2.0, (1.0, 1.0, 0.0, 1.0)),
    (-2.2, 1.5, (1.0, 0.0, 1.0, 1.0)),
)


def build_blurred_stage(is_orthographic: bool = False) -> bpy.types.Scene:
    """A new file; the lens is in focus on the ball's front and depth of field is off."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.3, 0.4, 0.5, 1.0)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    _named("ball", "chrome", (1.0, 1.0, 1.0, 1.0), metallic=1.0)
    bpy.ops.object.shade_smooth()
    bpy.ops.mesh.primitive_plane_add(size=12, location=(0.0, 0.0, -1.0))
    _named("floor", "red", (0.8, 0.2, 0.1, 1.0))
    for number, (x, y, color) in enumerate(CUBES):
        bpy.ops.mesh.primitive_cube_add(size=0.6, location=(x, y, -0.7))
        _named(f"cube {number}", f"paint {number}", color)
    data = bpy.data.cameras.new("camera")
    camera = bpy.data.objects.new("camera", data)
    camera.location, camera.rotation_euler = (0.0, -6.0, 1.5), (radians(75.0), 0.0, 0.0)
    if is_orthographic:
        data.type, data.ortho_scale = "ORTHO", 6.0
    data.dof.focus_distance, data.dof.aperture_fstop = 5.2, 1.0 if is_orthographic else 0.05
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.context.view_layer.update()
    return scene


def slide(name: str, axis: int, first: float, last: float) -> None:
    """An object goes straight along an axis from frame 0 to frame 2, at one speed; frame 1 is the present."""
    obj = bpy.data.objects[name]
    for frame, place in ((0, first), (2, last)):
        obj.location[axis] = place
        obj.keyframe_insert("location", index=axis, frame=frame)
    action: Any = obj.animation_data.action
    for curve in action.layers[0].strips[0].channelbags[0].fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    bpy.context.scene.frame_set(1)


def _named(name: str, material_name: str, color: tuple[float, ...], metallic: float = 0.0) -> None:
    """The active object's name and material: a mirror of this color, or what shines in it."""
    obj = bpy.context.object
    obj.name = name
    material = bpy.data.materials.new(material_name)
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = metallic, 0.0
    shader.inputs["Base Color"].default_value = color if metallic else (0.0, 0.0, 0.0, 1.0)
    if not metallic:
        shader.inputs["Specular IOR Level"].default_value = 0.0
        shader.inputs["Emission Color"].default_value, shader.inputs["Emission Strength"].default_value = color, 0.5
    obj.data.materials.append(material)
