# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A saucer of polished metal that lands on the square of a city, with streets and trucks about it.

Lengths in meters; the square is about the origin, streets run along X and Y.
"""

from __future__ import annotations

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo import paint
from curvrefl.curvrefl_addon.demo.data_blocks import (
    Color,
    add_object,
    add_sun,
    emitter,
    mirror,
    set_world_sky,
)
from curvrefl.curvrefl_addon.demo.materials import matte
from curvrefl.curvrefl_addon.demo.shapes import (
    Shape,
    ball,
    block,
    joined,
    plane,
    projected,
    star_normals,
    star_shape,
    tube,
    turned_profile,
)
from curvrefl.curvrefl_addon.demo.table import smoothed
from curvrefl.curvrefl_addon.scene.arrays import Float64Array

from .stage import copied, eased, fly, mark, move, placed, start, through

SAUCER = "Saucer"
WIDE, HIGH = 5.0, 1.7
"""Half its width and height"""
LANDED, ABOVE = 3.3, 19.0
"""Height of its middle at the end and at the start"""
SQUARE = 22.0
"""Half the width of the square"""
STREET = 9.0
"""Width of streets"""
STORY, BAY = 3.3, 3.0
"""Height of a floor, width from window to window"""
TOWARD_SUN = (-0.5, -0.62, 0.6)


def saucer_radius(directions: Float64Array) -> Float64Array:
    """Distance (n,) of the saucer from its middle along unit directions (n, 3)."""
    x, y, z = np.abs(directions).T
    return ((np.hypot(x, y) / WIDE) ** 2 + (z / HIGH) ** 2) ** -0.5


def build() -> None:
    """Replace the open file by the film."""
    start()
    _add_ground()
    _add_buildings()
    _add_trees_and_lamps()
    _add_traffic()
    mark(_add_saucer())
    set_world_sky(TOWARD_SUN, strength=0.35)
    add_sun(TOWARD_SUN, 4.0, (1.0, 0.93, 0.82), angle=np.radians(1.0))
    eye = through((-15.0, -20.0, 2.2), (-14.5, -20.0, 4.2), (-11.5, -17.5, 5.4), (-7.5, -13.5, 4.6), (-4.0, -9.6, 3.6))
    target = through((0.0, 0.0, 14.0), (0.0, 0.0, 10.0), (0.0, 0.0, 6.0), (0.0, 0.0, 4.0), (0.0, -1.0, 3.4))
    fly(eye, target, lens=30.0, clip=(0.1, 1000.0))


def _add_ground() -> None:
    stones = paint.chequer(512, 8, (0.66, 0.61, 0.54), (0.55, 0.5, 0.45))
    paving = matte("Paving", pixels=stones, roughness=0.9)
    add_object("Square", plane((2.0 * SQUARE, 2.0 * SQUARE), (16, 16), tile=11.0), paving)
    asphalt = matte("Asphalt", pixels=paint.plaster(256, (0.2, 0.2, 0.21), seed=2), roughness=0.9)
    add_object("Streets", plane((420.0, 420.0), (40, 40), tile=12.0), asphalt, location=(0.0, 0.0, -0.12))
    curb = matte("Curb", (0.42, 0.41, 0.39))
    s = SQUARE
    edges = [
        block((-s, -s, -0.12), (s, -s + 0.3, 0.03)),
        block((-s, s - 0.3, -0.12), (s, s, 0.03)),
        block((-s, -s, -0.12), (-s + 0.3, s, 0.03)),
        block((s - 0.3, -s, -0.12), (s, s, 0.03)),
    ]
    add_object("Curbs", joined(*edges), curb)
    lines = []
    for along in np.arange(-60.0, 60.0, 4.0):
        for across in (-(s + 0.5 * STREET), s + 0.5 * STREET):
            lines.append(block((along, across - 0.09, -0.12), (along + 2.0, across + 0.09, -0.112)))
            lines.append(block((across - 0.09, along, -0.12), (across + 0.09, along + 2.0, -0.112)))
    add_object("Lines", joined(*lines), matte("Line", (0.75, 0.75, 0.7)))
    rings = [turned_profile([(r - 0.5, 0.004), (r, 0.012), (r - 0.5, 0.012)], 64) for r in (7.0, 4.5)]
    add_object("Rings", joined(*rings), matte("Red stone", (0.42, 0.12, 0.07)))


def building(bays: tuple[int, int], floors: int) -> tuple[Shape, Shape, Shape]:
    """(walls, windows, frames) of a house so many windows wide and deep, standing on height 0 about the origin."""
    wide, deep, high = bays[0] * BAY + 1.0, bays[1] * BAY + 1.0, floors * STORY + 1.0
    walls = [
        block((-0.5 * wide, -0.5 * deep, -0.12), (0.5 * wide, 0.5 * deep, high)),
        block((-0.5 * wide - 0.35, -0.5 * deep - 0.35, high), (0.5 * wide + 0.35, 0.5 * deep + 0.35, high + 0.6)),
        block((-0.5 * wide - 0.2, -0.5 * deep - 0.2, 3.6), (0.5 * wide + 0.2, 0.5 * deep + 0.2, 3.9)),
    ]
    windows, frames = [], []
    for side in range(4):
        count, out = bays[side % 2], 0.5 * (deep, wide)[side % 2]
        for floor in range(floors):
            low, tall = floor * STORY + (0.5 if floor == 0 else 1.2), (2.6 if floor == 0 else 1.7)
            for bay in range(count):
                x = (bay - 0.5 * (count - 1)) * BAY
                pane = block((x - 0.65, -out - 0.06, low), (x + 0.65, -out + 0.05, low + tall))
                sill = block((x - 0.85, -out - 0.22, low - 0.18), (x + 0.85, -out + 0.05, low))
                windows.append(pane.turned(0.5 * np.pi * side))
                frames.append(sill.turned(0.5 * np.pi * side))
    return projected(joined(*walls), 8.0), joined(*windows), joined(*frames)


KINDS: tuple[tuple[tuple[int, int], int, Color], ...] = (
    ((6, 5), 6, (0.82, 0.62, 0.45)),
    ((5, 5), 8, (0.7, 0.42, 0.34)),
    ((6, 5), 5, (0.86, 0.8, 0.66)),
    ((4, 5), 11, (0.62, 0.66, 0.7)),
    ((5, 5), 6, (0.76, 0.7, 0.42)),
)
"""Windows wide and deep, floors, color"""


def _add_buildings() -> None:
    """Two rows round the square; those at its corners are towers."""
    glass = matte("Panes", (0.035, 0.06, 0.085), roughness=0.4)
    stone = matte("Sills", (0.72, 0.69, 0.62))
    made: list[list[bpy.types.Object]] = []
    for number, (bays, floors, color) in enumerate(KINDS, 1):
        plaster = matte(f"House {number}", pixels=paint.plaster(128, color, seed=number), roughness=0.9)
        parts = zip(("House", "Panes", "Sills"), building(bays, floors), (plaster, glass, stone), strict=True)
        made.append([add_object(f"{name} {number}", shape, material) for name, shape, material in parts])
    used: set[int] = set()
    first = SQUARE + STREET + 10.0
    for index, (x, y, kind) in enumerate(_plots(first)):
        for part in made[kind]:
            thing = part if kind not in used else copied(part)
            thing.location = (x, y, 0.0)
            thing.rotation_euler = (0.0, 0.0, 0.5 * np.pi * (index % 4))
        used.add(kind)


def _plots(first: float) -> list[tuple[float, float, int]]:
    """Places of houses, and of which kind each is."""
    plots = []
    for side in range(4):
        for place, kind in zip((-22.5, 0.0, 22.5), (0, 2, 4), strict=True):
            x, y = place, first
            for _ in range(side):
                x, y = -y, x
            plots.append((x, y, (kind + 2 * side) % 3 * 2))
        x, y = first + 8.0, first + 8.0
        for _ in range(side):
            x, y = -y, x
        plots.append((x, y, (1, 3)[side % 2]))
        for place in (-34.0, 2.0, 30.0):
            x, y = place, first + 32.0
            for _ in range(side):
                x, y = -y, x
            plots.append((x, y, (1, 3, 1)[(side + int(place > 10.0)) % 3]))
    return plots


def _add_trees_and_lamps() -> None:
    leaves, bark = matte("Leaves", pixels=paint.leaves(256), roughness=0.9), matte("Bark", (0.1, 0.065, 0.04))
    crown = add_object("Crown 1", projected(star_shape(_crown, 7), 2.2), leaves, smooth=True)
    trunk = add_object("Trunk 1", tube(np.array([[0, 0, -0.1], [0, 0, 2.4]]), [0.22, 0.15], 10, side=(1, 0, 0)), bark)
    bulb = add_object("Globe 1", ball(0.3, 14), emitter("Globe", (1.6, 1.45, 1.1)), smooth=True)
    post = smoothed([(0.0, 0.0), (0.22, 0.0), (0.2, 0.2), (0.08, 0.5), (0.06, 3.4), (0.16, 3.6), (0.0, 3.62)], 3)
    iron = matte("Iron", (0.04, 0.05, 0.05))
    lamp = add_object("Post 1", turned_profile(post, 14), iron, smooth=True)
    # (None in the quarter that the camera comes from.)
    quarters = ((-1, 1), (1, 1), (1, -1))
    places = [(sx * x, sy * y) for sx, sy in quarters for x, y in ((18.0, 8.0), (8.0, 18.0), (18.0, 18.0))]
    for index, (x, y) in enumerate(places):
        for part, height in ((crown, 4.1), (trunk, 0.0)):
            thing = part if index == 0 else copied(part)
            thing.location = (x, y, height)
            thing.rotation_euler = (0.0, 0.0, 1.7 * index)
    for index, angle in enumerate(np.radians(np.arange(0.0, 360.0, 45.0))):
        x, y = 13.0 * np.cos(angle), 13.0 * np.sin(angle)
        for part, height in ((bulb, 3.9), (lamp, 0.0)):
            thing = part if index == 0 else copied(part)
            thing.location = (x, y, height)


def _crown(directions: Float64Array) -> Float64Array:
    x, y, z = directions.T
    return 1.9 * (1.0 + 0.12 * np.sin(5.0 * x + 1.0) * np.sin(6.0 * y) * np.cos(5.0 * z) + 0.06 * np.sin(9.0 * (x - z)))


def _add_traffic() -> None:
    """Trucks and cars that drive past the square on all sides."""
    rubber = matte("Tire", (0.03, 0.03, 0.03))
    colors = ((0.6, 0.06, 0.04), (0.08, 0.25, 0.5), (0.75, 0.5, 0.05), (0.1, 0.35, 0.2))
    ring = SQUARE + 0.5 * STREET
    for number, color in enumerate(colors):
        paint_ = matte(f"Vehicle {number + 1}", color, roughness=0.5)
        for kind, (body, wheels) in enumerate((_truck(), _car())):
            offset = (-2.1, 2.1)[kind]
            parts = [add_object(f"Vehicle {number + 1}.{kind}", body, paint_), add_object("Wheels", wheels, rubber)]
            speed, begin = (36.0, -22.0) if kind == 0 else (-48.0, 26.0 - 4.0 * number)

            def pose(
                t: float, side: int = number, at: float = offset, v: float = speed, s: float = begin
            ) -> Float64Array:
                turn = 0.5 * np.pi * side
                along = s + v * t
                heading = turn + (0.0 if v > 0.0 else np.pi)
                c, sn = np.cos(turn), np.sin(turn)
                return placed((c * along + sn * (ring + at), sn * along - c * (ring + at), -0.12), heading)

            for part in parts:
                move(part, pose)


def _truck() -> tuple[Shape, Shape]:
    """(body, wheels) of a truck that drives along X."""
    body = [
        block((-3.4, -1.15, 0.9), (1.4, 1.15, 3.3), bevel=0.05),
        block((1.6, -1.1, 0.6), (3.3, 1.1, 2.6), bevel=0.2),
        block((-3.4, -0.9, 0.55), (3.3, 0.9, 0.9)),
    ]
    return joined(*body), joined(*(_wheel(x, y, 0.5) for x in (-2.4, -1.3, 2.4) for y in (-1.0, 1.0)))


def _car() -> tuple[Shape, Shape]:
    body = [
        block((-2.1, -0.85, 0.35), (2.1, 0.85, 1.0), bevel=0.18),
        block((-1.3, -0.75, 0.95), (0.9, 0.75, 1.55), bevel=0.22),
    ]
    return joined(*body), joined(*(_wheel(x, y, 0.34) for x in (-1.3, 1.35) for y in (-0.8, 0.8)))


def _wheel(x: float, y: float, radius: float) -> Shape:
    profile = [(0.0, -0.12), (0.8 * radius, -0.14), (radius, -0.1), (radius, 0.1), (0.8 * radius, 0.14), (0.0, 0.12)]
    return turned_profile(profile, 16).turned(0.5 * np.pi, 0).moved((x, y, radius))


def _add_saucer() -> bpy.types.Object:
    """The mirror, and what is on it: a cabin, lights under its rim, three legs."""
    shape = star_shape(saucer_radius, 48)
    directions = shape.positions / np.linalg.norm(shape.positions, axis=1, keepdims=True)
    normals = star_normals(saucer_radius, directions)
    saucer = add_object(SAUCER, shape, mirror("Polished metal"), smooth=True, normals=normals)
    cabin = [(1.75, 0.0), (1.7, 0.35), (1.35, 0.85), (0.75, 1.15), (0.0, 1.25)]
    teal = matte("Cabin", (0.02, 0.22, 0.24), roughness=0.4)
    dome = turned_profile(smoothed(cabin, 4), 48).moved((0.0, 0.0, 0.93 * HIGH))
    parts = [add_object("Cabin", dome, teal, smooth=True)]
    lights = []
    for angle in 2.0 * np.pi * np.arange(12) / 12:
        way = np.array([np.cos(angle), np.sin(angle), -0.16])
        way /= np.linalg.norm(way)
        out = float(saucer_radius(way[None])[0]) + 0.13
        lights.append(ball(0.12, 12).moved(out * way))
    parts.append(add_object("Lights", joined(*lights), emitter("Light", (4.0, 2.4, 0.7)), smooth=True))
    legs = []
    for angle in np.radians((30.0, 150.0, 270.0)):
        way = np.array([np.cos(angle), np.sin(angle), 0.0])
        path = np.array([1.9 * way - [0, 0, 0.925 * HIGH + 0.02], 2.7 * way - [0, 0, LANDED - 0.15]])
        legs.append(tube(path, [0.12, 0.1], 14, side=(-way[1], way[0], 0.0)))
        foot = turned_profile([(0.0, 0.0), (0.4, 0.0), (0.36, 0.1), (0.12, 0.16), (0.0, 0.16)], 20)
        legs.append(foot.moved(2.72 * way - [0, 0, LANDED - 0.015]))
    parts.append(add_object("Legs", joined(*legs), matte("Leg", (0.12, 0.12, 0.13), roughness=0.5), smooth=True))

    def pose(t: float) -> Float64Array:
        height = LANDED + (ABOVE - LANDED) * (1.0 - eased(min(t / 0.85, 1.0)))
        return placed((0.0, 0.0, height), 0.9 * (1.0 - t))

    for part in (saucer, *parts):
        move(part, pose)
    return saucer
