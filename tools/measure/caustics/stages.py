# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that are all about what mirrors and glass throw on other things, each in an empty file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import radians
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo.data_blocks import add_object, principled
from curvrefl.curvrefl_addon.demo.shapes import Shape, ball, box, plane, surface, turned_profile
from mathutils import Vector

type Build = Callable[[], tuple[str, ...]]
"""Makes the scene; returns its mirrors"""
SUN_ANGLE = radians(0.53)


def start(world: float = 0.02) -> None:
    """An empty file in which Cycles follows all caustics."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene: Any = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.view_settings.view_transform = "Standard"
    cycles = scene.cycles
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    # (What is thrown on a table is for Cycles a bounce off that.)
    cycles.diffuse_bounces = 1
    cycles.max_bounces, cycles.glossy_bounces, cycles.transmission_bounces = 16, 8, 16
    scene.world = bpy.data.worlds.new("world")
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (world, world, 1.2 * world, 1.0)


def white(value: float = 0.8) -> Any:
    """Matt."""
    return principled("white", (value, value, value), roughness=1.0, sockets={"Specular IOR Level": 0.0})


def metal(color: tuple[float, float, float] = (0.95, 0.93, 0.9)) -> Any:
    """Sharp."""
    return principled("metal", color, 1.0, 0.0)


def _turned(thing: Any, place: Sequence[float], target: Sequence[float]) -> None:
    thing.location = place
    thing.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    scene: Any = bpy.context.scene
    scene.collection.objects.link(thing)


def camera(place: Sequence[float], target: Sequence[float], lens: float) -> None:
    """The scene's."""
    eye = bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    _turned(eye, place, target)
    known: Any = eye.data
    known.lens = lens
    scene: Any = bpy.context.scene
    scene.camera = eye


def lamp(kind: Any, place: Sequence[float], target: Sequence[float], energy: float, **settings: Any) -> Any:
    """One that shines from a place to another."""
    light: Any = bpy.data.lights.new(str(kind).title(), kind)
    light.energy = energy
    for name, value in settings.items():
        setattr(light, name, value)
    made: Any = bpy.data.objects.new(light.name, light)
    _turned(made, place, target)
    return made


def ring() -> tuple[str, ...]:
    """A gold ring on a table: the nephroid's cusp inside, wide arcs outside."""
    start()
    add_object("Table", plane((8.0, 8.0)), white())
    profile = [(1.0, 0.0), (1.06, 0.0), (1.06, 0.5), (1.0, 0.5), (1.0, 0.0)]
    band = add_object("Ring", turned_profile(profile, 256), metal((1.0, 0.76, 0.33)), True, (0.0, 0.0, 0.001))
    _sharp_edges(band)
    lamp("SUN", (3.0, -1.0, 2.2), (0.0, 0.0, 0.0), 3.0, angle=SUN_ANGLE)
    camera((0.0, -3.0, 3.4), (0.05, 0.0, 0.1), 45.0)
    return ("Ring",)


def disco() -> tuple[str, ...]:
    """A disco ball in a room: each of its facets throws the lamp on a wall."""
    start(0.01)
    walls = white()
    room = box((9.0, 9.0, 4.5))
    inside = Shape(room.positions, tuple(tuple(reversed(polygon)) for polygon in room.polygons))
    add_object("Room", inside, walls, location=(0.0, 0.0, 2.25))
    add_object("Ball", ball(0.5, 40), metal(), location=(0.0, 0.6, 2.3))
    lamp("SPOT", (2.2, -2.4, 3.6), (0.0, 0.6, 2.3), 4000.0, spot_size=radians(14.5), shadow_soft_size=0.03)
    # (The rest of the room: mirrors do not see it, so that they throw nothing of it.)
    fill = lamp("POINT", (0.0, -3.5, 2.5), (0.0, 0.0, 0.0), 60.0, shadow_soft_size=0.5)
    fill.visible_glossy = False
    camera((0.0, -4.1, 1.7), (0.0, 1.0, 2.0), 20.0)
    return ("Ball",)


