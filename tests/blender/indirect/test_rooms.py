# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light in rooms: a box with colored walls, two rooms with a slit between them, a ball lit by a wall alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object
from curvrefl.curvrefl_addon.demo.shapes import ball, plane
from indirect.places import Shown, add_box, add_mirror, at_rest, by_cycles, gray, inner, matte, moving, read, start
from lighting.room import add_lamp

pytestmark = pytest.mark.usefixtures("gpu")

ROOM, WALL = 5.0, 0.05
"""Side of a room, thickness of what is between two"""


def off_by(ours: np.ndarray, cycles: np.ndarray, chosen: np.ndarray) -> float:
    """Mean over pixels, as a share of Cycles'."""
    return float(ours[chosen].mean() / cycles[chosen].mean() - 1.0)


def cornell(lamp_is_mesh: bool) -> None:
    """An open box with a block and a mirror, lit from the ceiling: so close to it that a mesh's back lights nothing."""
    start(4)
    light, red, green = matte(gray(0.75)), matte((0.63, 0.06, 0.05)), matte((0.15, 0.48, 0.09))
    for name, low, high, material in (
        ("floor", (-1, -1, -0.1), (1, 1, 0), light),
        ("ceiling", (-1, -1, 2), (1, 1, 2.1), light),
        ("back", (-1, 1, -0.1), (1, 1.1, 2.1), light),
        ("left", (-1.1, -1, -0.1), (-1, 1.1, 2.1), red),
        ("right", (1, -1, -0.1), (1.1, 1.1, 2.1), green),
        ("block", (0.1, -0.5, 0), (0.6, 0, 0.6), light),
    ):
        add_box(name, low, high, material)
    add_mirror(0.4, (-0.4, 0.2, 0.4))
    if lamp_is_mesh:
        add_object("lamp", plane((0.5, 0.5)), matte(gray(0.0), gray(8.0)), location=(0.0, 0.0, 1.999))
    else:
        lamp = add_lamp("AREA", (0.0, 0.0, 1.98), 8.0 * np.pi * 0.25, size=0.5)
        lamp.rotation_euler = (0.0, 0.0, 0.0)
    add_camera((0.0, -3.8, 1.0), (0.0, 0.0, 1.0), 42.0)


@pytest.mark.parametrize("lamp_is_mesh", [True, False])
def test_box_with_colored_walls_has_cycles_light(lamp_is_mesh: bool) -> None:
    """On each wall, on the block and in the mirror."""
    cornell(lamp_is_mesh)
    shown, cycles = at_rest(64), by_cycles(256)
    x, y, z = np.moveaxis(shown.position, -1, 0)
    things = shown.is_thing
    in_block = (z > 0.01) & (np.abs(x - 0.35) < 0.26) & (np.abs(y + 0.25) < 0.26) & (z < 0.61)
    parts = {
        "floor": things & (z < 0.01),
        "back": things & (y > 0.99),
        "left": things & (x < -0.99),
        "right": things & (x > 0.99),
        "block": things & in_block,
        "ceiling": things & (z > 1.995),
        "mirror": shown.is_mirror,
    }
    parts = {name: inner(chosen) for name, chosen in parts.items()}
    # (The lamp's own outline in the mirror is the pixel filter's business.)
    ours, theirs = np.minimum(shown.picture, 0.5), np.minimum(cycles, 0.5)
    off = {name: off_by(ours, theirs, chosen) for name, chosen in parts.items()}
    assert all(chosen.sum() > 20 for chosen in parts.values())
    # (Cells of 7 cm: the lamp that shines is 2 cm below the ceiling, the block 60 cm high.)
    assert max(map(abs, off.values())) < (0.04 if lamp_is_mesh else 0.02), off
    # Each color by itself: red and green walls color what is beside them.
    everywhere = inner(shown.is_thing | shown.is_mirror)
    assert ours[everywhere].mean(axis=0) == pytest.approx(theirs[everywhere].mean(axis=0), rel=0.015)


def two_rooms(slit: float, in_dark: bool = True) -> None:
    """A lamp in the room below x = 0; the mirror and the eye in one of them."""
    start(8)
    white, deep = matte(gray(0.8)), 0.1
    half, far = 0.5 * ROOM, ROOM + WALL
    low, high = (-ROOM - deep, -half - deep, -deep), (far + deep, half + deep, ROOM + deep)
    for name, axis, is_high in (
        ("floor", 2, False),
        ("ceiling", 2, True),
        ("front", 1, False),
        ("back", 1, True),
        ("left", 0, False),
        ("right", 0, True),
    ):
        start_at, end = list(low), list(high)
        if is_high:
            start_at[axis] = high[axis] - deep
        else:
            end[axis] = low[axis] + deep
        add_box(name, start_at, end, white)
    if slit:
        add_box("wall", (0, -half, 0), (WALL, -0.5 * slit, ROOM), white)
        add_box("other wall", (0, 0.5 * slit, 0), (WALL, half, ROOM), white)
    else:
        add_box("wall", (0, -half, 0), (WALL, half, ROOM), white)
    lamp = add_lamp("POINT", (-1.2, 1.5, 3.5), 500.0, shadow_soft_size=0.1)
    lamp.visible_camera = False
    side = 1.0 if in_dark else -1.0
    add_mirror(0.5, (2.5 * side, 0.5, 1.0))
    add_camera((4.8 * side, -2.2, 3.2), (0.8 * side, 0.8, 1.5), 20.0)


