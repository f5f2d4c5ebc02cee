# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light between surfaces follows the scene: what changes shows, what is gone lights nothing, and pictures come back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object
from curvrefl.curvrefl_addon.demo.shapes import ball, plane
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays, WorldArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from indirect.places import (
    SAMPLES,
    add_box,
    add_mirror,
    by_renderer,
    gray,
    matte,
    moving,
    read,
    rendered,
    start,
    world_of,
)
from lighting.room import add_lamp

pytestmark = pytest.mark.usefixtures("gpu")
SMALL = (48, 36)


def corner() -> None:
    """Two walls and a floor, a ball, a mirror, a lamp, a small thing that shines and a dim world."""
    start(3)
    world_of(gray(0.05))
    white = matte(gray(0.7))
    add_box("floor", (-3, -3, -0.1), (3, 3, 0), white)
    add_box("back", (-3, 3, -0.1), (3, 3.1, 3), white)
    add_box("left", (-3.1, -3, -0.1), (-3, 3.1, 3), matte((0.7, 0.1, 0.1)))
    add_object("ball", ball(0.6, 32), matte((0.2, 0.3, 0.7)), True, (1.2, 0.0, 0.6))
    add_object("shine", plane((0.5, 0.5)), matte(gray(0.0), (1.0, 4.0, 9.0)), location=(-1.5, 1.5, 2.5))
    add_mirror(0.7, (-0.6, 0.8, 0.7))
    add_lamp("POINT", (1.5, -1.5, 2.8), 200.0, shadow_soft_size=0.2)
    add_camera((1.5, -6.0, 2.4), (0.0, 0.5, 0.9), 40.0)


@pytest.fixture
def scene() -> tuple[SceneArrays, View]:
    corner()
    return read(size=SMALL)


def instance(scene: SceneArrays, name: str) -> int:
    return next(k for k, item in enumerate(scene.instances) if item.object_name == name)


def with_instance(scene: SceneArrays, name: str, **changes: Any) -> SceneArrays:
    instances = list(scene.instances)
    place = instance(scene, name)
    instances[place] = replace(instances[place], **changes)
    return replace(scene, instances=tuple(instances))


def with_material(scene: SceneArrays, name: str, **changes: Any) -> SceneArrays:
    materials = list(scene.materials)
    place = scene.instances[instance(scene, name)].materials[0]
    materials[place] = replace(materials[place], **changes)
    return replace(scene, materials=tuple(materials))


def moved(scene: SceneArrays, name: str, *by: float) -> SceneArrays:
    matrix = scene.instances[instance(scene, name)].matrix.copy()
    matrix[:3, 3] += by
    return with_instance(scene, name, matrix=matrix)


def move_lamp(scene: SceneArrays) -> SceneArrays:
    matrix = scene.lights[0].matrix.copy()
    matrix[:3, 3] = (-2.0, -2.0, 1.0)
    return replace(scene, lights=(replace(scene.lights[0], matrix=matrix),))


def lamp_off(scene: SceneArrays) -> SceneArrays:
    return replace(scene, lights=())


def paint_wall(scene: SceneArrays) -> SceneArrays:
    return with_material(scene, "left", base_color=(0.05, 0.8, 0.1))


def move_ball(scene: SceneArrays) -> SceneArrays:
    return moved(scene, "ball", -0.8, -1.0, 0.5)


def move_shine(scene: SceneArrays) -> SceneArrays:
    return moved(scene, "shine", 2.5, 0.0, -0.5)


def shine_more(scene: SceneArrays) -> SceneArrays:
    return with_material(scene, "shine", emission=(20.0, 1.0, 1.0))


def shine_no_more(scene: SceneArrays) -> SceneArrays:
    return with_material(scene, "shine", emission=(0.0, 0.0, 0.0))


def wall_gone(scene: SceneArrays) -> SceneArrays:
    place = instance(scene, "left")
    return replace(scene, instances=(*scene.instances[:place], *scene.instances[place + 1 :]))


