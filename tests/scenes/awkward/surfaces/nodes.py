# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that make colors of what mirrors show."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import awkward
from ..stage import (
    bpy,
    find,
    matte,
    node,
    picture,
    principled_node,
    stage,
    textured,
    wall_of,
)


def _colored(kind: str, output: str = "Color", **inputs: Any) -> None:
    """A wall whose color is a node's."""
    stage()
    material = matte("Patterned", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    made = node(tree, kind, **inputs)
    tree.links.new(made.outputs[output], principled_node(material).inputs["Base Color"])
    wall_of(material)


@awkward("checker texture", words=("checker",))
def texture_checker(folder: Path) -> None:
    _colored("TexChecker", Color1=(0.9, 0.1, 0.1, 1.0), Color2=(0.1, 0.1, 0.8, 1.0), Scale=4.0)


@awkward("noise texture", words=("noise",))
def texture_noise(folder: Path) -> None:
    _colored("TexNoise", Scale=3.0)


@awkward("Voronoi texture", words=("voronoi",))
def texture_voronoi(folder: Path) -> None:
    _colored("TexVoronoi", Scale=4.0)


@awkward("bricks", words=("brick",))
def texture_brick(folder: Path) -> None:
    _colored("TexBrick", Scale=3.0)


@awkward("gradient texture", words=("gradient",))
def texture_gradient(folder: Path) -> None:
    _colored("TexGradient")


@awkward("magic texture", words=("magic",))
def texture_magic(folder: Path) -> None:
    _colored("TexMagic", Scale=3.0)


@awkward("the object's own color", words=("object info",))
def object_info_color(folder: Path) -> None:
    _colored("ObjectInfo")
    find("Wall").color, find("Sample").color = (0.9, 0.2, 0.1, 1.0), (0.1, 0.3, 0.9, 1.0)


@awkward("a random number for each object", words=("object info", "random"))
def object_info_random(folder: Path) -> None:
    _colored("ObjectInfo", "Random")


@awkward("what a ray is: dark to the camera, bright in mirrors", words=("light path",))
def light_path(folder: Path) -> None:
    _colored("LightPath", "Is Glossy Ray")


@awkward("ambient occlusion as a color", words=("ambient occlusion",))
def ambient_occlusion(folder: Path) -> None:
    _colored("AmbientOcclusion")


@awkward("blackbody color", words=("blackbody",))
def blackbody(folder: Path) -> None:
    _colored("Blackbody", Temperature=2500.0)


@awkward("wavelength as a color", words=("wavelength",))
def wavelength(folder: Path) -> None:
    _colored("Wavelength", Wavelength=520.0)


def _ramped(output: str, stops: list[tuple[float, tuple[float, ...]]]) -> None:
    stage()
    material = matte("Ramped", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    ramp = node(tree, "ValToRGB", Fac=0.7)
    for element, (place, color) in zip(ramp.color_ramp.elements, stops, strict=True):
        element.position, element.color = place, color
    tree.links.new(ramp.outputs[output], principled_node(material).inputs["Base Color"])
    wall_of(material)


@awkward("the color of a ramp at a number")
def ramp_color(folder: Path) -> None:
    _ramped("Color", [(0.2, (0.9, 0.1, 0.1, 1.0)), (0.9, (0.1, 0.1, 0.9, 1.0))])


@awkward("the alpha of a ramp as a color")
def ramp_alpha(folder: Path) -> None:
    _ramped("Alpha", [(0.2, (0.9, 0.1, 0.1, 1.0)), (0.9, (0.9, 0.9, 0.9, 0.1))])


def _mixed(blend: str, factor: float, clamp: bool) -> None:
    stage()
    material = matte("Mix", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    mix = node(tree, "Mix")
    mix.data_type, mix.blend_type, mix.clamp_result, mix.clamp_factor = "RGBA", blend, clamp, False
    mix.inputs[0].default_value = factor
    mix.inputs[6].default_value, mix.inputs[7].default_value = (0.9, 0.5, 0.1, 1.0), (0.6, 0.9, 0.7, 1.0)
    tree.links.new(mix.outputs[2], principled_node(material).inputs["Emission Color"])
    principled_node(material).inputs["Emission Strength"].default_value = 0.6
    principled_node(material).inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    wall_of(material)


@awkward("Mix by addition, with its result clamped")
def mix_clamp_result(folder: Path) -> None:
    _mixed("ADD", 1.0, True)


@awkward("Mix by addition, over 1", words=("emission",))
def mix_over_one(folder: Path) -> None:
    _mixed("ADD", 1.0, False)


@awkward("Mix by color dodge", words=("mix", "dodge"))
def mix_dodge(folder: Path) -> None:
    _mixed("DODGE", 0.7, False)


@awkward("Mix with a factor of two", words=("emission",))
def mix_factor_two(folder: Path) -> None:
    _mixed("MIX", 2.0, False)


@awkward("hue and saturation", words=("hue",))
def hue_saturation(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Hue", picture("Orange", np.full((4, 4, 4), (0.9, 0.5, 0.1, 1.0))))
    change = node(tree, "HueSaturation", Hue=0.8, Saturation=1.4)
    tree.links.new(texture.outputs[0], change.inputs["Color"])
    tree.links.new(change.outputs[0], principled_node(material).inputs["Base Color"])
    wall_of(material)


@awkward("a node group in a node group")
def nested_groups(folder: Path) -> None:
    stage()
    groups = []
    for number in range(2):
        group: Any = bpy.data.node_groups.new(f"Group {number}", "ShaderNodeTree")
        group.interface.new_socket("Color", in_out="INPUT", socket_type="NodeSocketColor")
        group.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
        source, output = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
        if groups:
            inner = group.nodes.new("ShaderNodeGroup")
            inner.node_tree = groups[0]
        else:
            inner = node(group, "Invert")
        tree_in = inner.inputs["Color"]
        group.links.new(source.outputs[0], tree_in)
        group.links.new(inner.outputs[0], output.inputs[0])
        groups.append(group)
    material = matte("Grouped", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    used = tree.nodes.new("ShaderNodeGroup")
    used.node_tree = groups[1]
    used.inputs["Color"].default_value = (0.1, 0.8, 0.9, 1.0)
    tree.links.new(used.outputs[0], principled_node(material).inputs["Base Color"])
    wall_of(material)


@awkward("a muted node, a reroute, and frames")
def muted_nodes(folder: Path) -> None:
    stage()
    material = matte("Muted", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    color, invert = node(tree, "RGB"), node(tree, "Invert")
    color.outputs[0].default_value = (0.9, 0.3, 0.1, 1.0)
    invert.mute = True
    reroute = tree.nodes.new("NodeReroute")
    tree.links.new(color.outputs[0], reroute.inputs[0])
    tree.links.new(reroute.outputs[0], invert.inputs["Color"])
    tree.links.new(invert.outputs[0], principled_node(material).inputs["Base Color"])
    wall_of(material)
