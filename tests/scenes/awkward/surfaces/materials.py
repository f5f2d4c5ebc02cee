# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of what mirrors show, and of what the eye sees beside them: glTF, outputs, volumes, glass, alpha."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import awkward
from ..stage import (
    add_sheet,
    bpy,
    give,
    matte,
    node,
    output_of,
    picture,
    principled,
    principled_node,
    stage,
    surface,
    wall_of,
)


@awkward("the usual scene: nothing is awkward")
def plain(folder: Path) -> None:
    stage()


def _gltf(metallic: float, roughness: float) -> bpy.types.Material:
    """As Blender's glTF importer wires it: Separate Color of one image, green to roughness and blue to metallic."""
    material = matte("glTF", (0.7, 0.5, 0.3))
    tree: Any = material.node_tree
    pixels = np.ones((8, 8, 4), np.float32)
    pixels[..., 0], pixels[..., 1], pixels[..., 2] = 1.0, roughness, metallic
    image = picture("Metallic Roughness", pixels)
    image.colorspace_settings.name = "Non-Color"
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    separate = node(tree, "SeparateColor")
    shader = principled_node(material)
    tree.links.new(texture.outputs["Color"], separate.inputs[0])
    tree.links.new(separate.outputs["Green"], shader.inputs["Roughness"])
    tree.links.new(separate.outputs["Blue"], shader.inputs["Metallic"])
    return material


@awkward("glTF's metallic and roughness in one image: rough, not metallic")
def gltf_leather(folder: Path) -> None:
    stage()
    wall_of(_gltf(0.0, 0.95))


@awkward("glTF's metallic and roughness in one image: rough metal", words=("only mirrors reflect",))
def gltf_metal(folder: Path) -> None:
    stage()
    wall_of(_gltf(1.0, 0.6))


@awkward("glTF's occlusion in its group node")
def gltf_occlusion(folder: Path) -> None:
    stage()
    material = _gltf(0.0, 0.9)
    tree: Any = material.node_tree
    group = bpy.data.node_groups.new("glTF Material Output", "ShaderNodeTree")
    group.interface.new_socket("Occlusion", in_out="INPUT", socket_type="NodeSocketFloat")
    used = tree.nodes.new("ShaderNodeGroup")
    used.node_tree = group
    separate = next(item for item in tree.nodes if item.type == "SEPARATE_COLOR")
    tree.links.new(separate.outputs["Red"], used.inputs["Occlusion"])
    wall_of(material)


@awkward("a material whose output has no surface")
def no_surface(folder: Path) -> None:
    stage()
    material = bpy.data.materials.new("Nothing")
    tree: Any = material.node_tree
    tree.links.remove(output_of(tree).inputs["Surface"].links[0])
    wall_of(material)


@awkward("a slot without a material")
def empty_slot(folder: Path) -> None:
    stage()
    give("Red", None)


@awkward("a material without any node")
def no_nodes(folder: Path) -> None:
    stage()
    material = bpy.data.materials.new("Empty")
    material.node_tree.nodes.clear()
    wall_of(material)


@awkward("two outputs, of which one is for another engine")
def two_outputs(folder: Path) -> None:
    stage()
    material = matte("Two", (0.8, 0.1, 0.1))
    tree: Any = material.node_tree
    output_of(tree).target = "EEVEE"
    other = tree.nodes.new("ShaderNodeOutputMaterial")
    other.target = "CYCLES"
    shader = node(tree, "BsdfDiffuse", Color=(0.1, 0.7, 0.2, 1.0))
    tree.links.new(shader.outputs[0], other.inputs["Surface"])
    wall_of(material)


@awkward("a fog cube: a volume without a surface", words=("volume", "Fog"))
def fog_cube(folder: Path) -> None:
    stage()
    material = bpy.data.materials.new("Fog")
    tree: Any = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    fog = node(tree, "VolumeScatter", Density=1.5)
    tree.links.new(fog.outputs[0], output.inputs["Volume"])
    give("Red", material)


@awkward("a surface and a volume in one material", words=("volume", "Smoke", "glass", "refract", "transmi"))
def glass_with_volume(folder: Path) -> None:
    stage()
    material = surface("Smoke", "BsdfRefraction", Color=(1.0, 1.0, 1.0, 1.0), Roughness=0.0, IOR=1.0)
    tree: Any = material.node_tree
    absorb = node(tree, "VolumeAbsorption", Color=(0.9, 0.2, 0.1, 1.0), Density=2.0)
    tree.links.new(absorb.outputs[0], output_of(tree).inputs["Volume"])
    give("Red", material)


@awkward("a Principled volume that glows", words=("volume", "Fire"))
def fire_volume(folder: Path) -> None:
    stage()
    material = bpy.data.materials.new("Fire")
    tree: Any = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    fire = node(tree, "VolumePrincipled", Density=0.5, Emission_Strength=2.0, Emission_Color=(1.0, 0.4, 0.1, 1.0))
    tree.links.new(fire.outputs[0], output.inputs["Volume"])
    give("Red", material)


@awkward("glass")
def glass(folder: Path) -> None:
    stage()
    give("Blue", surface("Glass", "BsdfGlass", Color=(0.9, 1.0, 0.9, 1.0), Roughness=0.0, IOR=1.45))


@awkward("glass by Principled's transmission")
def principled_transmission(folder: Path) -> None:
    stage()
    material = principled("Clear", (0.95, 0.95, 0.95), roughness=0.0)
    principled_node(material).inputs["Transmission Weight"].default_value = 1.0
    give("Blue", material)


@awkward("a wall of glass before the mirror")
def window_pane(folder: Path) -> None:
    stage()
    add_sheet(
        "Pane",
        (0.0, -2.6, 1.0),
        (3.0, 2.0),
        surface("Glass", "BsdfGlass", Color=(1.0, 0.6, 0.5, 1.0), Roughness=0.0, IOR=1.0),
        (np.pi / 2.0, 0.0, 0.0),
    )


@awkward("a transparent shader of one color", words=("transparen",))
def transparent(folder: Path) -> None:
    stage()
    give("Red", surface("Foil", "BsdfTransparent", Color=(0.2, 0.9, 0.3, 1.0)))


@awkward("Principled's alpha of one half", words=("alpha", "transparen"))
def alpha_half(folder: Path) -> None:
    stage()
    material = matte("Half", (0.8, 0.1, 0.1))
    principled_node(material).inputs["Alpha"].default_value = 0.5
    give("Red", material)


@awkward("Principled's alpha of zero")
def alpha_zero(folder: Path) -> None:
    stage()
    material = matte("None", (0.8, 0.1, 0.1))
    principled_node(material).inputs["Alpha"].default_value = 0.0
    give("Red", material)


@awkward("a mix of transparent and diffuse by a checker", words=("transparen", "Checker", "alpha"))
def alpha_checker(folder: Path) -> None:
    stage()
    material = matte("Grid", (0.8, 0.1, 0.1))
    tree: Any = material.node_tree
    checker = node(tree, "TexChecker", Scale=6.0)
    tree.links.new(checker.outputs["Fac"], principled_node(material).inputs["Alpha"])
    wall_of(material)
