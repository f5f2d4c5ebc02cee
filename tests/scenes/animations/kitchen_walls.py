# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The kitchen about the island: walls, what is seen through window and door, cupboards, shelves."""

from __future__ import annotations

from itertools import pairwise

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo import paint
from curvrefl.curvrefl_addon.demo.data_blocks import add_object
from curvrefl.curvrefl_addon.demo.materials import matte
from curvrefl.curvrefl_addon.demo.shapes import (
    Shape,
    ball,
    block,
    joined,
    plane,
    projected,
    surface,
    tube,
    turned_profile,
)
from curvrefl.curvrefl_addon.demo.table import smoothed

LEFT, RIGHT, FRONT, BACK, CEILING = -2.1, 2.3, -2.7, 1.7, 2.6
WHITE = (0.83, 0.81, 0.77)


def add_room() -> None:
    tiles = matte("Floor tiles", pixels=paint.chequer(512, 8, (0.78, 0.74, 0.68), (0.33, 0.4, 0.42)))
    wall = matte("Wall", pixels=paint.plaster(512, (0.9, 0.86, 0.74)))
    paint_white = matte("White paint", WHITE, roughness=0.7)
    thick = 0.15
    # Walls, floor and ceiling go on in each other: where surfaces only touch, their curved reflections are drawn with
    # edges of their own, which may let the sky through between them.
    over = 0.1
    low, high = -over, CEILING + over
    left, right, back, front = LEFT - over, RIGHT + over, BACK + over, FRONT - over
    ceiling = block((left, front, CEILING), (right, back, CEILING + thick))
    add_object("Ceiling", ceiling, paint_white)
    add_object("Floor", plane((right - left, back - front), (8, 8), tile=2.0), tiles, location=_middle(0.0))
    add_object("Back wall", projected(block((left, BACK, low), (right, BACK + thick, high)), 1.5), wall)
    add_object("Right wall", projected(block((RIGHT, front, low), (RIGHT + thick, back, high)), 1.5), wall)
    openings = ((-1.75, 0.35, 0.95, 2.2),)
    for y0, y1, z0, z1 in openings:
        parts = [
            block((LEFT - thick, front, low), (LEFT, y0, high)),
            block((LEFT - thick, y1, low), (LEFT, back, high)),
            block((LEFT - thick, y0, low), (LEFT, y1, z0)),
            block((LEFT - thick, y0, z1), (LEFT, y1, high)),
        ]
        add_object("Window wall", projected(joined(*parts), 1.5), wall)
        far, near, bar = LEFT - 0.1, LEFT - 0.05, 0.022
        # (So do frames and walls.)
        a0, a1, b0, b1 = y0 - bar, y1 + bar, z0 - bar, z1 + bar
        frame = [block((far, y, b0), (near, y + 2 * bar, b1)) for y in np.linspace(a0, a1 - 2 * bar, 4)]
        frame += [block((far, a0, z), (near, a1, z + 2 * bar)) for z in np.linspace(b0, b1 - 2 * bar, 3)]
        frame.append(block((LEFT - 0.06, y0 - 0.05, z0 - 0.03), (LEFT + 0.1, y1 + 0.05, z0), bevel=0.005))
        add_object("Window frame", joined(*frame), paint_white)
    # Behind the camera: a door to the garden, which only the pot shows.
    x0, x1, top = 0.1, 1.5, 2.15
    parts = [
        block((left, FRONT - thick, low), (x0, FRONT, high)),
        block((x1, FRONT - thick, low), (right, FRONT, high)),
        block((x0, FRONT - thick, top), (x1, FRONT, high)),
    ]
    add_object("Garden wall", projected(joined(*parts), 1.5), wall)
    posts = [
        block((x, FRONT - 0.1, 0.0), (x + 0.08, FRONT - 0.04, top + 0.03)) for x in np.linspace(x0 - 0.03, x1 - 0.05, 3)
    ]
    posts += [block((x0, FRONT - 0.1, z), (x1, FRONT - 0.04, z + 0.08)) for z in (-0.02, 0.7, top - 0.05)]
    add_object("Garden door", joined(*posts), matte("Green paint", (0.06, 0.17, 0.13), roughness=0.7))
    leaves = matte("Leaves", pixels=paint.leaves(256), roughness=0.9)
    lawn = plane((14.0, 14.0), (4, 4), tile=1.4)
    add_object("Lawn", lawn, leaves, location=(0.0, -1.0, -0.12))
    hedge = projected(
        joined(block((-6.4, -6.5, -0.1), (6.4, -6.0, 1.3)), block((-6.9, -6.5, -0.1), (-6.4, 5.0, 1.1))), 1.1
    )
    add_object("Hedge", hedge, leaves)
    linen = matte("Linen", (0.78, 0.3, 0.17), roughness=0.9)
    for number, (y, wide) in enumerate(((-2.05, 0.42), (0.2, 0.36)), 1):
        add_object(f"Curtain {number}", _curtain(y, wide), linen, smooth=True)
    rod = tube(
        np.array([[LEFT + 0.08, -2.15, 2.32], [LEFT + 0.08, 0.65, 2.32]]), [0.012, 0.012], 10, side=(0.0, 0.0, 1.0)
    )
    add_object("Curtain rod", rod, matte("Dark metal", (0.06, 0.055, 0.05)))


