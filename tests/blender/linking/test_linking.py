# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps light the objects that their collections name, and are shadowed by those, as in Cycles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.surfaces.light_sets import LINKED, SHADOWS_LINKED
from curvrefl.curvrefl_addon.scene.arrays import EVERY_SET
from indirect.places import moving, read
from linking.stage import SIZE, build, judge, link, plate, point, sun

pytestmark = pytest.mark.usefixtures("gpu")


def includes_one() -> None:
    link(point(), "receiver", ("one",))


def excludes_one() -> None:
    link(point(), "receiver", excluded=("one",))


def leaves_out_the_mirror() -> None:
    link(point(shadow_soft_size=0.5), "receiver", excluded=("mirror",))


def for_nobody() -> None:
    """An object that is in no scene."""
    obj = bpy.data.objects.new("elsewhere", None)
    link(point(), "receiver", (obj.name,))


def empty_collection() -> None:
    link(point(), "receiver")


def both_kinds() -> None:
    link(point(), "receiver", ("floor", "one"), ("two",))


def two_lamps() -> None:
    link(point(), "receiver", ("one", "mirror"))
    link(sun(), "receiver", excluded=("one",))


def sun_past_a_cube() -> None:
    link(sun(), "blocker", excluded=("one",))


def sun_past_all_but_a_cube() -> None:
    link(sun(), "blocker", ("two",))


def point_past_a_cube() -> None:
    link(point(), "blocker", excluded=("two",))


def both_links() -> None:
    lamp = point()
    link(lamp, "receiver", ("floor", "two"))
    link(lamp, "blocker", ("one",))


def shines_on_one() -> None:
    link(plate(), "receiver", ("one",))


def shines_past_one() -> None:
    link(plate(), "receiver", excluded=("one",))


def shines_not_in_the_mirror() -> None:
    link(plate(), "receiver", excluded=("mirror",))


def shines_and_lamp() -> None:
    link(plate(), "receiver", excluded=("two",))
    link(point(), "receiver", ("two", "mirror"))


def shines_shadowless() -> None:
    link(plate(), "blocker", excluded=("one",))


def shines_shadowed_by_one() -> None:
    link(plate(), "blocker", ("one",))


def both_links_of_what_shines() -> None:
    shining = plate()
    link(shining, "blocker", ("one",))
    link(shining, "receiver", ("floor", "two"))


@pytest.mark.parametrize(
    "act",
    [
        includes_one,
        excludes_one,
        leaves_out_the_mirror,
        for_nobody,
        both_kinds,
        two_lamps,
        sun_past_a_cube,
        sun_past_all_but_a_cube,
        point_past_a_cube,
        both_links,
    ],
)
def test_lamps_as_cycles(act: Callable[[], None]) -> None:
    build()
    act()
    judge(method="exact").agrees()


@pytest.mark.parametrize("act", [includes_one, leaves_out_the_mirror, sun_past_a_cube])
def test_lamps_as_cycles_by_reflection_points(act: Callable[[], None]) -> None:
    build()
    act()
    judge(method="newton").agrees()


def test_environments_say_what_they_do_not_follow() -> None:
    build()
    leaves_out_the_mirror()
    link(plate(), "receiver", excluded=("mirror",))
    found = judge(of_cycles=1, method="environment_cube")
    assert found.warnings == (
        'In mirrors "point" and "shine" shine whatever the light linking: choose Automatic or Exact to follow it.',
    )


def test_empty_collections_change_nothing() -> None:
    build()
    link(point(), "receiver")
    found = judge(method="exact")
    found.agrees(shows=False)
    assert found.features.isdisjoint({LINKED, SHADOWS_LINKED})


def two_lamps_two_shadows() -> None:
    """One of them stands for both in each sub-frame."""
    link(point(), "blocker", excluded=("two",))
    sun_past_a_cube()


@pytest.mark.parametrize("act", [includes_one, sun_past_a_cube, point_past_a_cube, both_links, two_lamps_two_shadows])
def test_shadows_by_rays_as_cycles(act: Callable[[], None]) -> None:
    build()
    act()
    judge(method="exact", samples=32, shadow_rays=True).agrees()


def rough_mirror() -> None:
    tree: Any = bpy.data.objects["mirror"].active_material.node_tree
    tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.3


def clear_cubes() -> None:
    """Light goes straight on through half of them."""
    for name in ("one", "two"):
        tree: Any = bpy.data.objects[name].active_material.node_tree
        tree.nodes["Principled BSDF"].inputs["Alpha"].default_value = 0.5


