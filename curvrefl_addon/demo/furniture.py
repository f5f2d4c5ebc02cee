# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What only the mirrors show: the side of the room behind the camera, and things on the table out of the picture."""

from __future__ import annotations

import numpy as np

from ..scene.arrays import Float64Array
from . import paint
from .data_blocks import add_object
from .materials import matte
from .room import CEILING, FLOOR, FRONT, LEFT, RIGHT
from .shapes import Shape, ball, block, joined, plane, projected, surface, tube, turned_profile


def add_unseen_things() -> None:
    """All of it."""
    _add_small_things()
    _add_bookcase(0.1, 1.35)
    _add_door(1.75)
    _add_sofa()
    _add_plant((LEFT + 0.42, -3.0))
    _add_poster()


def _add_small_things() -> None:
    """A mug, a lemon and a pencil on the table."""
    teal = matte("Teal mug", (0.02, 0.22, 0.24), roughness=0.7)
    add_object("Mug", _mug(), teal, smooth=True, location=(0.46, -0.24, 0.0), rotation=(0.0, 0.0, 0.6))
    lemon = matte("Lemon", (0.85, 0.62, 0.03), roughness=0.6)
    add_object("Lemon", ball(0.03, 20), lemon, smooth=True, location=(-0.16, -0.38, 0.03))
    wood = matte("Pencil", (0.8, 0.26, 0.02), roughness=0.6)
    tip = matte("Pencil tip", (0.76, 0.55, 0.34))
    for name, part, material in zip(("Pencil", "Pencil tip"), _pencil(), (wood, tip), strict=True):
        add_object(name, part, material, location=(0.1, -0.39, 0.003465), rotation=(0.0, 0.0, np.radians(-14.0)))


def _pencil() -> tuple[Shape, Shape]:
    """(shaft, sharpened end) of a six-sided pencil along X, its axis through the origin."""
    shaft = turned_profile([(0.0, -0.07), (0.004, -0.07), (0.004, 0.052)], 6)
    point = turned_profile([(0.004, 0.052), (0.0, 0.07)], 6)
    shaft, point = (part.turned(np.pi / 2, 1).turned(np.pi / 6, 0) for part in (shaft, point))  # a flat side down
    return shaft, point


def _mug() -> Shape:
    """A mug with a handle, standing on height 0."""
    profile = [(0.0, 0.0), (0.036, 0.0), (0.04, 0.004), (0.042, 0.095), (0.0395, 0.0965), (0.037, 0.094)]
    cup = turned_profile([*profile, (0.035, 0.012), (0.0, 0.010)], 28)
    angle = np.radians(np.linspace(-78.0, 78.0, 9))
    path = np.column_stack([0.039 + 0.028 * np.cos(angle), np.zeros(9), 0.05 + 0.03 * np.sin(angle)])
    return joined(cup, tube(path, np.full(9, 0.005), 6, side=(0.0, 1.0, 0.0)))


def _add_bookcase(start: float, end: float) -> None:
    """Shelves on the front wall from x `start` to `end`, full of books."""
    rng = np.random.default_rng(17)
    front, top, board = FRONT + 0.3, 1.15, 0.022
    parts = [block((x, FRONT + 0.002, FLOOR), (x + board, front, top)) for x in (start, end - board)]
    levels = np.linspace(FLOOR + 0.06, top - board, 6)
    parts += [block((start + board, FRONT + 0.002, z), (end - board, front, z + board)) for z in levels]
    parts.append(block((start + board, FRONT + 0.002, FLOOR + 0.06), (end - board, FRONT + 0.012, top - board)))
    oak = paint.planks(512, 512, 4, seed=8, colors=((0.6, 0.44, 0.29), (0.42, 0.27, 0.16)))
    add_object("Bookcase", projected(joined(*parts), 0.7), matte("Bookcase oak", pixels=oak))
    colors = [(0.32, 0.05, 0.04), (0.5, 0.24, 0.05), (0.05, 0.16, 0.11), (0.06, 0.1, 0.2), (0.6, 0.52, 0.38)]
    shelves: list[list[Shape]] = [[] for _ in colors]
    gap = float(levels[1] - levels[0]) - board
    for z in levels[:-1]:
        x = start + board + 0.01
        while True:
            x += 0.12 if rng.random() < 0.06 else 0.001
            wide, tall, deep = rng.uniform(0.018, 0.045), rng.uniform(0.62, 0.92) * gap, rng.uniform(0.17, 0.23)
            if x + wide > end - board - 0.01:
                break
            low = (x, front - 0.02 - deep, float(z) + board)
            shelves[int(rng.integers(len(colors)))].append(block(low, (x + wide, front - 0.02, low[2] + tall)))
            x += wide
    for number, (color, books) in enumerate(zip(colors, shelves, strict=True), 1):
        add_object(f"Books {number}", joined(*books), matte(f"Books {number}", color))


