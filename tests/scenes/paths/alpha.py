# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaves, foils and visibility: what lets light go straight on."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo.data_blocks import add_object
from curvrefl.curvrefl_addon.demo.shapes import plane

from ..awkward.stage import find, joined, matte, node, picture, principled_node
from .metals import LIMITS
from .registry import OBJECT, add_scene, path_scene
from .stage import clear, metal, of_principled, put_ball, put_box, room

LEAVES = tuple(f"Leaf {number}" for number in range(10))
BOTH = (OBJECT, *LEAVES)
SHARP = (None, 0.03)


def leaf_image(size: int = 128, soft: float = 0.0) -> Any:
    """Four leaves, green, with alpha; `soft` is how wide their edges fade, as a share of the leaf."""
    y, x = np.mgrid[0:size, 0:size] / size
    u, v = (2.0 * x) % 1.0 - 0.5, (2.0 * y) % 1.0 - 0.5
    width = 0.22 * np.sqrt(np.clip(1.0 - (v / 0.46) ** 2, 0.0, 1.0)) * (1.0 + 0.25 * np.cos(30.0 * v))
    inside = width - np.abs(u)
    pixels = np.ones((size, size, 4), np.float32)
    vein = (np.abs(u) < 0.015) | (np.abs((v * 8.0 + 3.0 * np.abs(u)) % 1.0 - 0.5) < 0.06)
    pixels[..., :3] = np.where(vein[..., None], (0.55, 0.7, 0.25), (0.2, 0.5, 0.12))
    pixels[..., 3] = np.clip(0.5 + inside / max(2.0 * soft, 0.02), 0.0, 1.0)
    return picture("Leaves", pixels, alpha=True)


def _leaf(soft: float = 0.0) -> tuple[Any, Any, Any]:
    """A leaf's material, its tree and its image node."""
    material = matte("Leaf", (0.3, 0.6, 0.2))
    tree: Any = material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = leaf_image(soft=soft)
    tree.links.new(texture.outputs["Color"], principled_node(material).inputs["Base Color"])
    return material, tree, texture


def clipped_leaf() -> bpy.types.Material:
    """Alpha above one half is there."""
    material, tree, texture = _leaf()
    above = node(tree, "Math")
    above.operation = "GREATER_THAN"
    above.inputs[1].default_value = 0.5
    tree.links.new(texture.outputs["Alpha"], above.inputs[0])
    tree.links.new(above.outputs[0], principled_node(material).inputs["Alpha"])
    return material


def hashed_leaf() -> bpy.types.Material:
    """Alpha as it is, with wide soft edges."""
    material, tree, texture = _leaf(0.2)
    tree.links.new(texture.outputs["Alpha"], principled_node(material).inputs["Alpha"])
    return material


