# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The room about the table: walls with two windows, floor, ceiling, curtains, and the garden and sky outside.

Heights are over the table: the floor lies `FLOOR` below it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..scene.arrays import Float64Array
from . import paint
from .data_blocks import add_object, add_sun, set_world_sky
from .materials import matte
from .shapes import Shape, block, joined, plane, projected, star_shape, surface

FLOOR, CEILING = -0.75, 1.75
LEFT, RIGHT, FRONT, BACK = -0.85, 2.7, -3.3, 0.62
"""Inner faces of the walls, meters"""
THICK = 0.18
"""Of the walls"""
WINDOWS = ((-1.0, 0.5, 0.1, 0.9), (-2.7, -1.15, -0.15, 1.35))
"""(from y, to y, from z, to z) of the left wall's openings: one over the table, one behind the camera"""

TOWARD_SUN = (-0.62, -0.45, 0.43)
SUN_COLOR = (1.0, 0.82, 0.6)


def add_room() -> None:
    """Walls, floor, ceiling and all that is fixed to them."""
    blue = matte("Blue plaster", pixels=paint.plaster(512, (0.36, 0.5, 0.53)))
    white = matte("White plaster", pixels=paint.plaster(512, (0.87, 0.84, 0.79), seed=12))
    paint_white = matte("White paint", (0.78, 0.76, 0.71), roughness=0.7)
    low, high = FLOOR - THICK, CEILING + THICK
    back = block((LEFT - THICK, BACK, low), (RIGHT + THICK, BACK + THICK, high))
    front = block((LEFT - THICK, FRONT - THICK, low), (RIGHT + THICK, FRONT, high))
    right = block((RIGHT, FRONT, low), (RIGHT + THICK, BACK, high))
    add_object("Back wall", projected(back, 1.3), blue)
    add_object("Front wall", projected(front, 1.3), white)
    add_object("Right wall", projected(right, 1.3), white)
    add_object("Window wall", projected(_window_wall(), 1.3), white)
    add_object("Ceiling", block((LEFT, FRONT, CEILING), (RIGHT, BACK, high)), paint_white)
    boards = paint.planks(1024, 1024, 8, seed=4, colors=((0.68, 0.52, 0.36), (0.42, 0.28, 0.17)))
    floor = projected(block((LEFT, FRONT, low), (RIGHT, BACK, FLOOR)), 1.2)
    add_object("Floor", floor, matte("Floor boards", pixels=boards))
    skirting = [
        block((LEFT, BACK - 0.015, FLOOR), (RIGHT, BACK, FLOOR + 0.09)),
        block((LEFT, FRONT, FLOOR), (RIGHT, FRONT + 0.015, FLOOR + 0.09)),
        block((RIGHT - 0.015, FRONT, FLOOR), (RIGHT, BACK, FLOOR + 0.09)),
        block((LEFT, FRONT, FLOOR), (LEFT + 0.015, BACK, FLOOR + 0.09)),
    ]
    add_object("Skirting", joined(*skirting), paint_white)
    linen = matte("Linen curtain", (0.74, 0.68, 0.57), roughness=0.9)
    for number, window in enumerate(WINDOWS, 1):
        add_object(f"Window frame {number}", _frame(window, bars=(1, 2)), paint_white)
    y0, y1, _, z1 = WINDOWS[1]
    for number, (start, end) in enumerate(((y0 - 0.3, y0 + 0.12), (y1 - 0.1, y1 + 0.26)), 1):
        add_object(f"Curtain {number}", _curtain(start, end, FLOOR + 0.02, z1 + 0.12), linen, smooth=True)
    rug = matte("Rug", pixels=paint.rug(384, 576), roughness=0.95)
    add_object("Rug", plane((1.5, 2.1)), rug, location=(0.75, -1.7, FLOOR + 0.006), rotation=(0.0, 0.0, 0.06))


def _window_wall() -> Shape:
    """The left wall: whole blocks between its openings, and blocks above and below these."""
    outer, inner, low, high = LEFT - THICK, LEFT, FLOOR - THICK, CEILING + THICK
    parts, start = [], FRONT
    for y0, y1, z0, z1 in sorted(WINDOWS):
        parts.append(block((outer, start, low), (inner, y0, high)))
        parts.append(block((outer, y0, low), (inner, y1, z0)))
        parts.append(block((outer, y0, z1), (inner, y1, high)))
        start = y1
    return joined(*parts, block((outer, start, low), (inner, BACK, high)))


