# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A kitchen, and a flight to the steel pot in its middle, until that fills the picture.

Lengths in meters, the floor at height 0; the pot stands on the island, whose top is `TOP` high.
"""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo import paint
from curvrefl.curvrefl_addon.demo.data_blocks import add_object, add_sun, emitter, looking, mirror, set_world_color
from curvrefl.curvrefl_addon.demo.materials import matte
from curvrefl.curvrefl_addon.demo.shapes import (
    Shape,
    ball,
    block,
    joined,
    projected,
    slide_to_contact,
    star_normals,
    star_shape,
    tube,
    turned_profile,
)
from curvrefl.curvrefl_addon.demo.table import book, smoothed
from curvrefl.curvrefl_addon.scene.arrays import Float64Array
from mathutils import Matrix

from .kitchen_walls import CEILING, add_back_row, add_room, add_wall_things
from .stage import fly, mark, start, through

POT = "Pot"
TOP = 0.92
WIDE, HIGH = 0.19, 0.125
"""Half the pot's width and height"""
MIDDLE = np.array([0.0, 0.0, TOP + HIGH])
GAP = 2e-4


def pot_radius(directions: Float64Array) -> Float64Array:
    """Distance (n,) of the pot from its middle along unit directions (n, 3): round, and flatter above and below."""
    x, y, z = np.abs(directions).T
    return ((np.hypot(x, y) / WIDE) ** 2.5 + (z / HIGH) ** 2.5) ** (-1.0 / 2.5)


def build() -> None:
    """Replace the open file by the film."""
    start()
    add_room()
    add_back_row()
    add_wall_things()
    _add_island()
    _add_things()
    _add_stools()
    mark(_add_pot())
    _add_light()
    eye = through(
        (1.55, -2.25, 1.85), (1.05, -1.6, 1.55), (0.5, -0.95, 1.25), (0.2, -0.45, 1.1), (0.085, -0.262, 1.066)
    )
    target = through((0.0, 0.3, 1.0), (0.0, 0.1, 1.02), (0.0, 0.0, 1.05), (0.01, 0.0, 1.055), (0.018, 0.0, 1.058))
    fly(eye, target, lens=36.0)


def _add_island() -> None:
    oak = paint.planks(512, 512, 5, seed=3)
    top = projected(block((-0.85, -0.48, TOP - 0.05), (0.85, 0.48, TOP), bevel=0.005), 0.8)
    add_object("Island top", top, matte("Beech", pixels=oak, roughness=0.7))
    cream = matte("Cream paint", (0.66, 0.6, 0.45), roughness=0.7)
    add_object("Island", block((-0.72, -0.22, 0.0), (0.72, 0.4, TOP - 0.051), bevel=0.006), cream)
    panels = [block((x - 0.21, -0.235, 0.12), (x + 0.21, -0.22, 0.8), bevel=0.005) for x in (-0.48, 0.0, 0.48)]
    add_object("Panels", joined(*panels), matte("Panels", (0.58, 0.52, 0.38), roughness=0.7))


def _add_pot() -> bpy.types.Object:
    """The mirror, and what of it is none: two grips that touch it, and a knob."""
    shape = star_shape(pot_radius, 40)
    directions = shape.positions / np.linalg.norm(shape.positions, axis=1, keepdims=True)
    normals = star_normals(pot_radius, directions)
    pot = add_object(POT, shape, mirror("Steel"), smooth=True, location=MIDDLE.tolist(), normals=normals)
    black = matte("Bakelite", (0.03, 0.024, 0.022), roughness=0.5)
    knob = [(0.0, 0.0), (0.012, 0.0), (0.01, 0.012), (0.024, 0.02), (0.026, 0.03), (0.018, 0.036), (0.0, 0.038)]
    where = (0.0, 0.0, TOP + 2.0 * HIGH + GAP)
    add_object("Knob", turned_profile(smoothed(knob, 3), 28), black, smooth=True, location=where)
    t = np.linspace(0.0, np.pi, 17)
    for number, side in enumerate((0.0, np.pi), 1):
        path = np.column_stack([0.27 + 0.05 * np.sin(t), 0.05 * np.cos(t), np.full(17, 0.03)])
        grip = tube(path, np.full(17, 0.009), 12, side=(0.0, 0.0, 1.0)).turned(0.35 + side)
        way = (-np.cos(0.35 + side), -np.sin(0.35 + side), 0.0)
        touching = slide_to_contact(grip, way, pot_radius, (0.0, 0.0, 0.0), GAP)
        add_object(f"Grip {number}", touching, black, smooth=True, location=MIDDLE.tolist())
    return pot