def _add_door(start: float) -> None:
    """A door in the front wall."""
    white = matte("Door paint", (0.66, 0.63, 0.56), roughness=0.7)
    wide, top, y = 0.8, 1.3, FRONT
    parts = [
        block((start, y + 0.001, FLOOR), (start + 0.07, y + 0.04, top)),
        block((start + wide - 0.07, y + 0.001, FLOOR), (start + wide, y + 0.04, top)),
        block((start, y + 0.001, top), (start + wide, y + 0.04, top + 0.07)),
        block((start + 0.07, y + 0.001, FLOOR), (start + wide - 0.07, y + 0.012, top)),
        block((start + 0.16, y + 0.012, FLOOR + 0.2), (start + wide - 0.16, y + 0.022, FLOOR + 0.8), bevel=0.006),
        block((start + 0.16, y + 0.012, FLOOR + 1.0), (start + wide - 0.16, y + 0.022, top - 0.15), bevel=0.006),
    ]
    add_object("Door", joined(*parts), white)
    knob = ball(0.03, 16).moved((start + 0.13, y + 0.055, FLOOR + 0.9))
    add_object("Door knob", knob, matte("Door knob", (0.4, 0.25, 0.08), roughness=0.7), smooth=True)


def _add_sofa() -> None:
    """A sofa along the right wall, with cushions."""
    x0, x1, y0, y1 = RIGHT - 0.92, RIGHT - 0.04, -2.5, -0.7
    cloth = matte("Sofa cloth", (0.32, 0.12, 0.065), roughness=0.95)
    parts = [
        block((x0, y0 + 0.18, FLOOR + 0.1), (x1 - 0.2, y1 - 0.18, FLOOR + 0.32), bevel=0.03),
        block((x0 - 0.01, y0 + 0.19, FLOOR + 0.32), (x1 - 0.2, -1.605, FLOOR + 0.46), bevel=0.045),
        block((x0 - 0.01, -1.595, FLOOR + 0.32), (x1 - 0.2, y1 - 0.19, FLOOR + 0.46), bevel=0.045),
        block((x1 - 0.24, y0, FLOOR + 0.1), (x1, y1, FLOOR + 0.88), bevel=0.05),
        block((x0, y0, FLOOR + 0.1), (x1, y0 + 0.18, FLOOR + 0.62), bevel=0.045),
        block((x0, y1 - 0.18, FLOOR + 0.1), (x1, y1, FLOOR + 0.62), bevel=0.045),
    ]
    add_object("Sofa", joined(*parts), cloth)
    for number, (y, color) in enumerate(((y0 + 0.42, (0.7, 0.45, 0.12)), (y1 - 0.44, (0.09, 0.22, 0.25))), 1):
        shape = ball(0.21, 24)
        x, up, z = shape.positions.T
        flat = np.column_stack(
            [0.4 * x, np.sign(up) * np.abs(up / 0.21) ** 0.6 * 0.2, np.sign(z) * np.abs(z / 0.21) ** 0.6 * 0.2]
        )
        cushion = Shape(flat, shape.polygons).turned(-0.35, 1).moved((x1 - 0.36, y, FLOOR + 0.66))
        add_object(f"Cushion {number}", cushion, matte(f"Cushion {number}", color, roughness=0.95), smooth=True)


def _add_plant(place: tuple[float, float]) -> None:
    """A plant with long leaves in a pot of clay, in the corner."""
    rng = np.random.default_rng(31)
    x, y = place
    pot = turned_profile([(0.0, 0.0), (0.12, 0.0), (0.17, 0.3), (0.155, 0.3), (0.14, 0.25), (0.0, 0.25)], 28)
    add_object("Pot", pot, matte("Terracotta", (0.5, 0.19, 0.09)), smooth=True, location=(x, y, FLOOR))
    blades = []
    for index in range(46):
        heading = 2.4 * index + rng.uniform(-0.3, 0.3)
        steep = 1.35 - 0.95 * index / 46.0 * rng.uniform(0.8, 1.0)
        blades.append(_leaf(rng.uniform(0.55, 1.0), rng.uniform(0.025, 0.04), steep).turned(heading))
    green = matte("Leaves", (0.05, 0.14, 0.035), roughness=0.7)
    add_object("Plant", joined(*blades).moved((x, y, FLOOR + 0.24)), green, smooth=True)


def _leaf(length: float, width: float, steep: float) -> Shape:
    """A blade that rises at an angle of `steep` radians and bends down."""
    t = np.linspace(0.0, 1.0, 9)
    along, up = np.cos(steep) * t + 0.25 * t**3, np.sin(steep) * t - 0.55 * t**2.5 * np.cos(steep)
    wide = width * np.sin(np.pi * np.clip(0.06 + 0.94 * t, 0.0, 1.0)) ** 0.7
    rows: list[Float64Array] = []
    for side, lift in ((-1.0, 0.25), (0.0, 0.0), (1.0, 0.25)):
        rows.append(np.column_stack([along * length, side * wide, up * length + lift * wide]))
    return surface(np.stack(rows))


def _add_poster() -> None:
    """A large print over the sofa."""
    wide, tall = 1.2, 0.8
    sheet = plane((wide, tall)).turned(np.pi / 2, 0).turned(-np.pi / 2)
    picture = matte("Poster", pixels=paint.landscape(384, 256))
    where = (RIGHT - 0.022, -1.6, min(0.75, CEILING - 0.5))
    add_object("Poster", sheet, picture, location=where)
    back = block((-0.02, -0.5 * wide - 0.02, -0.5 * tall - 0.02), (-0.002, 0.5 * wide + 0.02, 0.5 * tall + 0.02))
    add_object("Poster frame", back.moved((0.021, 0.0, 0.0)), matte("Poster frame", (0.05, 0.03, 0.02)), location=where)