@pytest.mark.parametrize("act", [excludes_one, leaves_out_the_mirror, both_links])
def test_rough_mirrors_as_cycles(act: Callable[[], None]) -> None:
    """Paths go on from them."""
    build()
    act()
    rough_mirror()
    judge(method="exact", samples=64, of_cycles=256).agrees()


@pytest.mark.parametrize("act", [includes_one, sun_past_a_cube])
def test_what_is_seen_through_as_cycles(act: Callable[[], None]) -> None:
    """(The floor below is a little brighter than in Cycles, without links as well: 4.6 % of blocks are off then.)"""
    build()
    act()
    clear_cubes()
    judge(method="exact", samples=64, of_cycles=256, shadow_rays=True).agrees(most=0.04)


def of_plastic() -> tuple[str, ...]:
    """Its base is lit."""
    tree: Any = bpy.data.objects["mirror"].active_material.node_tree
    tree.nodes["Principled BSDF"].inputs["Metallic"].default_value = 0.3
    return ("mirror",)


def two_mirrors() -> tuple[str, ...]:
    """One is seen in the other."""
    bpy.data.objects["two"].active_material = bpy.data.objects["mirror"].active_material
    return ("mirror", "two")


@pytest.mark.parametrize("mirrors", [of_plastic, two_mirrors])
@pytest.mark.parametrize("act", [leaves_out_the_mirror, shines_not_in_the_mirror, both_links])
def test_other_mirrors_as_cycles(act: Callable[[], None], mirrors: Callable[[], tuple[str, ...]]) -> None:
    build()
    act()
    judge(method="exact", samples=32, mirrors=mirrors()).agrees()


def test_pattern_shines_as_cycles() -> None:
    """By a material's program."""
    build()
    shines_past_one()
    tree: Any = bpy.data.objects["shine"].active_material.node_tree
    pattern = tree.nodes.new("ShaderNodeTexChecker")
    pattern.inputs["Color2"].default_value = (0.0, 0.0, 0.0, 1.0)
    tree.links.new(pattern.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Emission Color"])
    judge(samples=64, of_cycles=256).agrees()


def test_shadow_linked_suns_are_not_seen_by_the_camera() -> None:
    """Nor are they in Cycles."""
    build(world=0.02)
    lamp = sun(angle=0.3)
    lamp.rotation_euler, lamp.visible_camera = (1.4, 0.0, np.pi), True
    camera: Any = bpy.context.scene.camera
    camera.rotation_euler = (1.6, 0.0, 0.0)
    link(lamp, "blocker", excluded=("one",))
    judge(method="exact").agrees(mean=0.03)


@pytest.mark.parametrize("act", [shines_on_one, shines_not_in_the_mirror, shines_shadowless, both_links_of_what_shines])
def test_what_shines_as_cycles(act: Callable[[], None]) -> None:
    build()
    act()
    judge(samples=64, of_cycles=256).agrees()


@pytest.mark.parametrize(
    "act",
    [includes_one, two_lamps, sun_past_a_cube, shines_past_one, shines_and_lamp, shines_shadowed_by_one],
)
def test_bounced_light_as_cycles(act: Callable[[], None]) -> None:
    """Lamps and what shines give bounced light off their receivers alone."""
    build(3, world=0.0)
    act()
    judge(samples=64, of_cycles=256).agrees()


def test_bounced_light_while_a_view_moves_is_off_receivers_alone() -> None:
    """The floor gets light of the cube that is lit, but not as if the lamp lit the floor itself."""
    build(3, world=0.0)
    includes_one()
    arrays, view = read(size=SIZE)
    shown = moving(arrays, view)
    unlinked = replace(arrays, lights=tuple(replace(light, lights_on=EVERY_SET) for light in arrays.lights))
    without = moving(unlinked, view)
    floor = shown.is_thing & (shown.normal[..., 2] > 0.9) & (shown.position[..., 2] < 0.01)
    near, far = (floor & (np.abs(shown.position[..., 0] - x) < 0.3) for x in (-0.6, 2.4))
    assert shown.mean(near).min() > 0.0
    assert shown.mean(near).mean() > 5.0 * shown.mean(far).mean()
    assert without.mean(far).mean() > 50.0 * shown.mean(far).mean()


def test_links_of_one_lamp_are_not_those_of_the_world() -> None:
    """The last lamp casts no shadow at all; the world's are by rays, too."""
    build(world=0.5)
    lamp = point()
    lamp.data.use_shadow = False
    link(lamp, "blocker", ("mirror",))
    judge(method="exact", shadow_rays=True).agrees(shows=False)