def mixed_leaf() -> bpy.types.Material:
    """Transparent and Diffuse, mixed by the image's alpha."""
    material = bpy.data.materials.new("Leaf")
    tree: Any = material.node_tree
    tree.nodes.clear()
    mix, texture = node(tree, "MixShader"), tree.nodes.new("ShaderNodeTexImage")
    texture.image = leaf_image()
    diffuse = node(tree, "BsdfDiffuse")
    tree.links.new(texture.outputs["Color"], diffuse.inputs["Color"])
    tree.links.new(texture.outputs["Alpha"], mix.inputs[0])
    tree.links.new(node(tree, "BsdfTransparent").outputs[0], mix.inputs[1])
    tree.links.new(diffuse.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def add_leaves(material: bpy.types.Material) -> None:
    """Ten cards in a ring round what stands in the middle, most of them where the eye sees them too."""
    for number, name in enumerate(LEAVES):
        angle = 0.5 + 2.0 * np.pi * number / len(LEAVES)
        place = (1.55 * np.cos(angle), 1.55 * np.sin(angle), 0.75 + 0.45 * (number % 3))
        turn = (np.pi / 2.0 + 0.3 * (number % 2), 0.2 * number, angle + 0.9)
        add_object(name, plane((1.0, 1.0)), material, location=place, rotation=turn)


def leaves(make: Callable[[], bpy.types.Material], roughness: float = 0.0) -> None:
    room(things=False)
    put_ball(metal(roughness), radius=0.9, place=(0.0, 0.0, 0.9))
    add_leaves(make())


add_scene(
    "leaves_clip", "leaves by clip, in a mirror, in shadows and seen", partial(leaves, clipped_leaf), SHARP, judged=BOTH
)
add_scene("leaves_hashed", "leaves with soft alpha", partial(leaves, hashed_leaf), SHARP, judged=BOTH)
add_scene("leaves_mixed", "leaves by Mix with Transparent", partial(leaves, mixed_leaf), SHARP, judged=BOTH)
add_scene("leaves_rough", "leaves by clip in a rough mirror", partial(leaves, clipped_leaf, 0.3), LIMITS[0.3])


def _foils(make: Callable[[], bpy.types.Material], radius: float = 0.9) -> None:
    room()
    material = make()
    put_ball(metal(0.0), radius=radius, place=(0.3, 0.2, radius))
    foil = plane((1.1, 1.6))
    add_object("Foil", foil, material, location=(-0.75, -1.2, 0.85), rotation=(np.pi / 2.0, 0.0, 0.4))


def _transparent(color: tuple[float, float, float]) -> bpy.types.Material:
    made = bpy.data.materials.new("Foil")
    tree: Any = made.node_tree
    tree.nodes.clear()
    shader = node(tree, "BsdfTransparent", Color=(*color, 1.0))
    tree.links.new(shader.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


@path_scene("a tinted foil: Transparent of a color", SHARP, judged=(OBJECT, "Foil"))
def foil_tinted() -> None:
    _foils(lambda: _transparent((0.9, 0.35, 0.25)))


@path_scene("a veil: Principled's alpha of 0.4", SHARP, judged=(OBJECT, "Foil"))
def veil() -> None:
    color = (0.2, 0.3, 0.8, 1.0)
    _foils(lambda: of_principled("Veil", Base_Color=color, Roughness=1.0, Specular_IOR_Level=0.0, Alpha=0.4))


def _half_foil() -> bpy.types.Material:
    paint = ("BsdfDiffuse", {"Color": (0.7, 0.6, 0.1, 1.0)})
    material, _, mix = joined("Foil", "MixShader", ("BsdfTransparent", {"Color": (0.5, 0.9, 0.6, 1.0)}), paint)
    mix.inputs[0].default_value = 0.4
    return material


@path_scene("a foil of Mix with a tinted Transparent by a number", SHARP, judged=(OBJECT, "Foil"))
def foil_mixed() -> None:
    _foils(_half_foil)


@path_scene("a chosen mirror of alpha 0.5", SHARP)
def mirror_half_there() -> None:
    room()
    put_ball(metal(0.0, Alpha=0.5))


@path_scene("a chosen rough mirror with holes by an image", LIMITS[0.3])
def mirror_with_holes() -> None:
    room()
    material = metal(0.2)
    tree: Any = material.node_tree
    pixels = np.ones((64, 64, 4), np.float32)
    y, x = np.mgrid[0:64, 0:64]
    pixels[..., :3] = (((x // 8 + y // 8) % 2) == 0)[..., None]
    texture, above = tree.nodes.new("ShaderNodeTexImage"), node(tree, "Math")
    texture.image = picture("Holes", pixels)
    texture.image.colorspace_settings.name = "Non-Color"
    above.operation, above.inputs[1].default_value = "GREATER_THAN", 0.5
    tree.links.new(texture.outputs["Color"], above.inputs[0])
    tree.links.new(above.outputs[0], principled_node(material).inputs["Alpha"])
    put_ball(material)


@path_scene("a window pane of Mix by Fresnel: Transparent and Glossy", SHARP)
def lazy_glass() -> None:
    room()
    gloss = ("BsdfAnisotropic", {"Color": (1.0, 1.0, 1.0, 1.0), "Roughness": 0.0})
    material, tree, mix = joined("Lazy", "MixShader", ("BsdfTransparent", {}), gloss)
    tree.links.new(node(tree, "Fresnel", IOR=1.5).outputs[0], mix.inputs[0])
    put_box(material, (2.2, 0.06, 1.8), (0.0, -0.6, 1.0), turn=0.4)


@path_scene("glass before things that transmission rays do not see", SHARP)
def unseen_through_glass() -> None:
    room()
    put_box(clear(1.5), (2.0, 0.06, 1.7), (0.0, -0.6, 0.9), turn=0.2)
    for name in ("Red", "Floor"):
        find(name).visible_transmission = False


@path_scene("a mirror before things that glossy rays do not see, glass before it", SHARP, judged=(OBJECT, "Pane"))
def unseen_in_mirror() -> None:
    room()
    put_ball(metal(0.0))
    put_box(clear(1.5), (1.6, 0.05, 1.4), (0.4, -1.8, 0.9), "Pane", 0.2)
    for name in ("Yellow", "Blue"):
        find(name).visible_glossy = False


def emitting_leaves() -> None:
    """Leaves by clip about a sharp mirror, all of one light each: a sample without noise tells what it has met."""
    leaves(clipped_leaf)
    for name in ("Area", "Sun"):
        bpy.data.objects.remove(find(name))
    materials = [material for material in bpy.data.materials if material.name != "Metal"]
    for number, material in enumerate(materials):
        tree: Any = material.node_tree
        shader = principled_node(material)
        color = shader.inputs["Base Color"]
        for link in list(color.links):
            tree.links.remove(link)
        color.default_value = (0.0, 0.0, 0.0, 1.0)
        light = [0.2 + 0.6 * (number >> channel & 1) for channel in range(3)]
        shader.inputs["Emission Color"].default_value = (*light, 1.0)
        shader.inputs["Emission Strength"].default_value = 1.0