def test_closed_wall_lets_nothing_through() -> None:
    """Of the lit room's light, not even at the foot of the wall."""
    two_rooms(0.0, in_dark=False)
    lit = at_rest().picture.mean()
    two_rooms(0.0)
    dark = at_rest()
    assert dark.is_thing.mean() > 0.8
    assert dark.picture.max() < 1e-4 * lit


def test_closed_wall_lets_nothing_through_while_the_view_moves() -> None:
    two_rooms(0.0, in_dark=False)
    lit = moving(*read()).picture.mean()
    two_rooms(0.0)
    assert moving(*read()).picture.max() < 1e-4 * lit


def test_slit_lets_through_what_cycles_says() -> None:
    """The dark room's walls and what its mirror shows."""
    two_rooms(0.3)
    shown, moved, cycles = at_rest(64), moving(*read()), by_cycles(192)
    things = inner(shown.is_thing)
    # (The slit itself shows the lit room.)
    things &= shown.position[..., 0] > 0.5 * WALL
    things &= cycles.mean(axis=-1) < 5.0 * np.median(cycles[things])
    assert off_by(shown.picture, cycles, things) == pytest.approx(0.0, abs=0.03)
    assert off_by(moved.picture, cycles, things) == pytest.approx(0.0, abs=0.1)


def ball_by_a_wall() -> Shown:
    """A spot lights a wall, and nothing else; beside that is a ball."""
    start(1)
    add_box("wall", (-4.0, -4.0, 0.0), (-3.9, 4.0, 8.0), matte(gray(0.8)))
    add_object("ball", ball(1.0, 64), matte(gray(0.6)), True, (0.0, 0.0, 3.0))
    spot = add_lamp("SPOT", (0.0, 0.0, 0.0), 2000.0, spot_size=1.6, spot_blend=0.2, shadow_soft_size=0.05)
    # Past the ball, away from it.
    spot.location = (-1.5, 0.0, 6.0)
    spot.rotation_euler = (0.0, np.radians(80.0), 0.0)
    add_mirror(0.3, (1.0, 2.5, 2.0))
    add_camera((-1.5, -7.0, 3.0), (-0.3, 0.0, 3.0), 60.0)
    return at_rest(64)


def test_ball_lit_by_a_wall_alone() -> None:
    """The half of it that the eye sees, and the part that faces the wall."""
    shown = ball_by_a_wall()
    cycles = by_cycles(512)
    on_ball = inner(shown.is_thing & (np.linalg.norm(shown.position - [0.0, 0.0, 3.0], axis=-1) < 1.01))
    facing = on_ball & (shown.normal[..., 0] < -0.3)
    assert facing.sum() > 100
    assert off_by(shown.picture, cycles, on_ball) == pytest.approx(0.0, abs=0.01)
    assert off_by(shown.picture, cycles, facing) == pytest.approx(0.0, abs=0.01)
    # What faces away has none.
    away = on_ball & (shown.normal[..., 0] > 0.5)
    assert shown.picture[away].mean() < 0.03 * shown.picture[facing].mean()


def test_light_comes_through_a_curtain() -> None:
    """A spot shines on a translucent board alone: what lights the floor has gone through it, and comes back."""
    start(3)
    curtain = matte(gray(0.8))
    tree: Any = curtain.node_tree
    through = tree.nodes.new("ShaderNodeBsdfTranslucent")
    through.inputs["Color"].default_value = (0.8, 0.8, 0.8, 1.0)
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(through.outputs[0], output.inputs["Surface"])
    add_object("floor", plane((6.0, 6.0)), matte(gray(0.6)))
    add_box("back", (-3.0, 3.0, 0.0), (3.0, 3.1, 4.0), matte(gray(0.6)))
    add_object("curtain", plane((2.5, 2.5)), curtain, location=(0.0, 0.0, 2.0))
    add_lamp("SPOT", (0.0, 0.0, 5.0), 1000.0, spot_size=0.5, shadow_soft_size=0.1)
    add_mirror(0.4, (1.5, 1.5, 0.5))
    add_camera((0.0, -6.0, 2.5), (0.0, 0.0, 1.2), 35.0)
    shown, cycles = at_rest(64), by_cycles(192)
    y, z = shown.position[..., 1], shown.position[..., 2]
    floor = inner(shown.is_thing & (z < 0.01))
    above = inner(shown.is_thing & (np.abs(z - 2.0) < 0.01) & (y < 2.0), 1)
    assert off_by(shown.picture, cycles, floor) == pytest.approx(0.0, abs=0.04)
    # (Few pixels, flat.)
    assert off_by(shown.picture, cycles, above) == pytest.approx(0.0, abs=0.1)
