# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The ten scenes of the data set, each made by a script out of numbers, so that it is the same everywhere."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ...demo import paint
from ...demo.data_blocks import (
    add_camera,
    add_object,
    add_sun,
    mirror,
    packed_image,
    principled,
    set_world_color,
    start_empty_scene,
)
from ...demo.scene import MIRRORS as OF_DEMO
from ...demo.scene import build_demo
from ...demo.shapes import RadiusFunction, Shape, ball, box, cube_sphere_directions, plane, star_normals
from ...scene.arrays import Float64Array

MIRROR = "Mirror"
CELLS = 64
"""Along an edge of the six faces of star-shaped mirrors: 49,152 triangles"""
SKY = (0.32, 0.42, 0.6)
EYE, TARGET = (0.0, -5.6, 1.5), (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Entry:
    """One scene of the set."""

    text: str
    """What is to be seen in it"""
    build: Callable[[Path], None]
    """Replaces the open file by the scene; may save it at the path"""
    mirrors: tuple[str, ...] = (MIRROR,)
    surface: dict[str, Any] = field(default_factory=dict)
    """The mirror as a formula, in its object's space, where it has one; its mesh is what the references are of"""


def _surroundings(floor: float) -> None:
    """A chequered floor at this height, boxes and balls on it and in the air about a mirror of size 1 at the origin, by
    dice of one seed, a slab close to the mirror, and a chequered wall behind the eye."""
    tiles = packed_image("Tiles", paint.chequer(256, 8, (0.80, 0.77, 0.70), (0.30, 0.36, 0.42)))
    add_object("Floor", plane((16.0, 16.0), (8, 8), tile=4.0), principled("Tiles", image=tiles), location=(0, 0, floor))
    random = np.random.default_rng(11)
    colors = [(0.7, 0.06, 0.05), (0.06, 0.22, 0.65), (0.85, 0.5, 0.04), (0.08, 0.42, 0.12), (0.45, 0.08, 0.5)]
    paints = [principled(f"Paint {number + 1}", color) for number, color in enumerate(colors)]
    angles = np.radians([-140.0, -112.0, -64.0, -35.0, 5.0, 48.0, 95.0, 140.0, 178.0])
    for number, angle in enumerate(angles.tolist()):
        distance, size = random.uniform(1.7, 3.4), random.uniform(0.3, 0.6)
        place = (distance * np.cos(angle), distance * np.sin(angle), floor + 0.5 * size)
        if number % 2:
            turn = (0.0, 0.0, random.uniform(0.0, np.pi))
            add_object(f"Box {number}", box((size, size, size)), paints[number % 5], location=place, rotation=turn)
        else:
            add_object(f"Ball {number}", ball(0.5 * size, 48), paints[number % 5], smooth=True, location=place)
    for number, angle in enumerate(np.linspace(-2.9, 2.9, 11).tolist()):
        distance, height = random.uniform(2.0, 3.2), random.uniform(0.7, 2.8)
        place = (distance * np.cos(angle), distance * np.sin(angle), height)
        # (None is before the eye.)
        place = (place[0] + np.copysign(0.9, place[0]), place[1], place[2])
        turn = tuple(random.uniform(0.0, np.pi, 3).tolist())
        add_object(f"Die {number}", box((0.45, 0.45, 0.45)), paints[(number + 2) % 5], location=place, rotation=turn)
    stripes = packed_image("Wall", paint.chequer(256, 6, (0.75, 0.45, 0.3), (0.9, 0.85, 0.7)))
    turned = (-0.5 * np.pi, 0.0, 0.0)
    wall = principled("Wall", image=stripes)
    add_object("Wall", plane((14.0, 5.0), (7, 3), tile=3.5), wall, location=(0.0, -7.5, floor + 2.5), rotation=turned)
    add_object("Slab", box((0.5, 0.2, 0.6)), paints[1], location=(0.75, -1.1, floor + 0.3))


def _star(
    radius: RadiusFunction, material: bpy.types.Material, name: str = MIRROR, cells: int = CELLS
) -> bpy.types.Object:
    """A star-shaped body about the origin, with the surface's own normals."""
    directions, quads = cube_sphere_directions(cells)
    shape = Shape(directions * radius(directions)[:, None], quads)
    return add_object(name, shape, material, smooth=True, normals=star_normals(radius, directions))


def _lit(
    eye: tuple[float, float, float] = EYE, target: tuple[float, float, float] = TARGET, lens: float = 58.0
) -> None:
    set_world_color(SKY)
    add_sun((-0.5, -0.6, 0.9), 3.0, angle=0.05)
    add_camera(eye, target, lens=lens)


def _ellipsoid(a: float, b: float, c: float) -> RadiusFunction:
    axes = np.array([a, b, c])
    return lambda directions: 1.0 / np.linalg.norm(directions / axes, axis=1)


def _of_star(
    radius: RadiusFunction, floor: float, material: Callable[[], bpy.types.Material] = lambda: mirror(MIRROR)
) -> Callable[[Path], None]:
    def build(_: Path) -> None:
        start_empty_scene()
        _star(radius, material())
        _surroundings(floor)
        _lit()

    return build


def _bumps(directions: Float64Array) -> Float64Array:
    x, y, z = directions.T
    waves = np.sin(4.0 * x + 0.5) * np.cos(3.0 * y) + 0.7 * np.sin(5.0 * z + 1.0) * np.cos(3.0 * x)
    return 1.0 + 0.06 * waves


def _torus(_: Path) -> None:
    ring, tube, around = 0.7, 0.3, (192, 96)
    start_empty_scene()
    a, b = np.meshgrid(*(np.arange(count) * (2.0 * np.pi / count) for count in around), indexing="ij")
    normals = np.stack([np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)], -1).reshape(-1, 3)
    centers = ring * np.stack([np.cos(a), np.sin(a), np.zeros_like(a)], -1).reshape(-1, 3)
    index = np.arange(a.size).reshape(a.shape)
    after = np.roll(index, -1, 0)
    quads = np.stack([index, after, np.roll(after, -1, 1), np.roll(index, -1, 1)], -1).reshape(-1, 4)
    shape = Shape(centers + tube * normals, tuple(map(tuple, quads.tolist())))
    add_object(MIRROR, shape, mirror(MIRROR), smooth=True, normals=normals, rotation=(0.9, 0.0, 0.0))
    _surroundings(-1.01)
    _lit()


