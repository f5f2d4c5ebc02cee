# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Placing lights by the operator as scripts call it, in scenes where the answer is known."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.optics.surfaces.sphere import reflection_points

EYE = np.array((0.0, -4.0, 0.0))
CLICKED = np.array([np.sin(0.75), -np.cos(0.75), 0.0])


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A smooth unit sphere about the origin as the mirror, a camera, an area lamp."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    registration.register()
    bpy.ops.mesh.primitive_uv_sphere_add(segments=256, ring_count=128)
    bpy.ops.object.shade_smooth()
    bpy.context.object.name = "Mirror"
    bpy.context.object.curvrefl.is_mirror = True
    camera = bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    camera.location, camera.rotation_euler = EYE.tolist(), (0.5 * np.pi, 0.0, 0.0)
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 200, 100
    lamp("AREA", (2.0, 1.0, 2.0))
    path = tmp_path_factory.mktemp("lights") / "sphere.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    registration.unregister()
    return path


@pytest.fixture(autouse=True)
def scene(file: Path) -> Iterator[None]:
    registration.register()
    bpy.ops.wm.open_mainfile(filepath=str(file))
    yield
    registration.unregister()


def lamp(kind: Any, place: tuple[float, float, float]) -> Any:
    """Active."""
    bpy.ops.object.light_add(type=kind, location=place)
    bpy.context.view_layer.update()
    return bpy.context.object


def run(**properties: Any) -> set[str]:
    return bpy.ops.curvrefl.place_light(**{"eye": EYE.tolist(), "point": CLICKED.tolist(), **properties})


def place_of(item: Any) -> np.ndarray:
    bpy.context.view_layer.update()
    return np.array(item.matrix_world.translation, np.float64)


def axis_of(item: Any) -> np.ndarray:
    """Where it shines."""
    bpy.context.view_layer.update()
    return -unit(np.array(item.matrix_world, np.float64)[:3, 2])


@pytest.mark.parametrize("kind", ["AREA", "POINT", "SPOT"])
def test_a_lamp_is_seen_where_it_was_asked_for_and_faces_that_place(kind: str) -> None:
    item = lamp(kind, (2.0, 1.0, 2.0))
    distance = np.linalg.norm(place_of(item) - CLICKED)
    before = axis_of(item)
    assert run() == {"FINISHED"}
    place = place_of(item)
    assert np.linalg.norm(place - CLICKED) == pytest.approx(distance, abs=1e-3)
    np.testing.assert_allclose(reflection_points(EYE, place[None], 1.0)[0], CLICKED, atol=1e-3)
    np.testing.assert_allclose(axis_of(item), before if kind == "POINT" else unit(CLICKED - place), atol=1e-3)


def test_objects_and_empties_go_there_and_are_not_turned() -> None:
    bpy.ops.object.empty_add(location=(3.0, 0.0, 0.0), rotation=(0.3, 0.2, 0.1))
    empty: Any = bpy.context.object
    run(distance=1.7, keep_distance=False, size=2.0)
    np.testing.assert_allclose(reflection_points(EYE, place_of(empty)[None], 1.0)[0], CLICKED, atol=1e-3)
    assert np.linalg.norm(place_of(empty) - CLICKED) == pytest.approx(1.7, abs=1e-3)
    np.testing.assert_allclose(empty.rotation_euler, (0.3, 0.2, 0.1), atol=1e-6)
    np.testing.assert_allclose(empty.scale, 2.0, atol=1e-6)


def test_a_sun_is_turned_and_stays_where_it_is() -> None:
    sun = lamp("SUN", (0.0, 0.0, 7.0))
    run()
    incoming = unit(CLICKED - EYE)
    np.testing.assert_allclose(axis_of(sun), -(incoming - 2.0 * (incoming @ CLICKED) * CLICKED), atol=2e-3)
    np.testing.assert_allclose(place_of(sun), (0, 0, 7))
    run(mode="ILLUMINATION")
    np.testing.assert_allclose(axis_of(sun), -CLICKED, atol=1e-3)


