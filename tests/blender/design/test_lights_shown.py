# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where lights show in mirrors of a scene: at what they were placed by, only where they are seen, found once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.design.lights.shown import LightsInMirrors, ShownLight, path_at, picked
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera

WIDTH, HEIGHT = 200, 150
PIXEL = (85.5, 90.5)


@pytest.fixture(autouse=True)
def lamp() -> Iterator[Any]:
    """An active area lamp before a mirror ball."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    registration.register()
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32)
    bpy.ops.object.shade_smooth()
    bpy.context.object.name = "Mirror"
    bpy.context.object.curvrefl.is_mirror = True
    camera = bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    camera.location, camera.rotation_euler = (0.0, -4.0, 0.0), (0.5 * np.pi, 0.0, 0.0)
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = WIDTH, HEIGHT
    bpy.ops.object.light_add(type="AREA", location=(2.0, -3.0, 2.0))
    lamp = bpy.context.object
    lamp.data.size = 2.0
    bpy.ops.curvrefl.place_light(pixel=PIXEL, keep_distance=False, distance=1.5)
    yield lamp
    registration.unregister()


def view() -> View:
    return view_of_camera(bpy.context.scene, bpy.context.scene.camera, WIDTH, HEIGHT)


def shown(lights: LightsInMirrors) -> dict[str, ShownLight]:
    found = lights.of(bpy.context.evaluated_depsgraph_get(), bpy.context.scene, view(), bpy.context.object)
    return {light.name: light for light in found}


def test_an_image_is_where_the_light_was_placed_by_with_its_outline_about_it(lamp: Any) -> None:
    found = shown(LightsInMirrors())[lamp.name]
    assert len(found.centers) == 1 and found.is_lit == (True,)
    np.testing.assert_allclose(found.centers[0], PIXEL, atol=0.05)
    ends = found.segments.reshape(-1, 2)
    assert len(ends) > 20 and (ends.min(axis=0) < PIXEL).all() and (ends.max(axis=0) > PIXEL).all()


def test_all_mirrors_are_asked_and_the_active_object_is_shown_too(lamp: Any) -> None:
    """A second ball, flat on one side by its scale, as an instance of a collection."""
    mesh = bpy.data.objects["Mirror"].copy()
    mesh.location, mesh.scale = (0.0, 0.0, 0.0), (0.4, 0.2, 0.4)
    group = bpy.data.collections.new("Balls")
    group.objects.link(mesh)
    holder = bpy.data.objects.new("Holder", None)
    holder.instance_type, holder.instance_collection, holder.location = "COLLECTION", group, (-1.4, -0.4, 0.0)
    bpy.context.collection.objects.link(holder)
    bpy.ops.object.empty_add(location=lamp.location)
    found = shown(LightsInMirrors())
    assert len(found[lamp.name].centers) == 2
    np.testing.assert_allclose(found["Empty"].centers, found[lamp.name].centers, atol=1e-3)
    assert found["Empty"].light is None and len(found["Empty"].segments) == 0


def test_what_is_hidden_is_not_shown_and_what_is_shadowed_is_told(lamp: Any) -> None:
    place = np.array(lamp.location)
    at_mirror = np.array([-0.2, -0.9, 0.25])
    bpy.ops.mesh.primitive_cube_add(size=0.3, location=(0.5 * (place + at_mirror)).tolist())
    shadow = bpy.context.object
    assert shown(LightsInMirrors())[lamp.name].is_lit == (False,)
    shadow.location = (0.5 * (at_mirror + np.array((0.0, -4.0, 0.0)))).tolist()
    assert len(shown(LightsInMirrors())[lamp.name].centers) == 0


def test_only_what_changed_is_looked_for_again(lamp: Any) -> None:
    bpy.ops.object.light_add(type="POINT", location=(1.0, -3.0, 1.0))
    lights = LightsInMirrors()
    shown(lights)
    assert lights.counters == {"meshes": 1, "mirrors": 1, "lights": 2}
    shown(lights)
    assert lights.counters == {"meshes": 1, "mirrors": 1, "lights": 2}
    lamp.location.x += 0.1
    shown(lights)
    assert lights.counters == {"meshes": 1, "mirrors": 1, "lights": 3}
    bpy.data.objects["Mirror"].location.x += 0.1
    shown(lights)
    assert lights.counters == {"meshes": 1, "mirrors": 2, "lights": 5}
    lights.forget_meshes()
    shown(lights)
    assert lights.counters["meshes"] == 2


def test_a_light_is_picked_by_its_image_or_within_its_outline(lamp: Any) -> None:
    bpy.ops.object.light_add(type="POINT", location=(3.0, -1.0, -1.0))
    found = tuple(shown(LightsInMirrors()).values())

    def pick(x: float, y: float) -> str:
        pixel = np.array((x, y))
        path = path_at(bpy.context.evaluated_depsgraph_get(), bpy.context.scene, view(), pixel)
        chosen = picked(found, path, pixel)
        return "" if chosen is None else chosen[0]

    point = next(light.centers[0] for light in found if light.name == "Point")
    assert pick(*(point + 3.0)) == "Point"
    segments = next(light.segments for light in found if light.name == lamp.name)
    left = segments.reshape(-1, 2)[segments.reshape(-1, 2)[:, 0].argmin()]
    assert PIXEL[0] - left[0] > 13.0
    assert pick(left[0] + 1.0, left[1]) == lamp.name
    assert pick(left[0] - 3.0, left[1]) == "" and pick(5.0, 5.0) == ""
