# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cards in front of a camera, each colored from another source, under a warm sun and an image of the sky."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

COLOR = (0.8, 0.3, 0.1, 1.0)
CARDS = ("bytes", "linear bytes", "byte attribute", "float attribute", "gray", "plain")
"""Left to right"""


def build_cards(working_space: str) -> bpy.types.Scene:
    """A new file in this working space; the picture's width is divided among CARDS, with sky above and below."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if working_space != "Linear Rec.709":
        bpy.ops.wm.set_working_color_space(working_space=working_space, convert_colors=False)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    tree = scene.world.node_tree
    sky = tree.nodes.new("ShaderNodeTexEnvironment")
    sky.image = byte_image("sky", (0.2, 0.5, 0.9, 1.0))
    tree.links.new(sky.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    for number, name in enumerate(CARDS):
        bpy.ops.mesh.primitive_plane_add(size=0.9, location=(number - 2.5, 0.0, 0.0), rotation=(np.pi / 2, 0.0, 0.0))
        card = bpy.context.object
        card.name = name
        card.data.materials.append(_material(name, card.data))
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle = 2.0, 0.0
    sun.data.use_temperature, sun.data.temperature = True, 3000.0
    sun.rotation_euler = (np.pi / 2, 0.0, 0.0)
    scene.collection.objects.link(sun)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.1, location=(0.0, -30.0, 0.0))
    bpy.context.object.name = "mirror"
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (0.0, -10.0, 0.0), (np.pi / 2, 0.0, 0.0)
    camera.data.type, camera.data.ortho_scale = "ORTHO", 6.0
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.context.view_layer.update()
    return scene


def byte_image(name: str, color: tuple[float, ...], space: str = "sRGB") -> bpy.types.Image:
    """Of these bytes everywhere."""
    image: Any = bpy.data.images.new(name, 8, 4, alpha=False)
    image.colorspace_settings.name = space
    image.pixels.foreach_set(np.tile(np.array(color, np.float32), 32))
    image.update()
    image.pack()
    return image


def _material(name: str, mesh: bpy.types.Mesh) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    tree = material.node_tree
    shader = tree.nodes["Principled BSDF"]
    shader.inputs["Specular IOR Level"].default_value = 0.0
    shader.inputs["Base Color"].default_value = COLOR
    node: Any = None
    if name.endswith("bytes"):
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = byte_image(name, COLOR, "sRGB" if name == "bytes" else "Linear Rec.709")
    elif name.endswith("attribute"):
        kind = "BYTE_COLOR" if name.startswith("byte") else "FLOAT_COLOR"
        colors = mesh.color_attributes.new("colors", kind, "CORNER")
        colors.data.foreach_set("color", np.tile(np.array(COLOR, np.float32), len(colors.data)))
        node = tree.nodes.new("ShaderNodeVertexColor")
        node.layer_name = "colors"
    elif name == "gray":
        node = tree.nodes.new("ShaderNodeRGBToBW")
        node.inputs["Color"].default_value = COLOR
    if node is not None:
        tree.links.new(node.outputs[0], shader.inputs["Base Color"])
    return material
