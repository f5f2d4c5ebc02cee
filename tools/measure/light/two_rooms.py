# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two rooms parted by a thin wall, a lamp in one of them, a mirror in the dark one: what gets through is wrong."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object, principled
from curvrefl.curvrefl_addon.demo.shapes import ball, box

ROOM, WALL, DEEP = 5.0, 0.05, 0.1
"""Side of a room, thickness of what is between the two and of all other walls, meters"""
MIRROR = "Mirror"


def build_rooms() -> None:
    """The lamp is below x = 0."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene: Any = bpy.context.scene
    scene.render.engine = "CYCLES"
    half = 0.5 * ROOM
    white = principled("white", (0.8, 0.8, 0.8), roughness=1.0)
    low, high = np.array([-ROOM, -half, 0.0]) - DEEP, np.array([ROOM + WALL, half, ROOM]) + DEEP
    for axis in range(3):
        for is_high in (False, True):
            first, last = low.copy(), high.copy()
            if is_high:
                first[axis] = high[axis] - DEEP
            else:
                last[axis] = low[axis] + DEEP
            add_object(
                f"side {axis} {is_high}", box((last - first).tolist()), white, location=(0.5 * (first + last)).tolist()
            )
    add_object("wall", box((WALL, ROOM, ROOM)), white, location=(0.5 * WALL, 0.0, half))
    light: Any = bpy.data.lights.new("lamp", "POINT")
    light.energy, light.shadow_soft_size = 500.0, 0.1
    lamp = bpy.data.objects.new("lamp", light)
    lamp.location = (-1.2, 1.5, 3.5)
    scene.collection.objects.link(lamp)
    mirror = principled("chrome", (1.0, 1.0, 1.0), 1.0, 0.0)
    add_object(MIRROR, ball(0.5, 64), mirror, True, (2.5, 0.5, 1.0))
    add_camera((4.8, -2.2, 3.2), (0.8, 0.8, 1.5), 20.0)


def places_in(dark: bool, count: int, lift: float) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) and (n, 3) random places on the six sides of a room, and their normals."""
    chance = np.random.default_rng(5)
    low = np.array([WALL if dark else -ROOM, -0.5 * ROOM, 0.0])
    places = low + ROOM * chance.random((count, 3))
    axis, is_high = chance.integers(0, 3, count), chance.random(count) < 0.5
    rows = np.arange(count)
    places[rows, axis] = low[axis] + ROOM * is_high
    normals = np.zeros((count, 3))
    normals[rows, axis] = np.where(is_high, -1.0, 1.0)
    return places + lift * normals, normals
