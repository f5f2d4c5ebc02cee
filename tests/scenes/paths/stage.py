# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The room of most scenes of paths: two textured walls and a floor, an area lamp, a dim world; and shapes in it.

What is diffuse throws no light on, as in direct light; mirrors and glass follow each other eight times.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo import paint
from curvrefl.curvrefl_addon.demo.data_blocks import (
    add_camera,
    add_object,
    packed_image,
    principled,
    set_world_color,
    start_empty_scene,
)
from curvrefl.curvrefl_addon.demo.shapes import Shape, ball, box, joined, plane, tube, turned_profile

from ..awkward.stage import add_lamp, matte, node, output_of, principled_node
from .registry import OBJECT

SIZE = (160, 120)
MOST_BOUNCES = 8
EYE = (0.0, -5.2, 1.7)
type Place = Sequence[float]


def empty(world: tuple[float, float, float]) -> Any:
    """A scene of this world and nothing else, in place of the open file; returns it."""
    scene: Any = start_empty_scene(*SIZE)
    cycles = scene.cycles
    cycles.max_bounces = cycles.glossy_bounces = cycles.transmission_bounces = MOST_BOUNCES
    cycles.transparent_max_bounces = MOST_BOUNCES
    cycles.diffuse_bounces = cycles.volume_bounces = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.use_adaptive_sampling = False
    set_world_color(world)
    return scene


def room(lens: float = 62.0, things: bool = True, target: Place = (0.0, 0.0, 1.0), soft: bool = False) -> Any:
    """Floor, two walls, four things of color; what stands in the middle is at (0, 0, 0) and 2 high.

    Matt things are lit by a sun without shadows, which every renderer does exactly: how soft light falls on them is
    another matter than paths. Mirrors see an area lamp and a gray sky besides. `soft`: these light matt things, too.
    """
    scene = empty((0.3, 0.36, 0.47))
    scene.world.cycles_visibility.diffuse = soft
    floor = packed_image("Tiles", paint.chequer(256, 8, (0.82, 0.78, 0.7), (0.35, 0.4, 0.46)))
    add_object("Floor", plane((9.0, 9.0), (4, 4)), _painted("Tiles", floor), location=(0.0, -0.5, 0.0))
    wood = packed_image("Planks", paint.planks(256, 256, 8))
    wall = plane((9.0, 5.0))
    add_object("Back", wall, _painted("Planks", wood), location=(0.0, 3.2, 2.5), rotation=(np.pi / 2.0, 0.0, 0.0))
    bands = packed_image("Bands", paint.chequer(256, 6, (0.75, 0.25, 0.16), (0.9, 0.85, 0.6)))
    side = plane((9.0, 5.0))
    add_object(
        "Side", side, _painted("Bands", bands), location=(-3.4, -0.5, 2.5), rotation=(np.pi / 2.0, 0.0, np.pi / 2.0)
    )
    if things:
        add_object("Green", box((0.8, 0.8, 0.8)), matte("Green", (0.1, 0.5, 0.12)), location=(1.9, 0.9, 0.4))
        add_object("Blue", ball(0.45, 32), matte("Blue", (0.06, 0.15, 0.65)), True, (-1.7, -1.1, 0.45))
        add_object("Yellow", box((0.5, 0.5, 1.4)), matte("Yellow", (0.8, 0.6, 0.05)), location=(1.4, -1.9, 0.7))
        add_object("Red", ball(0.5, 32), matte("Red", (0.7, 0.05, 0.04)), True, (-1.3, 1.8, 0.5))
    lamp = add_lamp("AREA", (1.6, -2.6, 4.2), 70.0, target=(0.0, 0.0, 0.8), size=2.2)
    lamp.visible_diffuse = soft
    add_lamp("SUN", (0.5, -0.8, 0.9), 0.7 if soft else 3.2, target=(0.0, 0.0, 0.0), angle=0.0, use_shadow=False)
    add_camera(EYE, target, lens=lens)
    return scene


def _painted(name: str, image: bpy.types.Image) -> bpy.types.Material:
    material = principled(name, roughness=1.0, image=image)
    principled_node(material).inputs["Specular IOR Level"].default_value = 0.0
    return material


def of_principled(name: str, **inputs: Any) -> bpy.types.Material:
    """A Principled BSDF with values for sockets, by name (spaces as _)."""
    material = principled(name, (0.9, 0.9, 0.9))
    for socket, value in inputs.items():
        principled_node(material).inputs[socket.replace("_", " ")].default_value = value
    return material


def metal(roughness: float, color: tuple[float, float, float] = (0.92, 0.9, 0.86), **inputs: Any) -> bpy.types.Material:
    return of_principled("Metal", Base_Color=(*color, 1.0), Metallic=1.0, Roughness=roughness, **inputs)


def clear(ior: float = 1.45, roughness: float = 0.0, **inputs: Any) -> bpy.types.Material:
    """Glass by the Principled BSDF's transmission."""
    values = {"Base_Color": (1.0, 1.0, 1.0, 1.0), "Roughness": roughness, "IOR": ior, "Transmission_Weight": 1.0}
    return of_principled("Glass", **(values | inputs))


def add_absorption(material: bpy.types.Material, color: tuple[float, float, float], density: float) -> None:
    """A volume that takes away (1 - color) density of the light per meter."""
    tree: Any = material.node_tree
    volume = node(tree, "VolumeAbsorption", Color=(*color, 1.0), Density=density)
    tree.links.new(volume.outputs[0], output_of(tree).inputs["Volume"])