def wall_hidden(scene: SceneArrays) -> SceneArrays:
    return with_instance(scene, "left", visible_diffuse=False)


def bright_world(scene: SceneArrays) -> SceneArrays:
    return replace(scene, world=WorldArrays((0.5, 0.4, 0.3)))


def fewer_bounces(scene: SceneArrays) -> SceneArrays:
    return replace(scene, diffuse_bounces=1)


def no_bounces(scene: SceneArrays) -> SceneArrays:
    return replace(scene, diffuse_bounces=0)


@pytest.mark.parametrize(
    "act",
    [
        move_lamp,
        lamp_off,
        paint_wall,
        move_ball,
        move_shine,
        shine_more,
        shine_no_more,
        wall_gone,
        wall_hidden,
        bright_world,
        fewer_bounces,
        no_bounces,
    ],
)
def test_following_is_as_starting_anew(
    scene: tuple[SceneArrays, View], act: Callable[[SceneArrays], SceneArrays]
) -> None:
    """To the last bit; and back again."""
    arrays, view = scene
    renderer = Renderer(arrays, Settings(method="auto", samples=4))
    before = by_renderer(renderer, view).picture
    changed = act(arrays)
    renderer.update(changed)
    found = by_renderer(renderer, view).picture
    expected = rendered(changed, view, 4).picture
    assert np.abs(found - before).mean() > 1e-3 * before.mean()
    assert np.array_equal(found, expected)
    renderer.update(arrays)
    assert np.array_equal(by_renderer(renderer, view).picture, before)
    renderer.free()


def test_bounces_come_back(scene: tuple[SceneArrays, View]) -> None:
    """From a scene that was read without any."""
    arrays, view = scene
    renderer = Renderer(no_bounces(arrays), Settings(method="auto", samples=4))
    bare = by_renderer(renderer, view).picture
    renderer.update(arrays)
    lit = by_renderer(renderer, view).picture
    assert lit.mean() > 1.1 * bare.mean()
    assert np.array_equal(lit, rendered(arrays, view, 4).picture)
    renderer.free()


def test_more_sub_frames_are_as_from_the_start(scene: tuple[SceneArrays, View]) -> None:
    arrays, view = scene
    renderer = Renderer(arrays, Settings(method="auto", samples=4))
    by_renderer(renderer, view)
    renderer.configure(Settings(method="auto", samples=8))
    found = by_renderer(renderer, view).picture
    expected = rendered(arrays, view, 8).picture
    assert np.abs(found - expected).mean() < 5e-3 * expected.mean()
    renderer.free()


def test_no_light_is_left_of_what_is_off(scene: tuple[SceneArrays, View]) -> None:
    """Neither at rest nor in motion, of a lamp, a world or what shone."""
    arrays, view = scene
    dark = replace(shine_no_more(lamp_off(arrays)), world=WorldArrays())
    renderer = Renderer(arrays, Settings(method="auto", samples=4))
    assert by_renderer(renderer, view).picture.min() >= 0.0
    renderer.update(dark)
    assert by_renderer(renderer, view).picture.max() == 0.0
    assert moving(dark, view).picture.max() == 0.0
    renderer.free()


@pytest.mark.parametrize("source", ["lamp", "shine", "world"])
def test_twice_the_strength_is_twice_the_light(scene: tuple[SceneArrays, View], source: str) -> None:
    """Everywhere and at any brightness: nothing is clamped or taken over."""
    arrays, view = scene

    def lit(strength: float) -> SceneArrays:
        made = replace(shine_no_more(lamp_off(arrays)), world=WorldArrays())
        color = tuple(strength * part for part in (1.0, 2.0, 3.0))
        if source == "lamp":
            return replace(made, lights=(replace(arrays.lights[0], color=color),))  # type: ignore[arg-type]
        if source == "shine":
            return with_material(made, "shine", emission=color)
        return replace(made, world=WorldArrays(color))  # type: ignore[arg-type]

    renderer = Renderer(lit(1.0), Settings(method="auto", samples=4))
    one = by_renderer(renderer, view).picture
    for factor in (2.0, 1024.0, 2.0**-10):
        renderer.update(lit(factor))
        more = by_renderer(renderer, view).picture
        assert np.abs(more / factor - one).max() < 1e-3 * one.max()
        assert more.mean() == pytest.approx(factor * one.mean(), rel=1e-3)
    renderer.free()