def _middle(height: float) -> tuple[float, float, float]:
    return (0.5 * (LEFT + RIGHT), 0.5 * (FRONT + BACK), height)


def _curtain(start: float, wide: float) -> Shape:
    """A sheet in folds before the window's wall."""
    along = np.linspace(0.0, 1.0, 37)
    lattice = np.empty((7, 37, 3))
    for row, t in enumerate(np.linspace(0.0, 1.0, 7)):
        lattice[row, :, 0] = LEFT + 0.08 + 0.035 * np.sin(2.0 * np.pi * 4.0 * along) * (1.0 - 0.4 * t)
        lattice[row, :, 1] = start + wide * along
        lattice[row, :, 2] = 0.5 + 1.8 * t
    return surface(lattice)


def add_back_row() -> None:
    """Cupboards along the back wall with a worktop, an oven, a hob and a sink; a fridge at their end."""
    front, low, deep = BACK - 0.6, 0.1, BACK - 0.02
    blue = matte("Blue lacquer", (0.1, 0.22, 0.29), roughness=0.6)
    knob_metal = matte("Brass", (0.5, 0.33, 0.1), roughness=0.5)
    doors, knobs = [], []
    edges = np.linspace(LEFT + 0.03, 1.5, 8)
    for index, (x0, x1) in enumerate(pairwise(edges)):
        if index == 4:
            continue
        doors.append(block((x0 + 0.006, front - 0.02, low + 0.02), (x1 - 0.006, front, 0.86), bevel=0.006))
        side = x1 - 0.06 if index % 2 == 0 else x0 + 0.06
        knobs.append(ball(0.016, 10).moved((side, front - 0.036, 0.76)))
    add_object("Doors", joined(*doors), blue)
    add_object("Knobs", joined(*knobs), knob_metal, smooth=True)
    add_object("Cupboards", block((LEFT + 0.02, front, low), (1.5, deep, 0.88)), matte("Cupboard", (0.07, 0.15, 0.2)))
    stone = matte("Worktop", pixels=paint.plaster(256, (0.42, 0.4, 0.38), seed=5), roughness=0.5)
    add_object(
        "Worktop", projected(block((LEFT + 0.01, front - 0.03, 0.88), (1.5, deep, 0.92), bevel=0.006), 0.6), stone
    )
    x0, x1 = edges[4], edges[5]
    black = matte("Oven", (0.03, 0.03, 0.033), roughness=0.4)
    oven = [
        block((x0 + 0.006, front - 0.025, 0.2), (x1 - 0.006, front, 0.72), bevel=0.006),
        block((x0 + 0.006, front - 0.025, 0.735), (x1 - 0.006, front, 0.86), bevel=0.006),
    ]
    add_object("Oven", joined(*oven), black)
    handle = tube(
        np.array([[x0 + 0.05, front - 0.06, 0.66], [x1 - 0.05, front - 0.06, 0.66]]), [0.01, 0.01], 10, (0, 0, 1)
    )
    dials = [
        turned_profile([(0.0, 0.0), (0.018, 0.0), (0.015, 0.02), (0.0, 0.02)], 16)
        .turned(np.pi / 2, 0)
        .moved((x, front - 0.025, 0.8))
        for x in np.linspace(x0 + 0.09, x1 - 0.09, 5)
    ]
    add_object("Oven's handle", joined(handle, *dials), knob_metal, smooth=True)
    rings = [
        turned_profile([(0.0, 0.0), (r, 0.0), (r, 0.008), (r - 0.015, 0.012), (0.0, 0.012)], 28).moved((x, y, 0.9205))
        for x, r in ((x0 + 0.14, 0.07), (x1 - 0.14, 0.085))
        for y in (BACK - 0.2, BACK - 0.42)
    ]
    add_object("Hob", joined(*rings), black, smooth=True)
    red = matte("Red enamel", (0.48, 0.03, 0.02), roughness=0.5)
    pan = smoothed([(0.0, 0.0), (0.095, 0.0), (0.1, 0.01), (0.1, 0.11), (0.096, 0.112), (0.093, 0.012), (0.0, 0.01)], 2)
    lever = tube(
        np.array([[0.1, 0.0, 0.1], [0.18, 0.0, 0.115], [0.27, 0.0, 0.115]]), [0.012, 0.01, 0.012], 10, (0, 1, 0)
    )
    where = (x0 + 0.14, BACK - 0.42, 0.935)
    add_object("Saucepan", joined(turned_profile(pan, 32), lever.turned(2.3)), red, smooth=True, location=where)
    hood = [(x0 - 0.05, 0.5, 1.62), (x0 - 0.05, 0.5, 1.68), (x0 + 0.12, 0.28, 1.95), (x0 + 0.12, 0.28, CEILING)]
    corners = []
    for x, depth, z in hood:
        other = x0 + x1 - x
        corners += [(x, BACK - depth, z), (other, BACK - depth, z), (other, BACK, z), (x, BACK, z)]
    faces = [tuple(reversed(range(4)))]
    for level in range(3):
        for side in range(4):
            a, b = 4 * level + side, 4 * level + (side + 1) % 4
            faces.append((a, b, b + 4, a + 4))
    add_object("Hood", Shape(np.array(corners), tuple(faces)), matte("Hood", (0.55, 0.54, 0.52), roughness=0.5))
    white = matte("Fridge", (0.8, 0.79, 0.74), roughness=0.5)
    parts = [
        block((1.54, front - 0.03, 0.05), (2.2, deep, 1.95), bevel=0.02),
        block((1.55, front - 0.07, 0.07), (2.19, front - 0.03, 0.66), bevel=0.015),
        block((1.55, front - 0.07, 0.68), (2.19, front - 0.03, 1.93), bevel=0.015),
    ]
    add_object("Fridge", joined(*parts), white)
    bars = [
        tube(np.array([[1.6, front - 0.1, z0], [1.6, front - 0.1, z1]]), [0.011, 0.011], 10, (1, 0, 0))
        for z0, z1 in ((0.4, 0.6), (0.75, 1.2))
    ]
    add_object("Fridge's handles", joined(*bars), knob_metal, smooth=True)
    _add_sink(0.5 * (edges[1] + edges[2]), knob_metal)