def _frame(window: Sequence[float], bars: tuple[int, int]) -> Shape:
    """Wooden frame of an opening, `bars` (lying, upright) across it, and a sill."""
    y0, y1, z0, z1 = window
    near, far, wide, thin = LEFT - 0.07, LEFT - 0.115, 0.035, 0.011
    parts = [
        block((far, y0, z0), (near, y0 + wide, z1)),
        block((far, y1 - wide, z0), (near, y1, z1)),
        block((far, y0 + wide, z0), (near, y1 - wide, z0 + wide)),
        block((far, y0 + wide, z1 - wide), (near, y1 - wide, z1)),
        block((LEFT - 0.068, y0 - 0.03, z0 - 0.024), (LEFT + 0.05, y1 + 0.03, z0 - 0.001), bevel=0.004),
    ]
    for z in np.linspace(z0, z1, bars[0] + 2)[1:-1]:
        parts.append(block((far + 0.01, y0 + wide, z - thin), (near - 0.01, y1 - wide, z + thin)))
    for y in np.linspace(y0, y1, bars[1] + 2)[1:-1]:
        parts.append(block((far + 0.012, y - thin, z0 + wide), (near - 0.012, y + thin, z1 - wide)))
    return joined(*parts)


def _curtain(start: float, end: float, low: float, high: float) -> Shape:
    """A sheet in folds before the left wall, from y `start` to `end`."""
    along = np.linspace(0.0, 1.0, 61)
    fold = 0.032 * np.sin(2.0 * np.pi * 6.0 * along) + 0.008 * np.sin(2.0 * np.pi * 2.7 * along + 1.0)
    lattice = np.empty((9, 61, 3))
    for row, t in enumerate(np.linspace(0.0, 1.0, 9)):
        lattice[row, :, 0] = LEFT + 0.075 + fold * (1.0 - 0.35 * t)
        lattice[row, :, 1] = start + (end - start) * (along + 0.02 * (1.0 - t) * np.sin(9.0 * along))
        lattice[row, :, 2] = low + (high - low) * t
    return surface(lattice)


def add_outside() -> None:
    """Sky and sun, and what is to be seen from the windows: a lawn, a hedge and trees."""
    leaves = paint.leaves(512)
    green = matte("Lawn", pixels=leaves, roughness=0.9)
    lawn = projected(block((-9.0, -9.0, -1.6), (LEFT - THICK, 5.0, -1.0)), 1.4)
    add_object("Lawn", lawn, green)
    hedge = projected(block((-7.2, -9.0, -1.0), (-6.4, 5.0, 0.15)), 1.1)
    add_object("Hedge", hedge, matte("Hedge", pixels=leaves * np.array([0.8, 0.85, 0.75, 1.0], np.float32)))
    bark = matte("Bark", (0.12, 0.075, 0.045))
    crown = star_shape(_crown_radius, 12)
    for number, (x, y, size) in enumerate(((-5.2, 2.2, 0.95), (-6.6, -0.4, 1.15), (-7.4, -4.9, 1.3)), 1):
        middle = -1.0 + 1.75 * size
        grown = Shape(crown.positions * size, crown.polygons).turned(1.7 * number).moved((x, y, middle))
        add_object(f"Tree {number}", projected(grown, 1.1), green)
        trunk = block((x - 0.07, y - 0.07, -1.0), (x + 0.07, y + 0.07, middle))
        add_object(f"Trunk {number}", trunk, bark)
    set_world_sky(TOWARD_SUN, strength=0.45)
    add_sun(TOWARD_SUN, strength=9.0, color=SUN_COLOR, angle=np.radians(1.0))


def _crown_radius(directions: Float64Array) -> Float64Array:
    """Distance (n,) of a tree's leaves from their middle, in meters."""
    x, y, z = directions.T
    lumps: Any = np.sin(5.0 * x + 1.0) * np.sin(6.0 * y) * np.cos(5.0 * z) + 0.4 * np.sin(11.0 * (x + y - z))
    return 0.8 + 0.11 * lumps