def _add_things() -> None:
    """What stands about the pot."""
    clay = matte("Earthenware", (0.6, 0.53, 0.4), roughness=0.7)
    bowl = [(0.0, 0.0), (0.05, 0.0), (0.052, 0.008), (0.09, 0.03), (0.115, 0.065), (0.112, 0.067), (0.085, 0.036)]
    bowl += [(0.045, 0.018), (0.0, 0.014)]
    add_object("Bowl", turned_profile(smoothed(bowl, 3), 32), clay, smooth=True, location=(-0.36, -0.12, TOP))
    orange, lemon = matte("Orange", (0.78, 0.25, 0.02), 0.6), matte("Lemon", (0.83, 0.6, 0.05), 0.6)
    places = ((-0.4, -0.15, 0.06), (-0.32, -0.15, 0.06), (-0.36, -0.08, 0.06), (-0.36, -0.125, 0.108))
    for number, (x, y, z) in enumerate(places, 1):
        fruit = orange if number % 2 else lemon
        add_object(f"Fruit {number}", ball(0.036, 20), fruit, smooth=True, location=(x, y, TOP + z))
    apple = star_shape(_apple, 8)
    for number, (x, y, turn) in enumerate(((0.22, -0.24, 0.4), (0.31, -0.19, 2.0)), 1):
        red = matte(f"Apple {number}", ((0.5, 0.04, 0.03), (0.36, 0.45, 0.06))[number - 1], 0.5)
        add_object(f"Apple {number}", apple.turned(turn), red, smooth=True, location=(x, y, TOP + 0.034))
    bottle = [(0.0, 0.0), (0.036, 0.0), (0.038, 0.006), (0.038, 0.15), (0.03, 0.19), (0.013, 0.225), (0.013, 0.28)]
    bottle += [(0.016, 0.282), (0.016, 0.3), (0.0, 0.3)]
    green = matte("Bottle", (0.03, 0.13, 0.05), roughness=0.4)
    add_object("Bottle", turned_profile(smoothed(bottle, 2), 24), green, smooth=True, location=(0.42, 0.16, TOP))
    mill = [(0.0, 0.0), (0.03, 0.0), (0.03, 0.02), (0.02, 0.05), (0.022, 0.1), (0.028, 0.125), (0.012, 0.135)]
    mill += [(0.024, 0.155), (0.02, 0.18), (0.006, 0.19), (0.0, 0.195)]
    wood = matte("Walnut", (0.14, 0.06, 0.03), roughness=0.6)
    for number, (x, y, size) in enumerate(((-0.3, 0.22, 1.0), (-0.22, 0.3, 0.8)), 1):
        shape = turned_profile(smoothed(mill, 2), 20)
        add_object(f"Mill {number}", Shape(shape.positions * size, shape.polygons), wood, True, (x, y, TOP))
    board = projected(block((-0.17, -0.11, 0.0), (0.17, 0.11, 0.018), bevel=0.004), 0.4)
    oak = matte("Board", pixels=paint.planks(256, 256, 3, seed=21))
    add_object("Board", board, oak, location=(0.52, -0.14, TOP + 0.0005), rotation=(0.0, 0.0, 0.5))
    loaf = star_shape(_loaf, 8)
    crust = matte("Crust", (0.42, 0.21, 0.07), roughness=0.9)
    add_object("Loaf", loaf, crust, smooth=True, location=(0.52, -0.13, TOP + 0.0595), rotation=(0.0, 0.0, 0.7))
    for name, part, color in zip(
        ("Cover", "Pages"), book((0.17, 0.23, 0.03)), ((0.07, 0.2, 0.3), (0.8, 0.75, 0.63)), strict=True
    ):
        where = (-0.62, 0.14, TOP + 0.0155)
        add_object(name, part, matte(name, color), location=where, rotation=(0.0, 0.0, -0.3))