def _add_sink(x: float, metal: bpy.types.Material) -> None:
    t = np.linspace(0.0, np.pi, 17)
    neck = np.column_stack([np.zeros(17), BACK - 0.16 - 0.09 * (1.0 - np.cos(t)), 1.16 + 0.09 * np.sin(t)])
    path = np.vstack([[0.0, BACK - 0.16, 0.92], neck, [0.0, BACK - 0.34, 1.1]])
    tap = tube(path + np.array([x, 0.0, 0.0]), np.full(len(path), 0.013), 12, side=(1.0, 0.0, 0.0))
    foot = turned_profile([(0.0, 0.0), (0.03, 0.0), (0.024, 0.03), (0.0, 0.03)], 20).moved((x, BACK - 0.16, 0.92))
    add_object("Tap", joined(tap, foot), metal, smooth=True)
    rim = block((x - 0.3, BACK - 0.5, 0.921), (x + 0.3, BACK - 0.22, 0.927), bevel=0.002)
    add_object("Sink", rim, matte("Sink", (0.5, 0.51, 0.5), roughness=0.5))


def add_wall_things() -> None:
    """Tiles, two shelves of plates, jars and cups, a clock."""
    tiles = matte("Wall tiles", pixels=paint.chequer(512, 12, (0.86, 0.87, 0.82), (0.62, 0.74, 0.72)))
    sheet = plane((3.6, 0.7), tile=1.2).turned(np.pi / 2, 0)
    add_object("Tiles", sheet, tiles, location=(-0.3, BACK - 0.004, 1.27))
    oak = paint.planks(512, 512, 4, seed=8, colors=((0.72, 0.53, 0.36), (0.5, 0.33, 0.2)))
    wood = matte("Oak", pixels=oak)
    boards = [block((-1.95, BACK - 0.26, z), (0.1, BACK, z + 0.03), bevel=0.003) for z in (1.66, 2.05)]
    add_object("Shelves", projected(joined(*boards), 0.7), wood)
    plate = smoothed(
        [(0.0, 0.0), (0.06, 0.0), (0.075, 0.008), (0.11, 0.018), (0.11, 0.021), (0.07, 0.012), (0.0, 0.005)], 2
    )
    stack = [turned_profile(plate, 22).moved((-1.7, BACK - 0.13, 1.69 + 0.014 * index)) for index in range(5)]
    add_object("Plates", joined(*stack), matte("Faience", (0.7, 0.72, 0.68), roughness=0.5), smooth=True)
    colors = ((0.03, 0.2, 0.23), (0.62, 0.33, 0.04), (0.36, 0.05, 0.03), (0.12, 0.27, 0.08), (0.6, 0.55, 0.42))
    cup = [(0.0, 0.0), (0.034, 0.0), (0.04, 0.012), (0.042, 0.085), (0.039, 0.086), (0.036, 0.014), (0.0, 0.01)]
    angle = np.radians(np.linspace(-78.0, 78.0, 9))
    ear = np.column_stack([0.04 + 0.028 * np.cos(angle), np.zeros(9), 0.045 + 0.026 * np.sin(angle)])
    for number, color in enumerate(colors):
        handle = tube(ear, np.full(9, 0.005), 8, side=(0.0, 1.0, 0.0))
        shape = joined(turned_profile(smoothed(cup, 2), 24), handle)
        where = (-1.42 + 0.17 * number, BACK - 0.14, 1.69)
        add_object(f"Cup {number + 1}", shape, matte(f"Cup {number + 1}", color, 0.5), True, where, (0.0, 0.0, -0.9))
    jar = [(0.0, 0.0), (0.05, 0.0), (0.056, 0.01), (0.056, 0.14), (0.045, 0.155), (0.045, 0.175), (0.0, 0.178)]
    for number in range(7):
        color = colors[(2 * number) % 5]
        shape = turned_profile(smoothed(jar, 2), 24)
        size = (0.85, 1.1, 1.0)[number % 3]
        where = (-1.78 + 0.28 * number, BACK - 0.13, 2.08)
        jar_shape = Shape(shape.positions * [1.0, 1.0, size], shape.polygons)
        add_object(f"Jar {number + 1}", jar_shape, matte(f"Jar {number + 1}", color, 0.5), smooth=True, location=where)
    rim = turned_profile(smoothed([(0.0, 0.0), (0.15, 0.0), (0.165, 0.015), (0.15, 0.03), (0.14, 0.02)], 2), 40)
    turn, where = (0.0, -np.pi / 2, 0.0), (RIGHT - 0.002, -0.6, 1.9)
    add_object("Clock", rim, matte("Clock", (0.45, 0.06, 0.04)), True, where, turn)
    face = turned_profile([(0.0, 0.018), (0.145, 0.018)], 40)
    turned = tuple(polygon[::-1] for polygon in face.polygons)
    add_object("Clock's face", Shape(face.positions, turned), matte("Face", (0.85, 0.83, 0.77)), False, where, turn)
    hands = joined(
        block((0.022, -0.006, -0.02), (0.026, 0.006, 0.085)), block((0.022, -0.02, -0.005), (0.026, 0.11, 0.005))
    )
    dark = matte("Hands", (0.03, 0.03, 0.03))
    add_object("Clock's hands", hands.turned(np.pi), dark, location=where)
    shown = plane((0.9, 0.62)).turned(np.pi / 2, 0).turned(-np.pi / 2)
    add_object("Print", shown, matte("Print", pixels=paint.landscape(384, 256)), location=(RIGHT - 0.012, 0.45, 1.6))
    back = block((-0.01, -0.48, -0.34), (0.011, 0.48, 0.34)).moved((RIGHT - 0.001, 0.45, 1.6))
    add_object("Print's frame", back, matte("Frame", (0.09, 0.05, 0.03)))
