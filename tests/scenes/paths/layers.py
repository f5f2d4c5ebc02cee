# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers of one material, and several materials of one object."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..awkward.stage import find, node, picture, principled_node
from .metals import LAYERED, LIMITS
from .registry import OBJECT, path_scene
from .stage import metal, of_principled, put_ball, put_teapot, room

RED = (0.45, 0.03, 0.03, 1.0)


@path_scene("a clear coat over a rough color", LAYERED, layered=True)
def coat_on_color() -> None:
    room(soft=True)
    put_ball(of_principled("Lacquer", Base_Color=RED, Roughness=0.6, Coat_Weight=1.0, Coat_Roughness=0.05))


@path_scene("a clear coat over rough metal", LIMITS[0.5])
def coat_on_metal() -> None:
    room()
    put_ball(metal(0.5, (0.9, 0.5, 0.2), Coat_Weight=1.0, Coat_Roughness=0.0))


@path_scene("a tinted coat of roughness 0.2 and a high index over metal", LIMITS[0.3])
def coat_tinted() -> None:
    room()
    tint = (0.3, 0.6, 1.0, 1.0)
    put_ball(metal(0.3, Coat_Weight=1.0, Coat_Roughness=0.2, Coat_IOR=1.8, Coat_Tint=tint))


@path_scene("half a coat over a color", LAYERED, layered=True)
def coat_half() -> None:
    room(soft=True)
    put_ball(of_principled("Lacquer", Base_Color=RED, Roughness=0.3, Coat_Weight=0.5, Coat_Roughness=0.1))


@path_scene("half metallic, roughness 0.3", LAYERED, layered=True)
def half_metallic() -> None:
    room(soft=True)
    put_ball(of_principled("Half", Base_Color=(0.8, 0.5, 0.2, 1.0), Metallic=0.5, Roughness=0.3))


def gltf_image(size: int = 64) -> Any:
    """Non-color: green is roughness from 0.1 to 0.6 in stripes, blue metallic in quarters."""
    pixels = np.ones((size, size, 4), np.float32)
    index = np.arange(size)
    pixels[..., 1] = np.where((index * 8 // size) % 2 == 0, 0.1, 0.6)[None]
    pixels[..., 2] = np.where((index * 4 // size) % 2 == 0, 1.0, 0.0)[:, None]
    image = picture("Metallic Roughness", pixels)
    image.colorspace_settings.name = "Non-Color"
    return image


@path_scene("metallic and roughness by an image, as glTF has them", LAYERED, layered=True)
def gltf() -> None:
    room(soft=True)
    material = of_principled("glTF", Base_Color=(0.85, 0.6, 0.3, 1.0))
    tree: Any = material.node_tree
    texture, separate = tree.nodes.new("ShaderNodeTexImage"), node(tree, "SeparateColor")
    texture.image = gltf_image()
    tree.links.new(texture.outputs["Color"], separate.inputs[0])
    tree.links.new(separate.outputs["Green"], principled_node(material).inputs["Roughness"])
    tree.links.new(separate.outputs["Blue"], principled_node(material).inputs["Metallic"])
    put_ball(material)


@path_scene("roughness by an image of its own", LIMITS[0.3])
def roughness_image() -> None:
    room()
    material = metal(0.5)
    tree: Any = material.node_tree
    pixels = np.ones((32, 32, 4), np.float32)
    pixels[..., :3] = np.linspace(0.0, 0.6, 32)[None, :, None]
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = picture("Roughness", pixels)
    texture.image.colorspace_settings.name = "Non-Color"
    tree.links.new(texture.outputs["Color"], principled_node(material).inputs["Roughness"])
    put_ball(material)


@path_scene("two slots: rough metal and a matt color", LAYERED, layered=True)
def slots() -> None:
    room(soft=True)
    put_ball(metal(0.2))
    mesh = find(OBJECT).data
    mesh.materials.append(of_principled("Paint", Base_Color=RED, Roughness=1.0, Specular_IOR_Level=0.0))
    mesh.materials.append(of_principled("Brass", Base_Color=(0.9, 0.6, 0.2, 1.0), Metallic=1.0, Roughness=0.0))
    mesh.polygons.foreach_set("material_index", [i // 96 // 8 % 3 for i in range(len(mesh.polygons))])


@path_scene("specular level and tint of a dielectric", LAYERED, layered=True)
def specular_tint() -> None:
    room(soft=True)
    values = {"Roughness": 0.2, "Specular_IOR_Level": 0.9, "Specular_Tint": (1.0, 0.5, 0.2, 1.0), "IOR": 1.8}
    put_ball(of_principled("Tinted", Base_Color=(0.05, 0.1, 0.3, 1.0), **values))


@path_scene("a metal with tinted edges", LIMITS[0.3])
def edge_tint() -> None:
    room()
    put_ball(metal(0.2, (0.9, 0.6, 0.2), Specular_Tint=(0.2, 0.6, 1.0, 1.0)))


@path_scene("a thin film on metal", LIMITS[0.1])
def thin_film() -> None:
    room()
    put_ball(metal(0.1, Thin_Film_Thickness=420.0, Thin_Film_IOR=1.6))


@path_scene("lacquer on a pot")
def coat_teapot() -> None:
    room(soft=True)
    put_teapot(of_principled("Lacquer", Base_Color=RED, Roughness=0.4, Coat_Weight=1.0, Coat_Roughness=0.03))
