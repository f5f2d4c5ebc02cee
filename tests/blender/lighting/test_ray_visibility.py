# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which rays see lamps and the world, and which parts of surfaces these light: whole pictures against Cycles, or a
sentence that names what is left out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from lighting.room import add_lamp, build_room, judge_room, our_room

pytestmark = pytest.mark.usefixtures("gpu")

MOST_OFF = 0.02


@pytest.fixture(scope="module")
def plain() -> np.ndarray:
    """Our picture where nothing is out of the ordinary."""
    build_room()
    picture, warnings = our_room()
    assert not warnings
    return picture


def area() -> Any:
    return bpy.data.objects["area"]


def world() -> Any:
    scene: Any = bpy.context.scene
    return scene.world


def a_ball(**values: Any) -> Any:
    return add_lamp("POINT", (-1.2, -2.5, 1.6), 100.0, shadow_soft_size=0.5, **values)


def unseen_ball() -> None:
    assert not a_ball().visible_camera


def seen_ball() -> None:
    a_ball().visible_camera = True


def ball_without_soft_falloff() -> None:
    a_ball(use_soft_falloff=False)


def spot_without_soft_falloff() -> None:
    lamp = add_lamp("SPOT", (-1.2, -2.5, 1.6), 200.0, shadow_soft_size=0.4, spot_size=1.8, use_soft_falloff=False)
    lamp.visible_camera = True


def ball_without_samples_of_its_own() -> None:
    a_ball().data.cycles.use_multiple_importance_sampling = False


def without_diffuse() -> None:
    area().visible_diffuse = False


def without_glossy() -> None:
    area().visible_glossy = False


def spread() -> None:
    area().data.spread, area().data.energy = 0.9, 40.0
    area().visible_camera = True


def portal() -> None:
    area().data.cycles.is_portal = True


def negative_area() -> None:
    add_lamp("AREA", (-1.5, -2.0, 3.5), -40.0, size=1.0)


def negative_sun() -> None:
    add_lamp("SUN", (2.0, -2.0, 3.0), -0.5)


def world_unseen_by_camera() -> None:
    world().cycles_visibility.camera = False


def world_without_diffuse() -> None:
    world().cycles_visibility.diffuse = False


def world_without_glossy() -> None:
    world().cycles_visibility.glossy = False


def world_without_light() -> None:
    world().cycles_visibility.diffuse = world().cycles_visibility.glossy = False


def image_without_diffuse() -> None:
    """With a sun in it, which becomes a lamp of ours."""
    pixels = np.ones((64, 128, 4), np.float32)
    pixels[..., :3] = np.linspace(0.1, 0.9, 64)[:, None, None]
    pixels[44:46, 24:27, :3] = 500.0
    image = bpy.data.images.new("sky", 128, 64, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    node = world().node_tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = image
    background = next(one for one in world().node_tree.nodes if one.type == "BACKGROUND")
    world().node_tree.links.new(node.outputs["Color"], background.inputs["Color"])
    world().cycles_visibility.diffuse = False


def object_unseen_by_mirrors() -> None:
    bpy.data.objects["cube"].visible_glossy = False


def light_group() -> None:
    bpy.context.view_layer.lightgroups.add(name="group")
    area().lightgroup = "group"


@pytest.mark.parametrize(
    "change",
    [
        unseen_ball,
        seen_ball,
        ball_without_soft_falloff,
        spot_without_soft_falloff,
        ball_without_samples_of_its_own,
        without_diffuse,
        without_glossy,
        spread,
        portal,
        negative_area,
        negative_sun,
        world_unseen_by_camera,
        world_without_diffuse,
        world_without_glossy,
        world_without_light,
        image_without_diffuse,
        object_unseen_by_mirrors,
        light_group,
    ],
    ids=lambda change: change.__name__,
)
def test_what_rays_see_is_what_cycles_shows(plain: np.ndarray, change: Callable[[], None]) -> None:
    build_room()
    change()
    judged = judge_room()
    assert judged.share_off < MOST_OFF
    assert not judged.warnings
    if change is not light_group:
        assert np.abs(judged.ours - plain).max() > 0.05


def test_a_cube_map_is_drawn_by_a_mirror_and_not_by_the_camera() -> None:
    """A lamp and a world that the camera does not see are in it, and what mirrors do not see is not."""
    pictures = {}
    for camera, glossy in ((False, True), (True, True), (True, False)):
        build_room(with_lamp=False)
        lamp = a_ball()
        lamp.visible_camera, lamp.visible_glossy = camera, glossy
        world().cycles_visibility.camera, world().cycles_visibility.glossy = camera, glossy
        pictures[camera, glossy], _ = our_room(method="environment_cube")
    # Upper half of the mirror ball: the sky; it is lit by nothing but what it reflects.
    mirror = (slice(44, 51), slice(43, 53))
    assert np.allclose(pictures[False, True][mirror], pictures[True, True][mirror], rtol=1e-3)
    assert pictures[True, False][mirror].mean() < 0.3 * pictures[True, True][mirror].mean()


def few_bounces() -> None:
    area().data.cycles.max_bounces = 0


def odd_objects() -> None:
    for name in ("cube", "gloss", "mirror", "floor"):
        bpy.data.objects[name].visible_diffuse = False


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (few_bounces, 'Lamp "area" lights all that mirrors show: its limit of 0 bounces is left out.'),
        (
            odd_objects,
            'The world\'s light is shadowed by "floor", "mirror", "cube" and 1 more as that of lamps: '
            "visibility to diffuse rays is left out.",
        ),
    ],
    ids=lambda item: getattr(item, "__name__", ""),
)
def test_what_is_left_out_is_said(change: Callable[[], None], sentence: str) -> None:
    build_room()
    change()
    assert our_room()[1] == (sentence,)
