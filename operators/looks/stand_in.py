# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The material of a look: images in a Principled BSDF."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import bpy

from ...curvrefl_addon.scene.programs.looks import UV_MAP
from .channels import PARTS, Shaders

SOCKETS = {
    "metallic": "Metallic",
    "roughness": "Roughness",
    "alpha": "Alpha",
    "transmission": "Transmission Weight",
    "level": "Specular IOR Level",
    "coat": "Coat Weight",
}
"""What channels of images go into"""


def stand_in(
    material: bpy.types.Material, shaders: Shaders, images: Mapping[str, bpy.types.Image]
) -> bpy.types.Material:
    """What is the same everywhere is a constant: that alpha is 1 spares a look what is seen through."""
    # (Names that begin with a period are not listed by Blender.)
    made = bpy.data.materials.new(f".{material.name} look")
    if made.node_tree is None:
        made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new("ShaderNodeBsdfPrincipled"), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    if shaders.single is not None:
        _copy_constants(shaders.single, shader)
    place = tree.nodes.new("ShaderNodeUVMap")
    place.uv_map = UV_MAP
    found = {}
    for holds, image in images.items():
        node = found[holds] = tree.nodes.new("ShaderNodeTexImage")
        node.image, node.extension = image, "EXTEND"
        tree.links.new(place.outputs[0], node.inputs[0])
    for holds in ("surface", "layers"):
        for number, name in enumerate(PARTS[holds]):
            value = shaders.constant(name)
            if value is None:
                tree.links.new(_separated(tree, found[holds]).outputs[number], shader.inputs[SOCKETS[name]])
            else:
                shader.inputs[SOCKETS[name]].default_value = value
    if "base_color" in found:
        tree.links.new(found["base_color"].outputs["Color"], shader.inputs["Base Color"])
    if "emission" in found:
        tree.links.new(found["emission"].outputs["Color"], shader.inputs["Emission Color"])
        shader.inputs["Emission Strength"].default_value = 1.0
    if "normal" in found:
        bump = tree.nodes.new("ShaderNodeNormalMap")
        bump.uv_map = UV_MAP
        tree.links.new(found["normal"].outputs["Color"], bump.inputs["Color"])
        tree.links.new(bump.outputs[0], shader.inputs["Normal"])
    return made


def _separated(tree: Any, texture: Any) -> Any:
    """The node that takes a texture's channels apart."""
    links = texture.outputs["Color"].links
    if links:
        return links[0].to_node
    separate = tree.nodes.new("ShaderNodeSeparateColor")
    tree.links.new(texture.outputs["Color"], separate.inputs[0])
    return separate


def _copy_constants(before: Any, shader: Any) -> None:
    for name in ("distribution", "subsurface_method"):
        setattr(shader, name, getattr(before, name))
    for old, new in zip(before.inputs, shader.inputs, strict=True):
        if hasattr(old, "default_value") and not old.is_linked:
            new.default_value = old.default_value
