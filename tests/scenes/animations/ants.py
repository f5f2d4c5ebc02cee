# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Four ants at a picnic, which look about: their eight eyes are mirrors. All is a hundred times its size, in meters."""

from __future__ import annotations

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo import paint
from curvrefl.curvrefl_addon.demo.data_blocks import add_object, add_sun, mirror, set_world_sky
from curvrefl.curvrefl_addon.demo.materials import matte
from curvrefl.curvrefl_addon.demo.shapes import (
    Shape,
    joined,
    plane,
    rotation,
    star_normals,
    star_shape,
    tube,
    turned_profile,
)
from curvrefl.curvrefl_addon.demo.table import smoothed
from curvrefl.curvrefl_addon.scene.arrays import Float64Array

from .stage import fly, mark, move, placed, start, through

EYES = tuple(f"Eye {number}" for number in range(1, 9))
EYE = np.array([0.1, 0.075, 0.12])
"""Half axes of an eye: forward, sideways, up"""
TOWARD_SUN = (-0.45, -0.6, 0.75)
ANTS: tuple[tuple[float, float, float], ...] = (
    (-0.95, 0.1, -1.25),
    (-0.36, 0.55, -1.75),
    (0.36, 0.5, -1.45),
    (0.98, 0.02, -2.0),
)
"""Place of each head on the cloth, and where it looks, radians about Z"""
NECK = 0.34
"""Height of a head's middle"""


def build() -> None:
    """Replace the open file by the film."""
    start()
    _add_picnic()
    eyes: list[bpy.types.Object] = []
    for number, (x, y, heading) in enumerate(ANTS):
        eyes += _add_ant(number, (x, y), heading)
    mark(*eyes)
    set_world_sky(TOWARD_SUN, strength=0.16)
    add_sun(TOWARD_SUN, 3.5, (1.0, 0.93, 0.83), angle=np.radians(1.5))
    eye = through((-0.75, -2.2, 1.0), (-0.3, -2.0, 0.8), (0.15, -1.9, 0.66), (0.45, -2.0, 0.74))
    target = through((0.0, 0.15, 0.3), (0.0, 0.2, 0.3), (0.02, 0.2, 0.32), (0.0, 0.2, 0.32))
    fly(eye, target, lens=32.0)


def _add_ant(number: int, place: tuple[float, float], heading: float) -> list[bpy.types.Object]:
    """Its body rests; its head turns with its two eyes, which are given back."""
    color = ((0.12, 0.03, 0.015), (0.045, 0.03, 0.025), (0.16, 0.055, 0.02), (0.05, 0.02, 0.015))[number]
    shell = matte(f"Shell {number + 1}", color, roughness=0.4)
    at = (place[0], place[1], 0.0)
    thorax = _egg((0.2, 0.11, 0.1), 10).moved((-0.33, 0.0, 0.27))
    waist = _egg((0.07, 0.05, 0.06), 6).moved((-0.55, 0.0, 0.26))
    abdomen = _egg((0.34, 0.2, 0.18), 10).turned(0.2, 1).moved((-0.9, 0.0, 0.36))
    legs = []
    for side in (-1.0, 1.0):
        for base, out in ((-0.22, 0.16), (-0.33, -0.12), (-0.43, -0.42)):
            knots = np.array(
                [
                    [base, 0.07 * side, 0.24],
                    [base + 0.45 * out, 0.27 * side, 0.4],
                    [base + 0.9 * out, 0.44 * side, 0.14],
                    [base + 1.2 * out, 0.55 * side, 0.012],
                    [base + 1.45 * out, 0.63 * side, 0.012],
                ]
            )
            legs.append(tube(_curve(knots, 5), np.linspace(0.026, 0.012, 21), 8, side=(1.0, 0.1, 0.3)))
    body = joined(thorax, waist, abdomen, *legs)
    add_object(f"Ant {number + 1}", body, shell, smooth=True, location=at, rotation=(0.0, 0.0, heading))
    head = [_egg((0.17, 0.17, 0.145), 12)]
    for side in (-1.0, 1.0):
        feeler = np.array([[0.13, 0.05, 0.08], [0.2, 0.1, 0.26], [0.3, 0.17, 0.3], [0.42, 0.22, 0.2]]) * [1, side, 1]
        head.append(tube(_curve(feeler, 6), np.linspace(0.014, 0.009, 19), 8, side=(0.1, 1.0, 0.2)))
        jaw = np.array([[0.12, 0.09, -0.06], [0.2, 0.08, -0.1], [0.25, 0.02, -0.11]]) * [1, side, 1]
        head.append(tube(_curve(jaw, 4), np.linspace(0.03, 0.008, 9), 8, side=(0.0, 0.2, 1.0)))
    parts = [add_object(f"Head {number + 1}", joined(*head), shell, smooth=True)]
    dark = mirror(f"Eye shell {number + 1}", (0.78, 0.8, 0.82))
    eyes = []
    for index, side in enumerate((-1.0, 1.0)):
        eyes.append(_eye(2 * number + index, side, dark))
    x, y = place

    def pose(t: float) -> Float64Array:
        phase = 2.0 * np.pi * (t + 0.23 * number)
        matrix = placed((x, y, NECK), heading + 0.32 * np.sin(phase))
        matrix[:3, :3] = matrix[:3, :3] @ rotation(0.14 * np.sin(1.0 + 2.0 * phase), 1)
        return matrix

    for part in (*parts, *eyes):
        move(part, pose)
    return eyes