def test_illumination_is_along_the_normal_on_anything() -> None:
    bpy.ops.mesh.primitive_plane_add(size=20.0, location=(0.0, 0.0, -1.5))
    item = lamp("SPOT", (1.0, -2.0, 0.5))
    run(mode="ILLUMINATION", point=(1.0, -1.0, -1.5), keep_distance=False, distance=0.8)
    np.testing.assert_allclose(place_of(item), (1.0, -1.0, -0.7), atol=1e-5)
    np.testing.assert_allclose(axis_of(item), (0, 0, -1), atol=1e-5)


def test_a_rim_light_stands_behind_the_edge() -> None:
    """Of the unit sphere as seen from 4 m: there the normal is square to the line of sight."""
    item = bpy.context.object
    run(mode="RIM", keep_distance=False, distance=3.0, rim_width=0.3)
    edge = np.array([np.sqrt(15.0) / 4.0, -0.25, 0.0])
    sight = unit(edge - EYE)
    expected = edge + 3.0 * (np.cos(0.3) * sight + np.sin(0.3) * edge)
    np.testing.assert_allclose(place_of(item), expected, atol=2e-2)
    np.testing.assert_allclose(axis_of(item), unit(edge - expected), atol=5e-3)


def test_a_rim_light_beside_all_goes_to_the_cursor() -> None:
    item = bpy.context.object
    run(mode="RIM", eye=EYE.tolist(), point=(2.0, 0.0, 0.0), keep_distance=False, distance=9.0)
    np.testing.assert_allclose(place_of(item), EYE + 9.0 * unit(np.array([2.0, 4.0, 0.0])), atol=1e-5)
    np.testing.assert_allclose(axis_of(item), -unit(np.array([2.0, 4.0, 0.0])), atol=1e-5)


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
def test_a_pixel_of_the_cameras_picture(kind: Any) -> None:
    """The middle of the picture is the sphere's nearest point, which shows what is straight behind the eye."""
    bpy.context.scene.camera.data.type = kind
    item = bpy.context.object
    assert bpy.ops.curvrefl.place_light(pixel=(100.0, 50.0), keep_distance=False, distance=2.0) == {"FINISHED"}
    np.testing.assert_allclose(place_of(item), (0.0, -3.0, 0.0), atol=2e-3)


def test_two_mirrors_are_unfolded() -> None:
    """The sphere's side shows a flat mirror above it, which shows what is to the side and below of it."""
    bpy.ops.mesh.primitive_plane_add(size=40.0, location=(0.0, 0.0, 6.0))
    bpy.context.object.curvrefl.is_mirror = True
    item = lamp("POINT", (0.0, 0.0, 3.0))
    point = unit(np.array([0.0, -0.7, 0.55]))
    direction = unit(point - EYE)
    direction = direction - 2.0 * (direction @ point) * point
    up = (6.0 - point[2]) / direction[2]
    run(point=point.tolist(), keep_distance=False, distance=up + 2.5)
    folded = point + (up + 2.5) * direction
    np.testing.assert_allclose(place_of(item), folded * (1, 1, -1) + (0, 0, 12), atol=0.02)
    bpy.context.scene.curvrefl.bounces = 1
    run(point=point.tolist(), keep_distance=False, distance=up + 2.5)
    assert place_of(item)[2] < 6.0 and place_of(item)[2] == pytest.approx(point[2] + 0.95 * up * direction[2], abs=0.02)


def test_size_and_power_follow_the_distance_where_they_are_not_kept() -> None:
    item = bpy.context.object
    run(keep_distance=False, distance=2.0)
    item.data.shape, item.data.size, item.data.size_y, item.data.energy = "RECTANGLE", 0.4, 0.2, 10.0
    run(keep_distance=False, distance=3.0, keep_size=False, keep_power=False)
    assert (item.data.size, item.data.size_y) == pytest.approx((0.6, 0.3), rel=1e-3)
    assert item.data.energy == pytest.approx(22.5, rel=1e-3)
    run(size=0.5, power=2.0)
    assert (item.data.size, item.data.energy) == pytest.approx((0.3, 45.0), rel=1e-3)


def test_a_parent_does_not_matter() -> None:
    item = bpy.context.object
    run(keep_distance=False, distance=2.0)
    expected = place_of(item)
    bpy.ops.object.empty_add(location=(5.0, 1.0, 2.0), rotation=(0.4, 0.5, 0.6), scale=(2.0, 2.0, 2.0))
    item.parent = bpy.context.object
    bpy.context.view_layer.objects.active = item
    bpy.context.view_layer.update()
    run(keep_distance=False, distance=2.0)
    np.testing.assert_allclose(place_of(item), expected, atol=1e-4)


