# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A plane in Cycles that shows nothing but one angle of one material, in a world that is a ramp over directions."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Vector

AXIS = np.array([0.0, 0.8, 0.6])
AZIMUTH = 0.4


def world(directions: np.ndarray) -> np.ndarray:
    """(n,) radiance that comes from (n, 3) directions."""
    return 0.5 + 0.5 * directions @ AXIS


def viewer(cosine: float, is_back: bool) -> np.ndarray:
    sine = math.sqrt(1.0 - cosine * cosine)
    return np.array([sine * math.cos(AZIMUTH), sine * math.sin(AZIMUTH), -cosine if is_back else cosine])


def new_scene(samples: int) -> bpy.types.Scene:
    """Without sampling of the world: the only light is what paths meet."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", samples, False, False
    cycles.blur_glossy, cycles.sample_clamp_indirect, cycles.use_light_tree = 0.0, 0.0, False
    scene.render.resolution_x = scene.render.resolution_y = 24
    scene.render.image_settings.media_type = "IMAGE"
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    mesh = bpy.data.meshes.new("plane")
    mesh.from_pydata([(-50, -50, 0), (50, -50, 0), (50, 50, 0), (-50, 50, 0)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1])
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.ortho_scale = "ORTHO", 1.0
    for name, data in (("plane", mesh), ("camera", camera)):
        scene.collection.objects.link(bpy.data.objects.new(name, data))
    scene.camera = bpy.data.objects["camera"]
    scene.world = bpy.data.worlds.new("ramp")
    scene.world.cycles.sampling_method = "NONE"
    tree = scene.world.node_tree
    tree.nodes.clear()
    names = ("ShaderNodeTexCoord", "ShaderNodeVectorMath", "ShaderNodeMath", "ShaderNodeBackground")
    coordinates, dot, ramp, background = (tree.nodes.new(name) for name in names)
    dot.operation, ramp.operation = "DOT_PRODUCT", "MULTIPLY_ADD"
    dot.inputs[1].default_value = AXIS
    ramp.inputs[1].default_value = ramp.inputs[2].default_value = 0.5
    output = tree.nodes.new("ShaderNodeOutputWorld")
    for source, target in (
        (coordinates.outputs["Generated"], dot.inputs[0]),
        (dot.outputs["Value"], ramp.inputs[0]),
        (ramp.outputs[0], background.inputs["Color"]),
        (background.outputs[0], output.inputs[0]),
    ):
        tree.links.new(source, target)
    return scene


def set_material(node: str, inputs: dict[str, Any], properties: dict[str, Any]) -> None:
    """Its tangent is the plane's x."""
    material = bpy.data.materials.new("of a test")
    tree = material.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new(node), tree.nodes.new("ShaderNodeOutputMaterial")
    for name, value in inputs.items():
        shader.inputs[name].default_value = (*value, 1.0) if isinstance(value, tuple) else value
    for name, value in properties.items():
        setattr(shader, name, value)
    if "Tangent" in shader.inputs:
        tangent = tree.nodes.new("ShaderNodeTangent")
        tangent.direction_type, tangent.uv_map = "UV_MAP", "UVMap"
        tree.links.new(tangent.outputs[0], shader.inputs["Tangent"])
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    materials = bpy.data.objects["plane"].data.materials
    materials.clear()
    materials.append(material)


def mean_radiance(scene: bpy.types.Scene, cosine: float, is_back: bool, folder: Path) -> np.ndarray:
    """(3,) that the plane sends to the viewer."""
    direction = Vector(viewer(cosine, is_back))
    scene.camera.location = direction * 5.0
    scene.camera.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()
    scene.render.filepath = str(folder / "plane.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(-1, 4)[:, :3].astype(np.float64).mean(axis=0)