def _apple(directions: Float64Array) -> Float64Array:
    from_axis = np.hypot(directions[:, 0], directions[:, 1])
    return 0.04 * (0.62 + 0.38 * from_axis**0.7) * (1.0 - 0.06 * directions[:, 2] * (directions[:, 2] < 0.0))


def _loaf(directions: Float64Array) -> Float64Array:
    x, y, z = np.abs(directions).T
    return ((x / 0.13) ** 2.4 + (y / 0.06) ** 2.4 + (z / 0.04) ** 2.4) ** (-1.0 / 2.4)


def _add_stools() -> None:
    seat = turned_profile(smoothed([(0.0, 0.0), (0.15, 0.0), (0.165, 0.015), (0.15, 0.035), (0.0, 0.03)], 2), 28)
    yellow, dark = matte("Seat", (0.72, 0.45, 0.06), 0.6), matte("Iron", (0.05, 0.05, 0.055))
    for number, (x, y) in enumerate(((-0.45, -0.75), (0.75, -0.78)), 1):
        add_object(f"Seat {number}", seat, yellow, smooth=True, location=(x, y, 0.66))
        legs = []
        for angle in 0.7 + 0.5 * np.pi * np.arange(4):
            way = np.array([np.cos(angle), np.sin(angle), 0.0])
            path = np.array([[x, y, 0.66], [x, y, 0.0]]) + np.outer([0.1, 0.2], way)
            legs.append(tube(path, [0.012, 0.012], 10, side=(np.sin(angle), -np.cos(angle), 0.0)))
        a = 2.0 * np.pi * np.arange(25) / 24
        ring = np.column_stack([x + 0.165 * np.cos(a), y + 0.165 * np.sin(a), np.full(25, 0.25)])
        legs.append(tube(ring, np.full(25, 0.009), 8, side=(0.0, 0.0, 1.0)))
        add_object(f"Legs {number}", joined(*legs), dark, smooth=True)


def _add_light() -> None:
    """The sky in window and door, a low sun, two wide lamps under the ceiling, and a lamp of glass over the island."""
    set_world_color((0.75, 0.9, 1.15))
    add_sun((-0.75, -0.35, 0.5), 3.0, (1.0, 0.87, 0.68), angle=np.radians(1.5))
    for number, y in enumerate((-1.6, 0.7), 1):
        lamp: Any = bpy.data.lights.new(f"Ceiling lamp {number}", "AREA")
        lamp.shape, lamp.size, lamp.size_y, lamp.energy, lamp.color = "RECTANGLE", 2.4, 1.0, 55.0, (1.0, 0.9, 0.76)
        placed: Any = bpy.data.objects.new(lamp.name, lamp)
        placed.matrix_world = Matrix(looking((0.1, y, CEILING - 0.01), (0.1, y, 0.0)).tolist())
        bpy.context.scene.collection.objects.link(placed)
    shade = smoothed([(0.16, 0.0), (0.15, 0.05), (0.1, 0.12), (0.03, 0.16), (0.0, 0.163)], 3)
    for number, x in enumerate((-0.42, 0.42), 1):
        dome = turned_profile(shade, 32)
        add_object(f"Lampshade {number}", dome, matte("Copper", (0.5, 0.17, 0.08), 0.5), True, (x, 0.05, 1.62))
        bulb = emitter(f"Bulb {number}", (6.0, 4.6, 3.0))
        add_object(f"Bulb {number}", ball(0.04, 16), bulb, smooth=True, location=(x, 0.05, 1.68))
        cord = tube(np.array([[x, 0.05, 1.78], [x, 0.05, CEILING]]), [0.004, 0.004], 8, side=(0.0, 1.0, 0.0))
        add_object(f"Cord {number}", cord, matte("Cord", (0.04, 0.04, 0.04)))
