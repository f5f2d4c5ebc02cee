# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The material of a look: images in a Principled BSDF."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import bpy

from ...curvrefl_addon.scene.programs.looks import UV_MAP

SOCKETS = {
    "surface": ("Metallic", "Roughness", "Alpha"),
    "layers": ("Transmission Weight", "Specular IOR Level", "Coat Weight"),
}
"""What three channels of an image go into"""


def stand_in(
    material: bpy.types.Material, principled: Any, images: Mapping[str, bpy.types.Image]
) -> bpy.types.Material:
    """`principled`: the node whose constants are taken over; None: there are several shaders."""
    # (Names that begin with a period are not listed by Blender.)
    made = bpy.data.materials.new(f".{material.name} look")
    if made.node_tree is None:
        made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new("ShaderNodeBsdfPrincipled"), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    if principled is not None:
        _copy_constants(principled, shader)
    elif "layers" not in images:
        shader.inputs["Specular IOR Level"].default_value = 0.0
    place = tree.nodes.new("ShaderNodeUVMap")
    place.uv_map = UV_MAP
    found = {}
    for holds, image in images.items():
        node = found[holds] = tree.nodes.new("ShaderNodeTexImage")
        node.image, node.extension = image, "EXTEND"
        tree.links.new(place.outputs[0], node.inputs[0])
    for holds, sockets in SOCKETS.items():
        if holds in found:
            separate = tree.nodes.new("ShaderNodeSeparateColor")
            tree.links.new(found[holds].outputs["Color"], separate.inputs[0])
            for channel, name in zip(separate.outputs, sockets, strict=True):
                tree.links.new(channel, shader.inputs[name])
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


def _copy_constants(before: Any, shader: Any) -> None:
    for name in ("distribution", "subsurface_method"):
        setattr(shader, name, getattr(before, name))
    for old, new in zip(before.inputs, shader.inputs, strict=True):
        if hasattr(old, "default_value") and not old.is_linked:
            new.default_value = old.default_value