def bowl() -> tuple[str, ...]:
    """A polished bowl with milk in it, on which the sun shines by way of its wall: a cusp."""
    start()
    add_object("Table", plane((8.0, 8.0)), white())
    angles = np.linspace(0.0, 1.15, 97)
    inner, outer = (np.stack([r * np.sin(angles), 1.06 - r * np.cos(angles)], axis=1) for r in (1.0, 1.05))
    profile = np.concatenate([outer, inner[::-1]])
    made = add_object("Bowl", turned_profile(profile.tolist(), 192), metal(), True)
    _sharp_edges(made)
    level = 0.45
    reach = float(np.sqrt(1.0 - (1.06 - level) ** 2)) - 1e-3
    add_object("Milk", turned_profile([(0.0, level), (reach, level)], 96), white())
    lamp("SUN", (2.4, -0.8, 2.2), (0.0, 0.0, 0.0), 2.0, angle=SUN_ANGLE)
    camera((0.0, -2.2, 2.7), (0.0, 0.03, 0.5), 50.0)
    return ("Bowl",)


def wine_glass() -> tuple[str, ...]:
    """A wine glass in low sun, and a steel ball beside it."""
    start()
    add_object("Table", plane((10.0, 10.0)), white())
    outer = [(0.0, 0.0), (0.40, 0.0), (0.42, 0.02), (0.10, 0.07), (0.05, 0.2), (0.045, 0.5), (0.07, 0.58)]
    outer += [(0.24, 0.68), (0.38, 0.86), (0.43, 1.08), (0.42, 1.28), (0.385, 1.5)]
    inner = [(0.365, 1.5), (0.40, 1.28), (0.41, 1.08), (0.36, 0.88), (0.22, 0.71), (0.0, 0.64)]
    profile = np.concatenate([_smoothed(outer, 12), _smoothed(inner, 12)])
    glass = principled("glass", (1.0, 1.0, 1.0), 0.0, 0.0, sockets={"Transmission Weight": 1.0, "IOR": 1.5})
    add_object("Glass", turned_profile(profile.tolist(), 128), glass, True, (0.0, 0.0, 0.002))
    add_object("Ball", ball(0.2, 96), metal(), True, (0.75, -0.55, 0.2))
    lamp("SUN", (2.5, 2.0, 2.3), (0.0, 0.0, 0.0), 3.0, angle=SUN_ANGLE)
    camera((-0.6, -4.4, 2.4), (-0.35, -0.2, 0.45), 50.0)
    return ("Ball",)


def facade() -> tuple[str, ...]:
    """A hollow facade of glass panes that gathers the sun in the street."""
    start(0.05)
    add_object("Street", plane((90.0, 90.0)), white(0.3))
    turn = np.linspace(-0.55, 0.55, 97)
    rise = np.linspace(0.0, 16.0, 17)
    points = np.empty((len(rise), len(turn), 3))
    points[..., 0], points[..., 1] = 24.0 * np.sin(turn), 24.0 * np.cos(turn) - 10.0
    points[..., 2] = rise[:, None]
    add_object("Facade", surface(points), metal((0.75, 0.82, 0.88)), True)
    for number in range(5):
        place = (-9.0 + 4.4 * number, 1.5 - 1.5 * (number % 2), 0.7)
        add_object("Car", box((3.2, 1.5, 1.4), 0.1), white(0.6), location=place)
    lamp("SUN", (3.0, -18.0, 11.0), (0.0, 0.0, 0.0), 2.5, angle=SUN_ANGLE)
    camera((-21.0, -22.0, 17.0), (1.0, 4.0, 2.0), 36.0)
    return ("Facade",)


STAGES: dict[str, Build] = {"ring": ring, "bowl": bowl, "disco": disco, "glass": wine_glass, "facade": facade}


def _smoothed(points: Sequence[tuple[float, float]], steps: int) -> Any:
    """A Catmull-Rom curve through the points, so many places between two."""
    given = np.array([points[0], *points, points[-1]], float)
    t = np.linspace(0.0, 1.0, steps, endpoint=False)[:, None]
    parts = []
    for a, b, c, d in zip(given, given[1:], given[2:], given[3:], strict=False):
        parts.append(b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a))))
    curve = np.concatenate([*parts, given[-1:]])
    curve[:, 0] = np.maximum(curve[:, 0], 0.0)
    return curve


def _sharp_edges(thing: Any) -> None:
    """Corners of a turned profile stay corners."""
    thing.data.set_sharp_from_angle(angle=radians(40.0))
