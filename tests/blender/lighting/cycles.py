# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A stage in Blender, and what Cycles shows of it."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.scene.arrays import ImageSource, LightArrays, MaterialArrays, WorldArrays
from lighting.stage import Body, Cut, Stage, camera_matrix
from mathutils import Matrix


def build_blender(stage: Stage) -> None:
    """Make the current Blender file show the stage."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    for body in stage.bodies:
        mesh = bpy.data.meshes.new("body")
        mesh.from_pydata(body.positions.tolist(), [], body.triangles.tolist())
        if body.smooth_center is not None:
            mesh.shade_smooth()
            normals = body.positions - np.asarray(body.smooth_center, np.float32)
            mesh.normals_split_custom_set_from_vertices((normals / np.linalg.norm(normals, axis=1)[:, None]).tolist())
        if body.uv is not None:
            layer = mesh.uv_layers.new()
            layer.data.foreach_set("uv", body.uv[body.triangles].astype(np.float32).ravel())
        mesh.materials.append(_blender_material(body, stage.images))
        placed = bpy.data.objects.new("body", mesh)
        placed.visible_shadow = body.visible_shadow
        scene.collection.objects.link(placed)
    for light in stage.lights:
        _add_blender_light(light)
    _set_blender_world(stage.world)
    camera = bpy.data.cameras.new("camera")
    camera.type = "ORTHO"
    camera.ortho_scale = stage.width
    camera.clip_end = 1000.0
    placed = bpy.data.objects.new("camera", camera)
    placed.matrix_world = Matrix(camera_matrix(stage).tolist())
    scene.collection.objects.link(placed)
    scene.camera = placed
    scene.render.resolution_x = scene.render.resolution_y = stage.pixels
    scene.render.resolution_percentage = 100


def cycles_picture(stage: Stage, samples: int = 256, world_light_samples: bool = True) -> np.ndarray:
    """(pixels, pixels, 3) scene-linear, row 0 at the bottom: light at the pixel centers, no indirect diffuse light."""
    build_blender(stage)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.pixel_filter_type = "BLACKMAN_HARRIS"
    cycles.filter_width = 0.01
    cycles.max_bounces = 4
    cycles.diffuse_bounces = 0
    cycles.glossy_bounces = 1
    cycles.transmission_bounces = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = 0.0
    cycles.use_light_tree = False
    scene.view_settings.view_transform = "Raw"
    settings = scene.render.image_settings
    settings.file_format = "OPEN_EXR"
    settings.color_depth = "32"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "cycles.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        pixels = np.empty(stage.pixels * stage.pixels * 4, np.float32)
        image.pixels.foreach_get(pixels)
    return pixels.reshape(stage.pixels, stage.pixels, 4)[..., :3]


def _blender_material(body: Body, images: tuple[ImageSource, ...]) -> Any:
    material = body.material
    made = bpy.data.materials.new(material.name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    if material.glossy_only:
        node = tree.nodes.new("ShaderNodeBsdfAnisotropic")
        node.distribution = "MULTI_GGX"
        node.inputs["Color"].default_value = (*material.base_color, 1.0)
        node.inputs["Roughness"].default_value = material.roughness
    else:
        node = tree.nodes.new("ShaderNodeBsdfPrincipled")
        node.inputs["Base Color"].default_value = (*material.base_color, 1.0)
        node.inputs["Metallic"].default_value = material.metallic
        node.inputs["Roughness"].default_value = material.roughness
        node.inputs["IOR"].default_value = material.ior
        node.inputs["Specular IOR Level"].default_value = material.specular_level
        node.inputs["Emission Color"].default_value = (*material.emission, 1.0)
        node.inputs["Emission Strength"].default_value = 1.0
        node.inputs["Alpha"].default_value = material.alpha
        _set_layers(node, material)
    if material.translucency:
        node = _mixed_with_translucent(tree, material, node)
    if body.cut is not None:
        _link_alpha(tree, images[body.cut.looked.image], body.cut, node.inputs["Alpha"])
    if material.transparent_tint != (1.0, 1.0, 1.0):
        node = _mixed_with_transparent(tree, material, node)
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return made


def _set_layers(node: Any, material: MaterialArrays) -> None:
    node.inputs["Specular Tint"].default_value = (*material.specular_tint, 1.0)
    node.inputs["Diffuse Roughness"].default_value = material.diffuse_roughness
    for layer in ("sheen", "coat"):
        for part in ("weight", "roughness"):
            node.inputs[f"{layer} {part}".title()].default_value = getattr(material, f"{layer}_{part}")
        node.inputs[f"{layer} tint".title()].default_value = (*getattr(material, f"{layer}_tint"), 1.0)
    node.inputs["Coat IOR"].default_value = material.coat_ior


def _mixed_with_translucent(tree: Any, material: MaterialArrays, node: Any) -> Any:
    """Of a material that is all base."""
    mix, through = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTranslucent")
    through.inputs["Color"].default_value = (*material.base_color, 1.0)
    mix.inputs[0].default_value = material.translucency
    tree.links.new(node.outputs[0], mix.inputs[1])
    tree.links.new(through.outputs[0], mix.inputs[2])
    return mix


def _link_alpha(tree: Any, image: ImageSource, cut: Cut, to: Any) -> None:
    made = bpy.data.images.new(image.name, image.width, image.height, alpha=True, float_buffer=True)
    made.pixels.foreach_set(image.read().astype(np.float32).ravel())
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = made
    node.interpolation = "Closest" if cut.looked.is_nearest else "Linear"
    node.extension = cut.looked.extension
    out = node.outputs["Alpha"]
    if cut.threshold is not None:
        above = tree.nodes.new("ShaderNodeMath")
        above.operation = "GREATER_THAN"
        above.inputs[1].default_value = cut.threshold
        tree.links.new(out, above.inputs[0])
        out = above.outputs[0]
    tree.links.new(out, to)


def _mixed_with_transparent(tree: Any, material: MaterialArrays, node: Any) -> Any:
    """As the Principled alpha, but that what is not there has a tint."""
    node.inputs["Alpha"].default_value = 1.0
    mix, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
    clear.inputs["Color"].default_value = (*material.transparent_tint, 1.0)
    mix.inputs[0].default_value = material.alpha
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(node.outputs[0], mix.inputs[2])
    return mix


def _add_blender_light(light: LightArrays) -> None:
    data = bpy.data.lights.new(light.name, light.kind)
    data.energy = 1.0
    data.color = light.color
    strongest = max(light.color)
    data.color = tuple(channel / strongest for channel in light.color)
    data.energy = strongest
    data.use_shadow = light.casts_shadow
    if light.kind == "SUN":
        data.angle = light.angle
    elif light.kind == "AREA":
        data.shape = "ELLIPSE" if light.ellipse else "RECTANGLE"
        data.size, data.size_y = light.size
    else:
        data.shadow_soft_size = light.radius
        if light.kind == "SPOT":
            data.spot_size = light.spot_angle
            data.spot_blend = light.spot_blend
    placed = bpy.data.objects.new(light.name, data)
    placed.matrix_world = Matrix(light.matrix.tolist())
    placed.visible_glossy = light.visible_glossy
    bpy.context.scene.collection.objects.link(placed)


def _set_blender_world(world: WorldArrays) -> None:
    made = bpy.data.worlds.new("world")
    bpy.context.scene.world = made
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputWorld")
    background = tree.nodes.new("ShaderNodeBackground")
    background.inputs["Color"].default_value = (*world.color, 1.0)
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    if world.image is not None:
        height, width = world.image.shape[:2]
        image = bpy.data.images.new("sky", width, height, float_buffer=True)
        image.colorspace_settings.name = "Non-Color"
        pixels = np.ones((height, width, 4), np.float32)
        pixels[..., :3] = world.image
        image.pixels.foreach_set(pixels.ravel())
        node = tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = image
        tree.links.new(node.outputs["Color"], background.inputs["Color"])
