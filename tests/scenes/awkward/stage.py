# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What most awkward scenes have in common: a mirror ball on a dark floor, three things beside it, a sun and a gray sky.

Few and dark surfaces keep the light small that goes from one to another: the pictures are about something else.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo.data_blocks import (
    add_camera,
    add_object,
    add_sun,
    emitter,
    mirror,
    principled,
    set_world_color,
    start_empty_scene,
)
from curvrefl.curvrefl_addon.demo.shapes import Shape, ball, box, plane

from .registry import MIRROR

SIZE = (160, 120)
DARK = (0.02, 0.02, 0.03)
"""A sky that lamps are seen in"""
SKY = (0.45, 0.56, 0.74)
EYE = (0.0, -4.6, 2.1)
type Color = tuple[float, float, float]
type Place = Sequence[float]


def stage(sky: Color | None = SKY, sun: float = 3.0, with_mirror: bool = True, things: bool = True) -> bpy.types.Scene:
    """The usual scene, in place of the open file: Mirror (radius 1, at 0, 0, 1), Floor, Red, Blue, Green, Sun."""
    scene: Any = start_empty_scene(*SIZE)
    # Light that mirrors throw on other things is light from one surface to another.
    scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = False
    if sky is not None:
        set_world_color(sky)
    if sun:
        add_sun((-0.5, -0.7, 0.9), sun)
    floor = add_object("Floor", plane((12.0, 12.0), (12, 12)), matte("Floor", (0.03, 0.03, 0.04)))
    floor.data.materials.append(matte("Tiles", (0.22, 0.2, 0.16)))
    floor.data.polygons.foreach_set("material_index", [(i + i // 12) % 2 for i in range(144)])
    if with_mirror:
        add_ball(MIRROR, (0.0, 0.0, 1.0), 1.0, mirror("Chrome"))
    if things:
        add_box("Red", (1.9, -0.6, 0.5), 1.0, matte("Red", (0.7, 0.05, 0.04)))
        add_ball("Blue", (-1.8, -0.9, 0.5), 0.5, matte("Blue", (0.05, 0.12, 0.6)))
        add_box("Green", (0.5, -1.9, 0.25), 0.5, matte("Green", (0.06, 0.45, 0.1)))
    add_camera(EYE, (0.0, 0.0, 0.7), lens=42.0)
    return scene


def matte(name: str, color: Color) -> bpy.types.Material:
    """A rough material without a gleam."""
    material = principled(name, color, roughness=1.0)
    principled_node(material).inputs["Specular IOR Level"].default_value = 0.0
    return material


def principled_node(material: bpy.types.Material) -> Any:
    return next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")


def add_ball(
    name: str, place: Place, radius: float, material: bpy.types.Material | None, segments: int = 48
) -> bpy.types.Object:
    """A smooth ball with UVs."""
    return add_object(name, ball(radius, segments), material, smooth=True, location=place)


def add_box(
    name: str, place: Place, size: float | Place, material: bpy.types.Material | None, turn: float = 0.3
) -> bpy.types.Object:
    """A box, turned about Z."""
    sides = (size, size, size) if isinstance(size, (int, float)) else size
    return add_object(name, box(sides), material, location=place, rotation=(0.0, 0.0, turn))


def add_sheet(
    name: str,
    place: Place,
    size: Place,
    material: bpy.types.Material | None,
    rotation: Place = (0.0, 0.0, 0.0),
    cells: tuple[int, int] = (1, 1),
) -> bpy.types.Object:
    """A rectangle with UVs, level unless turned."""
    return add_object(name, plane(size, cells), material, location=place, rotation=rotation)


def add_lamp(kind: str, place: Place, energy: float, target: Place = (0.0, 0.0, 0.5), **properties: Any) -> Any:
    """A lamp object called as its kind, that shines at the target; `properties` are its data's."""
    from mathutils import Vector

    lamp = bpy.data.lights.new(kind.capitalize(), kind)
    lamp.energy = energy
    for name, value in properties.items():
        setattr(lamp, name, value)
    thing = bpy.data.objects.new(kind.capitalize(), lamp)
    thing.location = place
    thing.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)
    return thing


def wall_of(material: bpy.types.Material) -> bpy.types.Object:
    """A wall behind the camera, for the mirror, and a ball for the eye: Wall, which is returned, and Sample.

    They are bright and large: the light that goes on from them is another matter.
    """
    bpy.context.scene.cycles.diffuse_bounces = 0
    add_ball("Sample", (-1.2, -1.9, 0.55), 0.55, material)
    return add_sheet("Wall", (0.0, -5.5, 2.0), (6.0, 4.0), material, (-np.pi / 2.0, 0.0, np.pi))


def link(data: Any, name: str, place: Place = (0.0, 0.0, 0.0)) -> Any:
    """An object of a data-block (or of none), in the scene."""
    thing = bpy.data.objects.new(name, data)
    thing.location = place
    bpy.context.scene.collection.objects.link(thing)
    return thing


def find(name: str) -> Any:
    """An object by name, as a value whose type nobody asks for."""
    return bpy.data.objects[name]


def node(tree: Any, kind: str, **inputs: Any) -> Any:
    """A new node of a tree with values for sockets, by name (spaces as _)."""
    made = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in inputs.items():
        made.inputs[name.replace("_", " ")].default_value = value
    return made


def surface(name: str, kind: str, **inputs: Any) -> bpy.types.Material:
    """A material of one shader node straight into the output."""
    material = bpy.data.materials.new(name)
    tree: Any = material.node_tree
    tree.nodes.clear()
    shader = node(tree, kind, **inputs)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def joined(name: str, kind: str, first: tuple[str, dict[str, Any]], second: tuple[str, dict[str, Any]]) -> Any:
    """A material of two shader nodes, each a kind and values, in a MixShader or AddShader: (it, its tree, the join)."""
    material = bpy.data.materials.new(name)
    tree: Any = material.node_tree
    tree.nodes.clear()
    both = node(tree, kind)
    for socket, (shader, inputs) in zip(list(both.inputs)[-2:], (first, second), strict=True):
        tree.links.new(node(tree, shader, **inputs).outputs[0], socket)
    tree.links.new(both.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material, tree, both


def output_of(tree: Any) -> Any:
    return next(item for item in tree.nodes if item.type.startswith("OUTPUT"))


def give(name: str, material: bpy.types.Material) -> None:
    """The object's first slot gets this material."""
    find(name).data.materials[0] = material


def world_tree() -> Any:
    """The node tree of the scene's world, and its Background node."""
    tree = bpy.context.scene.world.node_tree
    return tree, next(item for item in tree.nodes if item.type == "BACKGROUND")


def picture(name: str, pixels: Any, alpha: bool = False, is_float: bool = False) -> bpy.types.Image:
    """A packed image of (height, width, 4) values."""
    array = np.ascontiguousarray(pixels, np.float32)
    image: Any = bpy.data.images.new(name, array.shape[1], array.shape[0], alpha=alpha, float_buffer=is_float)
    image.pixels.foreach_set(array.ravel())
    image.update()
    image.pack()
    return image


def stripes(first: Color = (0.9, 0.8, 0.1), second: Color = (0.1, 0.1, 0.5), size: int = 64, count: int = 4) -> Any:
    """(size, size, 4): upright stripes with a red lower quarter, so that turns and flips show."""
    pixels = np.ones((size, size, 4), np.float32)
    odd = (np.arange(size) * count // size) % 2 == 1
    pixels[:, ~odd, :3] = first
    pixels[:, odd, :3] = second
    pixels[: size // 4, :, :3] = (0.8, 0.1, 0.1)
    return pixels


def textured(name: str, image: bpy.types.Image) -> tuple[Any, Any, Any]:
    """A matte material of an image: (material, its tree, its image node)."""
    material = matte(name, (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs["Color"], principled_node(material).inputs["Base Color"])
    return material, tree, texture


def mesh_of(name: str, positions: Any, polygons: Any, material: bpy.types.Material | None, smooth: bool = False) -> Any:
    """An object of plain arrays."""
    shape = Shape(np.asarray(positions, float), tuple(tuple(p) for p in polygons))
    return add_object(name, shape, material, smooth=smooth)


__all__ = [
    "DARK",
    "add_ball",
    "add_box",
    "add_lamp",
    "add_object",
    "add_sheet",
    "ball",
    "box",
    "bpy",
    "emitter",
    "find",
    "give",
    "joined",
    "link",
    "matte",
    "mesh_of",
    "mirror",
    "node",
    "output_of",
    "picture",
    "plane",
    "principled",
    "principled_node",
    "stage",
    "stripes",
    "surface",
    "textured",
    "wall_of",
    "world_tree",
]
