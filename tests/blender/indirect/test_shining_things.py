# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that shine light a floor as their outlines say, however they are made of triangles and colored."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object, packed_image, principled
from curvrefl.curvrefl_addon.demo.shapes import Shape, ball, plane, turned_profile
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from indirect.places import (
    Shown,
    add_mirror,
    at_rest,
    by_cycles,
    gray,
    inner,
    matte,
    moving,
    read,
    start,
)

pytestmark = pytest.mark.usefixtures("gpu")
ALBEDO, HEIGHT, WIDTH, DEPTH = 0.6, 1.5, 1.2, 0.8
"""Of the floor; where the lamp hangs, and its size"""


def corner_factor(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Form factor from a place to a level rectangle whose corner is over it, sides in parts of its height."""
    root_a, root_b = np.sqrt(1 + a * a), np.sqrt(1 + b * b)
    return (a / root_a * np.arctan(b / root_a) + b / root_b * np.arctan(a / root_b)) / (2 * np.pi)


def rectangle_light(
    position: np.ndarray,
    low: tuple[float, float] = (-WIDTH / 2, -DEPTH / 2),
    high: tuple[float, float] = (WIDTH / 2, DEPTH / 2),
) -> np.ndarray:
    """Radiance of the floor at places (.., 3), of a lamp of radiance 1 between two corners."""
    x, y = position[..., 0], position[..., 1]
    sides = [((high[0] - x) / HEIGHT, 1.0), ((low[0] - x) / HEIGHT, -1.0)]
    ends = [((high[1] - y) / HEIGHT, 1.0), ((low[1] - y) / HEIGHT, -1.0)]
    return ALBEDO * sum(s * t * corner_factor(a, b) for a, s in sides for b, t in ends)


def disk_light(position: np.ndarray, radius: float) -> np.ndarray:
    """The same of a level disk, for places off its axis (Siegel and Howell, "Thermal Radiation", configuration 13)."""
    off = np.hypot(position[..., 0], position[..., 1]) / HEIGHT
    size = radius / HEIGHT
    z = 1 + off**2 - size**2
    return ALBEDO * 0.5 * (1 - z / np.sqrt(z * z + 4 * size * size))


@pytest.fixture(autouse=True)
def empty_file() -> None:
    start(0)


def floor_under(lamp: Shape | None, material: bpy.types.Material, **flags: Any) -> Any:
    """A floor, a mirror beside the light, and the lamp's object."""
    add_object("floor", plane((6.0, 6.0)), matte(gray(ALBEDO)))
    add_mirror(0.4, (1.2, 1.0, 0.5))
    made: Any = add_object("lamp", lamp or plane((WIDTH, DEPTH)), material, location=(0.0, 0.0, HEIGHT))
    for name, value in flags.items():
        setattr(made, name, value)
    add_camera((0.0, -3.5, 3.0), (0.2, 0.2, 0.2), 45.0)
    return made


def on_floor(shown: Shown) -> np.ndarray:
    return inner(shown.is_thing & (np.abs(shown.position[..., 2]) < 1e-3))


def agrees(shown: Shown, expected: np.ndarray, noise: float = 1.0) -> None:
    """On the mean to a hundredth, in each part of the picture a little less well; `noise`: in parts of that."""
    floor = on_floor(shown)
    assert floor.sum() > 2000
    found = shown.picture.mean(axis=-1)
    assert found[floor].mean() == pytest.approx(expected[floor].mean(), rel=0.01 * noise)
    height, width = floor.shape
    for row in range(0, height, 24):
        for column in range(0, width, 24):
            part = np.zeros_like(floor)
            part[row : row + 24, column : column + 24] = True
            part &= floor
            if part.sum() > 200:
                assert found[part].mean() == pytest.approx(expected[part].mean(), rel=0.03 * noise)


def test_rectangle_lights_as_its_form_factor_says() -> None:
    floor_under(None, matte(gray(0.0), gray(1.0)))
    shown = at_rest(64)
    agrees(shown, rectangle_light(shown.position))


def test_rectangle_lights_what_the_mirror_shows() -> None:
    """The floor in the mirror, by where it is."""
    floor_under(None, matte(gray(0.0), gray(1.0)))
    arrays, view = read(size=(160, 120))
    renderer = Renderer(arrays, Settings(method="auto", samples=64))
    frame = renderer.render(view)
    seen = frame.reflected_position()
    floor = inner((frame.mask() > 0) & (seen[..., 3] > 0.5) & (np.abs(seen[..., 2]) < 1e-3), 1)
    floor &= np.abs(seen[..., :2]).max(axis=-1) < 1.5
    expected = rectangle_light(seen[..., :3])
    picture = frame.color()[..., :3].mean(axis=-1)
    renderer.free()
    assert floor.sum() > 100
    # (Cycles is 1 % below: the pixel filter.)
    assert picture[floor].mean() == pytest.approx(expected[floor].mean(), rel=0.02)


def test_disk_lights_as_its_form_factor_says() -> None:
    circle = turned_profile([(0.0, 0.0), (0.5, 0.0)], 96)
    floor_under(circle, matte(gray(0.0), gray(1.0)))
    shown = at_rest(64)
    agrees(shown, disk_light(shown.position, 0.5))


def test_thousands_of_small_triangles_light_as_one_rectangle() -> None:
    floor_under(plane((WIDTH, DEPTH), (60, 40)), matte(gray(0.0), gray(1.0)))
    shown = at_rest(64)
    agrees(shown, rectangle_light(shown.position))


@pytest.mark.parametrize("scale", [(-1.0, 1.0, 1.0), (-2.0, 0.5, 1.0), (3.0, -0.25, -1.0)])
def test_mirrored_and_stretched_things_light_as_they_look(scale: tuple[float, float, float]) -> None:
    shape = plane((WIDTH / abs(scale[0]), DEPTH / abs(scale[1])), (3, 2))
    floor_under(shape, matte(gray(0.0), gray(1.0)), scale=scale)
    shown = at_rest(64)
    agrees(shown, rectangle_light(shown.position))


def test_very_small_and_strong_light() -> None:
    """A millimeter wide: rays over the hemisphere never find it."""
    size = 1e-3
    floor_under(plane((size, size)), matte(gray(0.0), gray(1e6)))
    shown = at_rest(64)
    low, high = (-size / 2, -size / 2), (size / 2, size / 2)
    agrees(shown, 1e6 * rectangle_light(shown.position, low, high), 2.0)


def test_a_weak_large_light_beside_a_strong_small_one() -> None:
    """Both count, whichever is asked more often."""
    floor_under(None, matte(gray(0.0), gray(0.2)))
    add_object("small", plane((0.02, 0.02)), matte(gray(0.0), gray(2000.0)), location=(0.0, 0.0, 0.9 * HEIGHT))
    shown = at_rest(64)
    x, y = shown.position[..., 0], shown.position[..., 1]
    distance = x * x + y * y + (0.9 * HEIGHT) ** 2
    small = ALBEDO / np.pi * 2000.0 * 4e-4 * (0.9 * HEIGHT) ** 2 / distance**2
    agrees(shown, 0.2 * rectangle_light(shown.position) + small)


def test_what_diffuse_rays_do_not_see_lights_nothing() -> None:
    """At rest as in motion; and mirrors see it all the same."""
    floor_under(None, matte(gray(0.0), gray(1.0)), visible_diffuse=False)
    shown = at_rest()
    assert shown.picture[on_floor(shown)].max() == 0.0
    assert shown.picture[shown.is_mirror].max() > 0.5
    moved = moving(*read())
    assert moved.picture[on_floor(moved)].max() == 0.0


def shining_by(node: Any, output: str, material: bpy.types.Material, strength: float = 1.0) -> bpy.types.Material:
    """What a node says is what it shines."""
    tree: Any = material.node_tree
    shader = tree.nodes["Principled BSDF"]
    tree.links.new(node.outputs[output], shader.inputs["Emission Color"])
    shader.inputs["Emission Strength"].default_value = strength
    return material


def test_checkered_light_is_half_as_strong() -> None:
    material = matte(gray(0.0))
    tree: Any = material.node_tree
    checker = tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Color1"].default_value, checker.inputs["Color2"].default_value = (1, 1, 1, 1), (0, 0, 0, 1)
    checker.inputs["Scale"].default_value = 20.0
    places = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(places.outputs["UV"], checker.inputs["Vector"])
    floor_under(None, shining_by(checker, "Color", material))
    shown = at_rest(64)
    agrees(shown, 0.5 * rectangle_light(shown.position), 2.0)


def test_image_shines_where_it_is_bright() -> None:
    """The left half alone."""
    pixels = np.ones((16, 16, 4), np.float32)
    pixels[:, 8:, :3] = 0.0
    material = matte(gray(0.0))
    tree: Any = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = packed_image("halves", pixels)
    node.interpolation = "Closest"
    floor_under(None, shining_by(node, "Color", material))
    shown = at_rest(64)
    agrees(shown, rectangle_light(shown.position, high=(0.0, DEPTH / 2)))


def test_lamp_behind_a_screen_lights_nothing() -> None:
    """Places that shine are asked for, not taken for seen."""
    floor_under(None, matte(gray(0.0), gray(5.0)))
    add_object("screen", plane((8.0, 8.0)), matte(gray(0.5)), location=(0.0, 0.0, 0.9 * HEIGHT))
    camera: Any = bpy.data.objects["Camera"]
    camera.location = (0.0, -3.5, 1.2)
    shown = at_rest()
    assert shown.picture[on_floor(shown)].max() == 0.0


def test_things_on_a_polished_floor_are_seen_in_it() -> None:
    """By the eye and in the mirror."""
    start(1)
    polished = principled("polished", gray(0.02), roughness=0.0)
    add_object("floor", plane((8.0, 8.0)), polished)
    add_object("red", ball(0.5, 48), matte((0.5, 0.02, 0.02), (2.0, 0.1, 0.1)), True, (-0.9, -0.8, 0.5))
    add_mirror(0.6, (0.5, 0.4, 0.6))
    add_camera((0.0, -5.0, 1.6), (0.0, 0.0, 0.5), 50.0)
    arrays, view = read()
    renderer = Renderer(arrays, Settings(method="auto", samples=64))
    frame = renderer.render(view)
    ours, seen = frame.color()[..., 0], frame.reflected_position()
    mask, place = frame.mask() > 0, frame.surfaces["seen_position"]
    renderer.free()
    cycles = by_cycles(256)[..., 0]
    floor = ~mask & (place[..., 3] > 0.5) & (np.abs(place[..., 2]) < 1e-3)
    in_mirror = mask & (seen[..., 3] > 0.5) & (np.abs(seen[..., 2]) < 1e-3)
    for chosen in (floor, in_mirror):
        assert chosen.sum() > 50
        assert cycles[chosen].max() > 0.05
        assert ours[chosen].mean() == pytest.approx(cycles[chosen].mean(), rel=0.05)
