# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps light the objects that their collections name, and are shadowed by those, as in Cycles."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon.demo.data_blocks import add_object
from curvrefl.curvrefl_addon.demo.shapes import plane
from indirect.places import gray, matte
from linking.stage import build, judge, link, point, sun

pytestmark = pytest.mark.usefixtures("gpu")


def agrees(most: float = 0.01, mean: float = 0.01, **how: Any) -> None:
    """With Cycles, in all but a few blocks; nothing else than what mirrors leave out of shadow linking is said."""
    found = judge(**how)
    print("\nRESULT", how, f"off {found.share_off:.4f} mean {found.mean_off:+.4f}", found.warnings)
    assert all("In mirrors" in sentence and "shadow linking" in sentence for sentence in found.warnings)
    assert found.share_off <= most
    assert abs(found.mean_off) <= mean


def no_links() -> None:
    point()


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


@pytest.mark.parametrize("method", ["exact", "newton"])
@pytest.mark.parametrize(
    "act",
    [
        no_links,
        includes_one,
        excludes_one,
        leaves_out_the_mirror,
        for_nobody,
        empty_collection,
        both_kinds,
        two_lamps,
        sun_past_a_cube,
        sun_past_all_but_a_cube,
        point_past_a_cube,
        both_links,
    ],
)
def test_lamps_as_cycles(act: Callable[[], None], method: str) -> None:
    build()
    act()
    agrees(method=method)


@pytest.mark.parametrize("act", [includes_one, sun_past_a_cube, point_past_a_cube, both_links])
def test_shadows_by_rays_as_cycles(act: Callable[[], None]) -> None:
    build()
    act()
    agrees(method="exact", shadow_rays=True)


def rough_mirror() -> None:
    tree: Any = bpy.data.objects["mirror"].active_material.node_tree
    tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.3


def clear_cubes() -> None:
    """Light goes straight on through half of them."""
    for name in ("one", "two"):
        tree: Any = bpy.data.objects[name].active_material.node_tree
        tree.nodes["Principled BSDF"].inputs["Alpha"].default_value = 0.5


@pytest.mark.parametrize("surface", [rough_mirror, clear_cubes])
@pytest.mark.parametrize("act", [includes_one, excludes_one, leaves_out_the_mirror, sun_past_a_cube, both_links])
def test_paths_as_cycles(act: Callable[[], None], surface: Callable[[], None]) -> None:
    build()
    act()
    surface()
    agrees(method="exact", samples=64, of_cycles=256)


def shine(**values: Any) -> Any:
    """A plate that shines down from over the cubes."""
    made: Any = add_object("shine", plane((0.8, 0.8)), matte(gray(0.0), gray(12.0)), location=(0.0, -1.0, 2.4))
    for name, value in values.items():
        setattr(made, name, value)
    return made


def shines_on_one() -> None:
    link(shine(), "receiver", ("one",))


def shines_past_one() -> None:
    link(shine(), "receiver", excluded=("one",))


def shines_not_in_the_mirror() -> None:
    link(shine(), "receiver", excluded=("mirror",))


def shines_and_lamp() -> None:
    link(shine(), "receiver", excluded=("two",))
    link(point(), "receiver", ("two", "mirror"))


def shines_shadowless() -> None:
    link(shine(), "blocker", excluded=("one",))


def shines_shadowed_by_one() -> None:
    link(shine(), "blocker", ("one",))


def both_links_of_what_shines() -> None:
    plate = shine()
    link(plate, "blocker", ("one",))
    link(plate, "receiver", ("floor", "two"))


@pytest.mark.parametrize("bounces", [0, 3])
@pytest.mark.parametrize(
    "act",
    [
        shines_on_one,
        shines_past_one,
        shines_not_in_the_mirror,
        shines_and_lamp,
        shines_shadowless,
        shines_shadowed_by_one,
        both_links_of_what_shines,
    ],
)
def test_what_shines_as_cycles(act: Callable[[], None], bounces: int) -> None:
    build(bounces)
    act()
    agrees(samples=64, of_cycles=512, mean=0.02)


@pytest.mark.parametrize("act", [includes_one, excludes_one, two_lamps, sun_past_a_cube])
def test_bounced_light_as_cycles(act: Callable[[], None]) -> None:
    """A lamp gives bounced light off its receivers alone."""
    build(3, world=0.0)
    act()
    agrees(samples=64, of_cycles=512, mean=0.02)
