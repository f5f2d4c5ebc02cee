# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One small scene of the open Blender session, anywhere and of any size.

All places are whole numbers times the scale, which should be a power of two: moved by whole numbers, Blender's single
precision holds them exactly as far as 1.6e7 m, so that all that differs between two places is what a renderer makes of
them. Lamps grow with the square of the scale, so that all is lit alike.
"""

from __future__ import annotations

import bpy
import numpy as np
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.scene.extract import extract_scene
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from mathutils import Vector

type Place = tuple[float, float, float]
MIRROR = "Mirror Ball"


def build(place: Place = (0.0, 0.0, 0.0), scale: float = 1.0, size: tuple[int, int] = (96, 72)) -> bpy.types.Object:
    """A mirror ball of radius 2 on a floor, with blocks around it, lit by a point lamp, an area lamp, a sun and a gray
    world; returns the ball."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("World")
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.2, 0.25, 0.3, 1.0)

    def at(x: float, y: float, z: float) -> Vector:
        return Vector((place[0] + scale * x, place[1] + scale * y, place[2] + scale * z))

    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=2.0 * scale)
    ball = placed_object(at(0, 0, 2), material("Chrome", (0.9, 0.9, 0.9), metallic=1.0, roughness=0.0), MIRROR)
    ball.data.polygons.foreach_set("use_smooth", np.ones(len(ball.data.polygons), bool))
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8, size=32.0 * scale)
    placed_object(at(0, 0, 0), material("Gray", (0.5, 0.5, 0.5)), "Floor")
    blocks = ((4, 0, 1, 2), (-4, 1, 1, 2), (-2, -3, 1, 1), (3, -3, 1, 1), (0, 6, 3, 4), (1, -7, 1, 1))
    colors = ((0.8, 0.1, 0.1), (0.1, 0.6, 0.1), (0.1, 0.2, 0.8), (0.8, 0.7, 0.1), (0.7, 0.2, 0.7), (0.1, 0.7, 0.7))
    for number, ((x, y, z, edge), color) in enumerate(zip(blocks, colors, strict=True), 1):
        bpy.ops.mesh.primitive_cube_add(size=edge * scale)
        placed_object(at(x, y, z), material(f"Paint {number}", color), f"Block {number}")
    _lamp("POINT", at(-3, -5, 6), 600.0 * scale**2, radius=0.25 * scale)
    _lamp("AREA", at(5, -3, 7), 500.0 * scale**2, radius=2.0 * scale)
    _lamp("SUN", at(0, 0, 8), 0.5, radius=0.0)
    camera = bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    camera.location = at(2, -10, 5)
    camera.rotation_euler = (np.radians(72.0), 0.0, np.radians(11.0))
    camera.data.lens = 40.0
    camera.data.clip_start, camera.data.clip_end = 0.1 * scale, 100.0 * scale
    scene.collection.objects.link(camera)
    scene.camera = camera
    return ball


def read(ball: bpy.types.Object, size: tuple[int, int] = (96, 72)) -> tuple[SceneArrays, View]:
    """The open scene with `ball` as its mirror, and what its camera sees."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    scene = bpy.context.scene
    return extract_scene(depsgraph, scene, [ball]), view_of_camera(scene, scene.camera, *size)


def placed_object(location: Vector | Place, paint: bpy.types.Material, name: str) -> bpy.types.Object:
    """The active object, named, placed and painted."""
    thing = bpy.context.object
    thing.name, thing.location = name, location
    thing.data.materials.append(paint)
    return thing


def material(name: str, color: Place, metallic: float = 0.0, roughness: float = 0.5) -> bpy.types.Material:
    """A plain Principled BSDF."""
    material = bpy.data.materials.new(name)
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = metallic, roughness
    return material


def _lamp(kind: str, location: Vector, energy: float, radius: float) -> None:
    data = bpy.data.lights.new(kind.capitalize(), kind)
    data.energy = energy
    if kind == "AREA":
        data.size = radius
    elif kind == "POINT":
        data.shadow_soft_size = radius
    lamp = bpy.data.objects.new(kind.capitalize(), data)
    lamp.location = location
    lamp.rotation_euler = {"AREA": (0.4, 0.5, 0.0), "SUN": (0.5, -0.4, 0.0)}.get(kind, (0.0, 0.0, 0.0))
    bpy.context.scene.collection.objects.link(lamp)