def _bowl(_: Path) -> None:
    start_empty_scene()
    directions, quads = cube_sphere_directions(CELLS)
    lower = tuple(quad for quad in quads if directions[list(quad), 2].max() < 0.1)
    shape = Shape(directions, lower)
    add_object(MIRROR, shape, mirror(MIRROR), smooth=True, normals=directions, rotation=(0.6, 0.0, 0.0))
    _surroundings(-1.01)
    _lit()


def _sheet(_: Path) -> None:
    """A height field over a square, standing upright: it bends both ways, and is open."""
    start_empty_scene()
    count = 129
    x, y = (side.ravel() for side in np.meshgrid(np.linspace(-1.3, 1.3, count), np.linspace(-1.0, 1.0, count)))
    height = 0.16 * np.sin(2.1 * x + 0.4) * np.cos(1.7 * y) + 0.1 * np.cos(2.6 * y - x)
    slope_x = 0.16 * 2.1 * np.cos(2.1 * x + 0.4) * np.cos(1.7 * y) + 0.1 * np.sin(2.6 * y - x)
    slope_y = -0.16 * 1.7 * np.sin(2.1 * x + 0.4) * np.sin(1.7 * y) - 0.26 * np.sin(2.6 * y - x)
    normals = np.column_stack([-slope_x, -slope_y, np.ones_like(x)])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    index = np.arange(count * count).reshape(count, count)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], -1).reshape(-1, 4)
    shape = Shape(np.column_stack([x, y, height]), tuple(map(tuple, quads.tolist())))
    turned = (0.5 * np.pi, 0.0, 0.0)
    add_object(MIRROR, shape, mirror(MIRROR), smooth=True, normals=normals, rotation=turned, location=(0.0, 0.4, 0.0))
    _surroundings(-1.01)
    _lit()


def _two_mirrors(_: Path) -> None:
    start_empty_scene()
    first = _star(_ellipsoid(0.75, 0.75, 0.75), mirror("Chrome"), "Left mirror")
    first.location = (-0.85, 0.0, -0.25)
    second = _star(_ellipsoid(0.6, 0.5, 0.9), mirror("Copper", (0.95, 0.64, 0.54)), "Right mirror")
    second.location = (0.8, 0.1, -0.1)
    _surroundings(-1.01)
    _lit()


def _rough() -> bpy.types.Material:
    return principled(MIRROR, (0.93, 0.8, 0.6), metallic=1.0, roughness=0.25)


def _glass() -> bpy.types.Material:
    return principled(MIRROR, (1.0, 1.0, 1.0), roughness=0.0, sockets={"Transmission Weight": 1.0, "IOR": 1.45})


_SPHERE = {"kind": "ellipsoid", "semi_axes": [1.0, 1.0, 1.0]}

SCENES: dict[str, Entry] = {
    "sphere": Entry(
        "The unit ball, convex: one image of each point", _of_star(_ellipsoid(1, 1, 1), -1.01), surface=_SPHERE
    ),
    "ellipsoid": Entry(
        "An ellipsoid, strongly curved at its rim",
        _of_star(_ellipsoid(1.6, 0.5, 0.8), -0.81),
        surface={"kind": "ellipsoid", "semi_axes": [1.6, 0.5, 0.8]},
    ),
    "torus": Entry(
        "A ring, which shows itself",
        _torus,
        surface={"kind": "torus", "ring_radius": 0.7, "tube_radius": 0.3, "axis": [0.0, 0.0, 1.0]},
    ),
    "bowl": Entry(
        "Half a ball, open and hollow: it shows itself, upside down",
        _bowl,
        surface={"kind": "ellipsoid", "semi_axes": [1.0, 1.0, 1.0], "only": "z < 0.1, by whole quads"},
    ),
    "bumpy": Entry(
        "A ball with humps and dents: several images of a point, which meet at caustics",
        _of_star(_bumps, -1.1),
        surface={
            "kind": "star",
            "radius": "1 + 0.06 (sin(4 x + 0.5) cos(3 y) + 0.7 sin(5 z + 1) cos(3 x)) of the unit direction (x, y, z)",
        },
    ),
    "sheet": Entry(
        "A free-form sheet that bends both ways, open",
        _sheet,
        surface={
            "kind": "height",
            "z": "0.16 sin(2.1 x + 0.4) cos(1.7 y) + 0.1 cos(2.6 y - x), |x| < 1.3, |y| < 1",
        },
    ),
    "two": Entry("Two mirrors that show each other", _two_mirrors, ("Left mirror", "Right mirror")),
    "rough": Entry(
        "Rough metal: positions are those of a sharp mirror, the light is not",
        _of_star(_ellipsoid(1, 1, 1), -1.01, _rough),
        surface=_SPHERE,
    ),
    "glass": Entry(
        "A glass ball: positions are those of its first reflection",
        _of_star(_ellipsoid(1, 1, 1), -1.01, _glass),
        surface=_SPHERE,
    ),
    "interior": Entry("The demo: a kettle and a jar in a furnished room", build_demo, OF_DEMO),
}
"""By name, in the order of the documents"""