def test_pictures_are_the_same_again(scene: tuple[SceneArrays, View]) -> None:
    """By the same renderer, and by another."""
    arrays, view = scene
    renderer = Renderer(arrays, Settings(method="auto", samples=SAMPLES))
    first, again = by_renderer(renderer, view).picture, by_renderer(renderer, view).picture
    renderer.free()
    assert np.array_equal(first, again)
    assert np.array_equal(first, rendered(arrays, view).picture)
    assert np.array_equal(moving(arrays, view).picture, moving(arrays, view).picture)


def test_a_picture_between_does_not_matter(scene: tuple[SceneArrays, View]) -> None:
    """Of another view and while the view moves: light between surfaces knows no eye."""
    arrays, view = scene
    renderer = Renderer(arrays, Settings(method="auto", samples=4))
    other = read(size=(64, 32))[1]
    by_renderer(renderer, other)
    renderer.reflect(view)
    found = by_renderer(renderer, view).picture
    assert np.array_equal(found, rendered(arrays, view, 4).picture)
    renderer.free()


def test_light_found_by_and_by_is_the_same_in_the_end(scene: tuple[SceneArrays, View]) -> None:
    """From the start and after changes, with a picture taken too early."""
    arrays, view = scene
    renderer = Renderer(arrays, Settings(method="auto", samples=4), is_gradual=True)
    for state in (arrays, move_ball(arrays), move_lamp(arrays)):
        renderer.update(state)
        steps = 0
        by_renderer(renderer, view)
        while renderer.is_loading:
            renderer.load_some(0.01)
            steps += 1
            assert steps < 1000
        assert np.array_equal(by_renderer(renderer, view).picture, rendered(state, view, 4).picture)
    renderer.free()


def test_while_a_thing_is_dragged_what_is_known_is_lit_anew_and_no_more(
    scene: tuple[SceneArrays, View],
) -> None:
    arrays, view = scene
    renderer = Renderer(arrays, Settings(samples=SAMPLES), is_gradual=True)
    renderer.reflect(view)
    while renderer.is_loading:
        renderer.load_some(1.0)
    light = renderer._appearance.indirect
    patches = light.irradiance
    assert patches is not None
    for _ in range(3):
        arrays = moved(arrays, "ball", 0.1, 0.0, 0.0)
        renderer.update(arrays)
        renderer.reflect(view)
        revision = renderer.revision
        # (Time for all of it, of which none is taken.)
        renderer.load_some(60.0)
        assert renderer.revision > revision, "lit anew"
        assert light.irradiance is patches
        assert not light.is_settled
    while renderer.is_loading:
        renderer.load_some(60.0)
    assert light.irradiance is not patches
    renderer.free()


def test_a_lamp_that_changes_before_all_is_found_loses_nothing_that_moved(scene: tuple[SceneArrays, View]) -> None:
    arrays, view = scene
    renderer = Renderer(arrays, Settings(method="auto", samples=4), is_gradual=True)
    renderer.reflect(view)
    while renderer.is_loading:
        renderer.load_some(1.0)
    arrays = moved(arrays, "ball", 0.8, 0.0, 0.0)
    renderer.update(arrays)
    for _ in range(3):
        renderer.load_some(0.0)
    assert renderer.is_loading
    lamps = tuple(replace(light, color=(1.0, 40.0, 90.0)) for light in arrays.lights)
    arrays = replace(arrays, lights=lamps)
    renderer.update(arrays)
    while renderer.is_loading:
        renderer.load_some(0.0)
    assert np.array_equal(by_renderer(renderer, view).picture, rendered(arrays, view, 4).picture)
    renderer.free()