def _eye(index: int, side: float, material: bpy.types.Material) -> bpy.types.Object:
    """An egg of a mirror, its middle where the head's side is."""
    turn, middle = rotation(0.75 * side), np.array([0.075, 0.118 * side, 0.045])

    def radius(directions: Float64Array) -> Float64Array:
        return 1.0 / np.linalg.norm(directions @ turn / EYE, axis=1)

    shape = star_shape(radius, 24)
    directions = shape.positions / np.linalg.norm(shape.positions, axis=1, keepdims=True)
    normals = star_normals(radius, directions)
    return add_object(EYES[index], shape.moved(middle), material, smooth=True, normals=normals)


def _egg(half: tuple[float, float, float], cells: int) -> Shape:
    shape = star_shape(lambda directions: np.ones(len(directions)), cells)
    return Shape(shape.positions * half, shape.polygons)


def _curve(knots: Float64Array, times: int) -> Float64Array:
    """Points on a smooth curve through knots (n, 3), `times` for each stretch."""
    path = through(*knots)
    # (At equal steps of the curve's own measure, which is eased at its ends.)
    return np.array([path(t) for t in np.linspace(0.0, 1.0, times * (len(knots) - 1) + 1)])


def _add_picnic() -> None:
    """A checked cloth with cans, a strawberry, crumbs and blades of grass."""
    cloth = matte("Cloth", pixels=paint.chequer(512, 12, (0.8, 0.13, 0.1), (0.9, 0.87, 0.8)), roughness=0.9)
    add_object("Cloth", plane((9.0, 9.0), (24, 24), tile=4.5), cloth)
    grass = matte("Meadow", pixels=paint.leaves(256), roughness=0.9)
    add_object("Meadow", plane((80.0, 80.0), (20, 20), tile=5.0), grass, location=(0.0, 0.0, -0.05))
    can = [(0.0, 0.03), (0.25, 0.05), (0.28, 0.0), (0.36, 0.14), (0.36, 1.2), (0.3, 1.34), (0.3, 1.37), (0.27, 1.34)]
    tin = smoothed([*can, (0.0, 1.33)], 4)
    colors = ((0.04, 0.22, 0.5), (0.1, 0.4, 0.16), (0.72, 0.42, 0.04), (0.5, 0.05, 0.28))
    for number, (x, y) in enumerate(((-1.5, 1.35), (1.6, 1.2), (-1.5, -2.5), (1.75, -2.0)), 1):
        paint_ = matte(f"Can {number}", pixels=paint.segments(256, 64, [colors[number - 1], (0.86, 0.85, 0.82)] * 3))
        shape = turned_profile(tin, 44)
        add_object(f"Can {number}", _wrapped(shape), paint_, smooth=True, location=(x, y, 0.0), rotation=(0, 0, number))
    red = matte("Strawberry", (0.6, 0.025, 0.02), roughness=0.5)
    where, turn = (0.05, 1.5, 0.36), (2.3, 0.25, 0.3)
    add_object("Strawberry", star_shape(_berry, 18), red, smooth=True, location=where, rotation=turn)
    sepals = []
    for angle in 2.0 * np.pi * np.arange(7) / 7:
        t = np.linspace(0.0, 1.0, 7)
        path = np.column_stack([0.04 + 0.3 * t, np.zeros(7), 0.47 - 0.1 * t + 0.1 * t**3])
        sepals.append(tube(path, 0.06 * np.sin(np.pi * (0.1 + 0.88 * t)), 8, side=(0, 1, 0)).turned(angle))
    green = matte("Sepals", (0.1, 0.33, 0.06), roughness=0.7)
    add_object("Sepals", joined(*sepals), green, smooth=True, location=where, rotation=turn)
    rng = np.random.default_rng(4)
    crumbs = []
    for _ in range(20):
        size = rng.uniform(0.02, 0.06)
        bumps = rng.uniform(1.5, 4.0, 3)

        def lumpy(directions: Float64Array, size: float = size, bumps: Float64Array = bumps) -> Float64Array:
            return size * (1.0 + 0.25 * np.sin(directions @ bumps * 2.0))

        x, y = rng.uniform(-1.6, 1.6), rng.uniform(-1.3, 1.6)
        crumbs.append(star_shape(lumpy, 4).moved((x, y, 0.5 * size)))
    add_object("Crumbs", joined(*crumbs), matte("Crumb", (0.55, 0.36, 0.17), roughness=0.95), smooth=True)
    blades = []
    for _ in range(120):
        angle, far = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(5.2, 9.0)
        tall, lean = rng.uniform(1.5, 4.0), rng.uniform(-0.6, 0.6, 2)
        t = np.linspace(0.0, 1.0, 7)
        path = np.column_stack([lean[0] * t * t * tall, lean[1] * t * t * tall, tall * t])
        blades.append(
            tube(path, 0.07 * (1.02 - t), 5, side=(0.3, 1.0, 0.1)).moved(
                (far * np.cos(angle), far * np.sin(angle), -0.05)
            )
        )
    add_object("Grass", joined(*blades), matte("Blade", (0.12, 0.3, 0.05), roughness=0.7), smooth=True)


def _wrapped(shape: Shape) -> Shape:
    """A turned shape with UVs once round it."""
    uv = []
    top = shape.positions[:, 2].max()
    for polygon in shape.polygons:
        points = shape.positions[list(polygon)]
        u = np.arctan2(points[:, 1], points[:, 0]) / (2.0 * np.pi)
        u += (u.max() - u > 0.5).astype(float)
        uv.append(np.column_stack([u, 0.1 + 0.8 * points[:, 2] / top]))
    return Shape(shape.positions, shape.polygons, np.concatenate(uv))


def _berry(directions: Float64Array) -> Float64Array:
    z = directions[:, 2]
    seeds = np.cos(14.0 * np.arctan2(directions[:, 1], directions[:, 0])) * np.cos(16.0 * z)
    return 0.36 * (1.0 + 0.2 * z - 0.035 * seeds * (1.0 - z * z))
