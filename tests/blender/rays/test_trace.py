# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tracing in a scene where the answer is known, by the operator as scripts call it."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.viewport import tracing
from curvrefl.operators.trace_at_cursor import TEXT_NAME

EYE = (0.0, -4.0, 0.0)


@pytest.fixture(autouse=True)
def scene() -> Iterator[None]:
    """A smooth unit sphere about the origin as the mirror, a small cube to its right, a lamp."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    registration.register()
    bpy.ops.mesh.primitive_uv_sphere_add(segments=128, ring_count=64)
    bpy.ops.object.shade_smooth()
    bpy.context.object.name = "Mirror"
    bpy.context.object.curvrefl.is_mirror = True
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(5.0, -0.7, 0.0))
    bpy.context.object.name = "Cube"
    bpy.ops.object.light_add(type="POINT", location=(0.0, 0.0, 3.0))
    bpy.context.view_layer.update()
    yield
    registration.unregister()
    assert tracing.shown() is None


def towards(point: np.ndarray) -> tuple[float, float, float]:
    x, y, z = np.array(point) - EYE
    return x, y, z


# Where the normal halves the angle between eye and +X: the reflected ray goes nearly along +X.
CLICKED = np.array([np.sin(0.75), -np.cos(0.75), 0.0])


def run(**properties: object) -> set[str]:
    return bpy.ops.curvrefl.trace_at_cursor(origin=EYE, direction=towards(CLICKED), **properties)


def test_trace_finds_what_the_mirror_shows() -> None:
    assert run() == {"FINISHED"}
    found = tracing.shown()
    assert found is not None
    assert found.mirror == "Mirror" and found.seen == "Cube"
    np.testing.assert_allclose(found.ray.point, CLICKED, atol=2e-3)
    # The mesh's shading normal is that of the sphere, its facets are not.
    np.testing.assert_allclose(found.ray.normal, CLICKED, atol=2e-3)
    incoming = towards(CLICKED) / np.linalg.norm(towards(CLICKED))
    assert found.ray.incidence == pytest.approx(np.arccos(-incoming @ CLICKED), abs=2e-3)
    assert found.hit is not None and found.hit[0] == pytest.approx(4.5, abs=1e-4)
    text = bpy.data.texts[TEXT_NAME].as_string()
    assert "Cube" in text and "Incidence" in text


def test_background() -> None:
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    assert run() == {"FINISHED"}
    found = tracing.shown()
    assert found is not None and found.hit is None and found.seen == ""
    assert dict(found.rows())["Shows"] == "Background"


@pytest.mark.parametrize("name", ["Cube", "Point"])
def test_placing_puts_the_object_on_the_reflected_ray(name: str) -> None:
    """And the closed form for the sphere finds the clicked point for it."""
    from curvrefl.curvrefl_addon.optics.surfaces.sphere import reflection_points

    item = bpy.data.objects[name]
    item.location = (2.0, 1.0, 2.0)
    bpy.context.view_layer.objects.active = item
    bpy.context.view_layer.update()
    distance = np.linalg.norm(np.array(item.location) - CLICKED)
    assert run(place="ACTIVE") == {"FINISHED"}
    place = np.array(item.matrix_world.translation)
    assert np.linalg.norm(place - CLICKED) == pytest.approx(distance, abs=5e-3)
    np.testing.assert_allclose(reflection_points(np.array(EYE), place[None], 1.0)[0], CLICKED, atol=5e-3)
    assert "is seen" in bpy.data.texts[TEXT_NAME].as_string()


def test_what_is_placed_stays_in_front_of_what_is_there() -> None:
    item = bpy.data.objects["Point"]
    item.location = (0.0, 0.0, 300.0)
    bpy.context.view_layer.objects.active = item
    bpy.context.view_layer.update()
    run(place="ACTIVE")
    assert item.matrix_world.translation.x < 4.5


@pytest.mark.parametrize(
    ("properties", "message"),
    [
        ({"direction": (0.0, -1.0, 0.0)}, "Nothing is there"),
        ({"direction": (0.0, 0.0, 0.0)}, "no direction"),
        ({"origin": (5.0, -4.0, 0.0), "direction": (0.0, 1.0, 0.0)}, '"Cube" is not a mirror'),
    ],
)
def test_mistakes_are_told(properties: dict[str, tuple[float, float, float]], message: str) -> None:
    with pytest.raises(RuntimeError, match=message):
        bpy.ops.curvrefl.trace_at_cursor(**{"origin": EYE, "direction": (0.0, 1.0, 0.0), **properties})


def test_the_mirror_itself_is_not_placed() -> None:
    bpy.context.view_layer.objects.active = bpy.data.objects["Mirror"]
    with pytest.raises(RuntimeError, match="own reflection"):
        run(place="ACTIVE")


def test_clear() -> None:
    run()
    assert bpy.ops.curvrefl.clear_trace() == {"FINISHED"}
    assert tracing.shown() is None
    with pytest.raises(RuntimeError, match="poll"):
        bpy.ops.curvrefl.clear_trace()


def test_trace_far_from_the_origin_does_not_stop_at_the_mirror_itself() -> None:
    """At 1e5 m places are rounded by more than a ten-thousandth of the mirror's size."""
    away = np.array([131072.0, -65536.0, 32768.0])
    for thing in bpy.context.scene.objects:
        thing.location = (np.array(thing.location) + away).tolist()
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = tracing.trace(depsgraph, bpy.context.scene, away + EYE, np.array(towards(CLICKED)))
    assert (found.mirror, found.seen) == ("Mirror", "Cube")