def put_ball(
    material: bpy.types.Material,
    name: str = OBJECT,
    place: Place = (0.0, 0.0, 1.0),
    radius: float = 1.0,
    segments: int = 96,
) -> bpy.types.Object:
    return add_object(name, ball(radius, segments), material, smooth=True, location=place)


def put_box(
    material: bpy.types.Material, size: Place, place: Place, name: str = OBJECT, turn: float = 0.0
) -> bpy.types.Object:
    return add_object(name, box(size), material, location=place, rotation=(0.0, 0.0, turn))


def put_teapot(
    material: bpy.types.Material, name: str = OBJECT, place: Place = (0.0, 0.0, 0.0), size: float = 1.0
) -> bpy.types.Object:
    """A pot with a lid, a spout and a handle, hollow places between them; each part is closed by itself."""
    return add_object(name, _scaled(_teapot(), size), material, smooth=True, location=place)


def _teapot() -> Shape:
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 33)
    body = [(0.95 * float(np.cos(a)) ** 0.8, 0.8 + 0.75 * float(np.sin(a))) for a in angle]
    body[0], body[-1] = (0.0, body[0][1]), (0.0, body[-1][1])
    knob = [(0.16 * float(np.cos(a)), 1.68 + 0.16 * float(np.sin(a))) for a in angle]
    knob[0], knob[-1] = (0.0, knob[0][1]), (0.0, knob[-1][1])
    t = np.linspace(0.0, 1.0, 25)
    spout = np.stack([0.7 + 0.75 * t, 0.0 * t, 0.55 + 0.85 * t**1.8], -1)
    turn = np.linspace(0.32 * np.pi, -0.36 * np.pi, 29)
    handle = np.stack([-0.75 - 0.6 * np.cos(turn), 0.0 * turn, 0.85 + 0.5 * np.sin(turn)], -1)
    return joined(
        turned_profile(body, 64),
        turned_profile(knob, 32),
        tube(spout, 0.22 - 0.12 * t, 24, (0.0, 1.0, 0.0)),
        tube(handle, np.full(29, 0.09), 20, (0.0, 1.0, 0.0)),
    )


def put_wine_glass(material: bpy.types.Material, drink: bpy.types.Material | None, name: str = OBJECT) -> None:
    """A bowl of two walls on a stem; a drink reaches halfway into its wall."""
    angle = np.linspace(0.0, 0.62 * np.pi, 25)
    outer = [(0.8 * float(np.sin(a)), 1.35 - 0.75 * float(np.cos(a))) for a in angle]
    inner = [(0.74 * float(np.sin(a)), 1.35 - 0.68 * float(np.cos(a))) for a in angle]
    foot = [(0.0, 0.0), (0.55, 0.0), (0.56, 0.03), (0.4, 0.07), (0.12, 0.12), (0.07, 0.25), (0.07, 0.5), (0.12, 0.6)]
    bowl = [point for point in outer if point[0] > 0.2]
    profile = [*foot, *bowl, *inner[::-1]]
    profile[-1] = (0.0, profile[-1][1])
    stand = (0.0, 0.0, 0.02)
    add_object(name, turned_profile(profile, 96), material, smooth=True, location=stand)
    if drink is not None:
        half = [(0.77 * float(np.sin(a)), 1.35 - 0.715 * float(np.cos(a))) for a in angle if a < 0.5 * np.pi]
        half[0] = (0.0, half[0][1])
        level = half[-1][1]
        surface = [(half[-1][0] - 0.004, level + 0.002), (0.0, level + 0.002)]
        thing = add_object("Drink", turned_profile([*half, *surface], 96), drink, smooth=True, location=stand)
        thing.data.set_sharp_from_angle(angle=0.6)


def put_lens(material: bpy.types.Material, place: Place, radius: float, bulge: float, name: str = OBJECT) -> None:
    """A round lens that faces the camera: two caps, each rising `bulge` from the rim's plane."""
    curve = (radius * radius + bulge * bulge) / (2.0 * bulge)
    reach = float(np.arcsin(radius / curve))
    angle = np.linspace(0.0, reach, 33)
    low = [(curve * float(np.sin(a)), curve - bulge - curve * float(np.cos(a))) for a in angle]
    low[0] = (0.0, -bulge)
    profile = [*low, *[(r, -z) for r, z in low[::-1][1:]]]
    thing = add_object(name, turned_profile(profile, 96), material, smooth=True, location=place)
    thing.rotation_euler = (np.pi / 2.0, 0.0, 0.0)
    thing.data.set_sharp_from_angle(angle=0.6)


def put_suzanne(material: bpy.types.Material, name: str = OBJECT, size: float = 1.0) -> Any:
    """Blender's monkey, subdivided, that looks at the camera."""
    bpy.ops.mesh.primitive_monkey_add(size=2.0 * size, location=(0.0, 0.0, 1.0))
    thing: Any = bpy.context.object
    thing.name = name
    thing.modifiers.new("Subdivision", "SUBSURF").render_levels = 2
    thing.modifiers[0].levels = 2
    thing.data.materials.append(material)
    thing.data.shade_smooth()
    return thing


def _scaled(shape: Shape, size: float) -> Shape:
    return Shape(shape.positions * size, shape.polygons, shape.uv)
