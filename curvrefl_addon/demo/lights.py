# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What shines in the room: a table lamp, a neon sign and a candle as meshes, an area lamp in a pendant shade."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ..scene.arrays import Float64Array
from .data_blocks import add_object, emitter
from .materials import glowing, matte
from .room import BACK, CEILING
from .shapes import Shape, ball, joined, tube, turned_profile
from .table import smoothed

WARM = (1.0, 0.62, 0.32)
NEON = (1.0, 0.2, 0.16)
PENDANT = (0.75, -1.6)
"""Place of the pendant, over the rug"""


def add_lights() -> None:
    """All that is in the room; sun and sky are outside of it."""
    _add_table_lamp((-0.57, 0.42))
    _add_neon_sign((0.085, 0.36))
    _add_candle((0.42, -0.02))
    _add_pendant()


def _add_table_lamp(place: tuple[float, float]) -> None:
    """A foot of earthenware, a bulb, and a shade that glows from it, open above and below."""
    x, y = place
    foot = [(0.0, 0.0), (0.06, 0.0), (0.064, 0.01), (0.04, 0.03), (0.058, 0.085), (0.048, 0.13), (0.014, 0.165)]
    foot += [(0.011, 0.215), (0.0, 0.216)]
    clay = matte("Glazed foot", (0.1, 0.23, 0.24), roughness=0.7)
    add_object("Lamp foot", turned_profile(smoothed(foot, 4), 36), clay, smooth=True, location=(x, y, 0.0))
    shade = turned_profile([(0.118, 0.2), (0.078, 0.36)], 48)
    add_object("Lamp shade", shade, glowing("Lamp shade", WARM, 0.9), smooth=True, location=(x, y, 0.0))
    bulb = ball(0.026, 20).moved((0.0, 0.0, 0.25))
    add_object("Bulb", bulb, emitter("Bulb", _times(WARM, 14.0)), smooth=True, location=(x, y, 0.0))


def _add_neon_sign(place: tuple[float, float]) -> None:
    """A steaming cup of glass tubes on the wall, a hand's breadth from it."""
    t = np.linspace(0.0, 1.0, 25)
    turn = np.pi * t
    cup = _flat(-0.06 * np.cos(turn), 0.005 - 0.078 * np.sin(turn) ** 0.8)
    handle = _flat(0.054 + 0.038 * np.sin(turn), 0.024 * np.cos(turn) - 0.024)
    saucer = _flat(-0.08 + 0.16 * t, -0.09 - 0.008 * np.sin(turn))
    steam = [_flat(x + 0.009 * np.sin(7.0 * t), 0.03 + 0.07 * t) for x in (-0.03, 0.0, 0.03)]
    red = joined(*(_glass_tube(path) for path in (cup, handle, saucer)))
    where = (place[0], BACK - 0.025, place[1])
    add_object("Neon cup", red, emitter("Neon red", _times(NEON, 7.0)), smooth=True, location=where)
    white = joined(*(_glass_tube(path) for path in steam))
    add_object("Neon steam", white, emitter("Neon white", (3.2, 3.6, 4.2)), smooth=True, location=where)


def _flat(across: Float64Array, up: Float64Array) -> Float64Array:
    """Points (n, 3) in the plane of the wall."""
    return np.column_stack([across, np.zeros(len(across)), up])


def _glass_tube(path: Float64Array) -> Shape:
    return tube(path, np.full(len(path), 0.0035), 8, side=(0.0, 1.0, 0.0))


def _add_candle(place: tuple[float, float]) -> None:
    """A candle on a dish, and its flame."""
    x, y = place
    dish = turned_profile([(0.0, 0.0), (0.038, 0.0), (0.048, 0.009), (0.046, 0.01), (0.036, 0.004), (0.0, 0.004)], 32)
    wax = turned_profile(
        [(0.0, 0.004), (0.022, 0.004), (0.022, 0.082), (0.02, 0.085), (0.008, 0.081), (0.0, 0.081)], 28
    )
    add_object("Candle dish", dish, matte("Dark clay", (0.1, 0.09, 0.085)), smooth=True, location=(x, y, 0.0))
    add_object("Candle", wax, matte("Wax", (0.8, 0.7, 0.52)), smooth=True, location=(x, y, 0.0))
    flame = [(0.0, 0.089), (0.0045, 0.094), (0.0062, 0.101), (0.0045, 0.111), (0.0018, 0.121), (0.0, 0.128)]
    light = emitter("Flame", _times((1.0, 0.55, 0.2), 12.0))
    add_object("Flame", turned_profile(smoothed(flame, 2), 14), light, smooth=True, location=(x, y, 0.0))


def _add_pendant() -> None:
    """A dome on a cord, dark outside and white inside, with a round area lamp in it."""
    x, y = PENDANT
    height = 0.72
    outside = smoothed([(0.24, 0.0), (0.225, 0.06), (0.16, 0.13), (0.06, 0.17), (0.0, 0.176)], 4)
    inside = [(radius * 0.97, up - 0.006 if radius < 0.2 else up) for radius, up in outside]
    dark = matte("Dark enamel", (0.035, 0.06, 0.065), roughness=0.7)
    white = matte("White enamel", (0.82, 0.8, 0.76), roughness=0.7)
    dome, lining = turned_profile(outside, 48), turned_profile(inside, 48)
    add_object("Pendant", dome, dark, smooth=True, location=(x, y, height))
    turned = tuple(polygon[::-1] for polygon in lining.polygons)
    add_object("Pendant lining", Shape(lining.positions, turned), white, smooth=True, location=(x, y, height))
    cord = tube(np.array([[x, y, height + 0.17], [x, y, CEILING]]), [0.004, 0.004], 8, side=(0.0, 1.0, 0.0))
    add_object("Cord", cord, dark)
    lamp: Any = bpy.data.lights.new("Pendant lamp", "AREA")
    lamp.shape, lamp.size, lamp.energy, lamp.color = "DISK", 0.3, 22.0, (1.0, 0.74, 0.48)
    placed = bpy.data.objects.new("Pendant lamp", lamp)
    placed.location = (x, y, height + 0.05)
    scene = bpy.context.scene
    assert scene is not None
    scene.collection.objects.link(placed)


def _times(color: tuple[float, float, float], strength: float) -> tuple[float, float, float]:
    red, green, blue = color
    return (red * strength, green * strength, blue * strength)