def test_unseen_things_and_the_light_itself_are_in_no_rays_way() -> None:
    item = bpy.context.object
    run(keep_distance=False, distance=2.0)
    expected = place_of(item)
    bpy.ops.mesh.primitive_cube_add(size=0.4, location=(0.3 * CLICKED + 0.7 * EYE).tolist())
    bpy.context.object.visible_camera = False
    bpy.ops.mesh.primitive_cube_add(size=0.2, location=(0.5 * (CLICKED + expected)).tolist())
    bpy.context.object.visible_glossy = False
    bpy.ops.mesh.primitive_cube_add(size=0.3, location=(0.5 * (CLICKED + EYE)).tolist())
    run(keep_distance=False, distance=2.0)
    np.testing.assert_allclose(place_of(bpy.context.object), expected, atol=1e-4)


@pytest.mark.parametrize(
    ("change", "properties", "message"),
    [
        (lambda item: None, {"point": (3.0, -3.9, 0.0)}, "Nothing is there"),
        (lambda item: None, {"point": EYE.tolist()}, "no direction"),
        (lambda item: setattr(item, "lock_location", (True, False, False)), {}, "is locked"),
        (lambda item: None, {"mode": "RIM", "point": (0.0, -1.0, 0.0)}, "faces the eye"),
        (lambda item: setattr(bpy.context.view_layer.objects, "active", bpy.data.objects["Mirror"]), {}, "own refl"),
        (lambda item: setattr(bpy.context.view_layer.objects, "active", None), {}, "Make a light"),
    ],
)
def test_mistakes_are_told_and_move_nothing(change: Any, properties: dict[str, Any], message: str) -> None:
    item = bpy.context.object
    change(item)
    before = place_of(item)
    with pytest.raises(RuntimeError, match=message):
        run(**properties)
    assert (place_of(item) == before).all()


def test_a_place_is_needed() -> None:
    with pytest.raises(RuntimeError, match="No place is given"):
        bpy.ops.curvrefl.place_light()


def test_a_constraint_is_told(capfd: pytest.CaptureFixture[str]) -> None:
    item = bpy.context.object
    item.constraints.new("LIMIT_LOCATION").use_max_x = True
    run()
    assert "A constraint, a driver or physics" in capfd.readouterr().out


def test_the_tool_is_in_the_toolbar_while_the_extension_is_on() -> None:
    from bl_ui.space_toolsystem_toolbar import VIEW3D_PT_tools_active as toolbar

    def names() -> list[str]:
        tools = toolbar._tools_flatten(toolbar.tools_from_context(bpy.context, mode="OBJECT"))
        return [tool.idname for tool in tools if tool is not None]

    assert "curvrefl.lights" in names()
    registration.unregister()
    assert "curvrefl.lights" not in names()
    registration.register()


def test_an_edge_is_found_behind_other_things() -> None:
    item = bpy.context.object
    run(mode="RIM", keep_distance=False, distance=3.0)
    expected = place_of(item)
    bpy.ops.mesh.primitive_cube_add(size=0.3, location=(0.85, -0.9, 0.0))
    bpy.context.view_layer.objects.active = item
    bpy.context.view_layer.update()
    run(mode="RIM", keep_distance=False, distance=3.0)
    np.testing.assert_allclose(place_of(item), expected, atol=1e-3)


def test_keys_are_inserted_where_that_is_on() -> None:
    item = bpy.context.object
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = True
    run(mode="ILLUMINATION")
    curves = [curve.data_path for curve in item.animation_data.action.layers[0].strips[0].channelbags[0].fcurves]
    assert set(curves) == {"location", "rotation_euler"}


def test_bumps_that_are_left_out_are_told(capfd: pytest.CaptureFixture[str]) -> None:
    material = bpy.data.materials.new("Bumpy")
    bpy.data.objects["Mirror"].data.materials.append(material)
    run()
    assert "bumps" not in capfd.readouterr().out
    material.node_tree.nodes.new("ShaderNodeBump")
    run()
    assert "the bumps of that are left out" in capfd.readouterr().out
