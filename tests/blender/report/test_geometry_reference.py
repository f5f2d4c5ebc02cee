# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles' reflected positions against a ray trace in closed form: a mirror sphere over a floor, around the origin."""

from __future__ import annotations

from itertools import pairwise

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.report.geometry_reference import UNLISTED_OBJECT, GeometryReference, render_geometry
from curvrefl.curvrefl_addon.report.metrics import direction_angle_deg, geometry_error

WIDTH, HEIGHT = 64, 48
RADIUS, FLOOR_Z, FLOOR_HALF = 1.0, -1.25, 4.0
EYE = np.array([0.5, -6.0, 1.0])
SPHERE, FLOOR, CUBE = 37, 70001, 5
IDS = {"sphere": SPHERE, "floor": FLOOR, "cube": CUBE}


def sphere(name: str, columns: int = 256, rows: int = 128) -> bpy.types.Object:
    """A smooth sphere about the origin, fine enough for its normals to be the exact ones."""
    longitude, latitude = np.meshgrid(np.arange(columns) * 2 * np.pi / columns, np.arange(1, rows) * np.pi / rows)
    ring = np.stack((np.cos(longitude) * np.sin(latitude), np.sin(longitude) * np.sin(latitude), np.cos(latitude)), 2)
    vertices = np.concatenate((RADIUS * ring.reshape(-1, 3), [(0, 0, RADIUS), (0, 0, -RADIUS)]))
    top, bottom = len(vertices) - 2, len(vertices) - 1
    faces: list[tuple[int, ...]] = []
    for column in range(columns):
        after = (column + 1) % columns
        starts = [row * columns for row in range(rows - 1)]
        faces.append((top, starts[0] + column, starts[0] + after))
        faces.append((starts[-1] + after, starts[-1] + column, bottom))
        faces += [(a + after, a + column, b + column, b + after) for a, b in pairwise(starts)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], faces)
    mesh.shade_smooth()
    mesh.update()
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


@pytest.fixture
def scene() -> bpy.types.Scene:
    """Sphere, floor, a lamp and, far to the side, a cube that is seen only as an instance (at x = -5)."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    sphere("sphere")
    bpy.ops.mesh.primitive_plane_add(size=2 * FLOOR_HALF, location=(0, 0, FLOOR_Z))
    bpy.context.object.name = "floor"
    bpy.context.object.data.materials.append(bpy.data.materials.new("wood"))
    bpy.ops.mesh.primitive_cube_add(size=2)
    cube = bpy.context.object
    cube.name = "cube"
    hidden = bpy.data.collections.new("library")
    scene.collection.objects.unlink(cube)
    hidden.objects.link(cube)
    empty = bpy.data.objects.new("placed", None)
    empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", hidden, (-5, 0, 0)
    scene.collection.objects.link(empty)
    bpy.ops.object.light_add(type="AREA", location=(3, -3, 5))
    bpy.context.object.data.energy = 1000
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = EYE, (np.radians(82.0), 0.0, np.radians(4.0))
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.context.view_layer.update()
    return scene


def render(scene: bpy.types.Scene) -> GeometryReference:
    return render_geometry(scene, bpy.context.view_layer, WIDTH, HEIGHT, IDS, {SPHERE})


def pixel_rays(scene: bpy.types.Scene) -> np.ndarray:
    """(h, w, 3) unit directions through the pixel centers, row 0 at the bottom."""
    camera = scene.camera
    projection = np.array(
        camera.calc_matrix_camera(bpy.context.evaluated_depsgraph_get(), x=WIDTH, y=HEIGHT), np.float64
    )
    x, y = np.meshgrid((np.arange(WIDTH) + 0.5) / WIDTH * 2 - 1, (np.arange(HEIGHT) + 0.5) / HEIGHT * 2 - 1)
    in_camera = np.stack(
        ((x + projection[0, 2]) / projection[0, 0], (y + projection[1, 2]) / projection[1, 1], -np.ones_like(x)), 2
    )
    rays = in_camera @ np.array(camera.matrix_world, np.float64)[:3, :3].T
    return rays / np.linalg.norm(rays, axis=2, keepdims=True)


def closed_form(scene: bpy.types.Scene) -> dict[str, np.ndarray]:
    """Sphere hit and reflection on floor or background; the cube is not traced."""
    d = pixel_rays(scene)
    b = d @ EYE
    discriminant = b * b - (EYE @ EYE - RADIUS**2)
    hit = discriminant > 0
    p = EYE + (-b - np.sqrt(np.where(hit, discriminant, 0)))[..., None] * d
    n = p / RADIUS
    r = d - 2 * np.sum(d * n, 2, keepdims=True) * n
    down = np.where(r[..., 2] < 0, r[..., 2], -1.0)
    q = p + ((FLOOR_Z - p[..., 2]) / down)[..., None] * r
    on_floor = (r[..., 2] < 0) & (np.abs(q[..., :2]) < FLOOR_HALF).all(axis=2)
    target = np.where(on_floor[..., None], np.concatenate((q, np.ones_like(b)[..., None]), 2), 0)
    target[~on_floor, :3] = r[~on_floor]
    return {"hit": hit, "p": p, "target": target, "on_floor": on_floor}


def test_against_closed_form(scene: bpy.types.Scene) -> None:
    reference, exact = render(scene), closed_form(scene)
    mask = reference.mask == SPHERE
    assert (mask == exact["hit"]).mean() > 0.998, "only pixels at the silhouette may differ (tessellation)"
    both = mask & exact["hit"] & reference.valid & (reference.reflected_object != CUBE)
    assert both.sum() > 250
    assert np.linalg.norm((reference.reflector_position - exact["p"])[both], axis=1).max() < 0.01
    same = both & ((reference.reflected_object == FLOOR) == exact["on_floor"])
    assert same.sum() > 0.99 * both.sum(), "only at the floor's rim may tessellation change the target"
    angle = direction_angle_deg(
        reference.reflector_position[same].astype(float), reference.reflected_position[same].astype(float),
        exact["target"][same],
    )  # fmt: skip
    assert np.median(angle) < 0.05
    assert np.percentile(angle, 99) < 1.0


def test_points_and_directions_are_exact(scene: bpy.types.Scene) -> None:
    """Floor points lie on the floor, on both sides of the origin; background directions are unit vectors."""
    reference = render(scene)
    floor = reference.reflected_object == FLOOR
    in_mirror = floor & (reference.mask != 0)
    points = reference.reflected_position[in_mirror]
    assert np.all(points[:, 3] == 1.0)
    assert points[:, 2] == pytest.approx(FLOOR_Z, abs=1e-6)
    assert points[:, 0].min() < -1.0 and points[:, 0].max() > 1.0, "negative coordinates survive"
    background = reference.valid & (reference.reflected_object == 0)
    directions = reference.reflected_position[background]
    assert len(directions) > 50
    assert np.all(directions[:, 3] == 0.0)
    assert np.linalg.norm(directions[:, :3], axis=1) == pytest.approx(1.0, abs=1e-5)


def test_instances_carry_the_id_of_their_object(scene: bpy.types.Scene) -> None:
    reference = render(scene)
    cube = reference.valid & (reference.reflected_object == CUBE)
    assert cube.sum() > 3
    assert np.abs(reference.reflected_position[cube][:, :3] - (-5, 0, 0)).max(axis=1) == pytest.approx(1.0, abs=1e-5)
    assert set(np.unique(reference.reflected_object[reference.valid])) == {0, FLOOR, CUBE}


def test_unlisted_objects_are_nobody(scene: bpy.types.Scene) -> None:
    reference = render_geometry(scene, bpy.context.view_layer, WIDTH, HEIGHT, {"sphere": SPHERE}, {SPHERE})
    assert set(np.unique(reference.reflected_object[reference.valid])) == {0, UNLISTED_OBJECT}


def test_lamps_and_film_exposure_do_not_change_positions(scene: bpy.types.Scene) -> None:
    before = render(scene)
    scene.cycles.film_exposure = 3.0
    scene.view_settings.exposure = 2.0
    for light in bpy.data.lights:
        light.energy = 1e6
    after = render(scene)
    assert np.array_equal(before.reflected_position, after.reflected_position)


def test_objects_hidden_from_mirrors_are_not_reflected(scene: bpy.types.Scene) -> None:
    bpy.data.objects["floor"].visible_glossy = False
    assert FLOOR not in np.unique(render(scene).reflected_object)


def test_a_mirror_in_a_mirror_is_the_point_on_it(scene: bpy.types.Scene) -> None:
    bpy.data.objects["placed"].location = (0, 0, 50)
    ids = {"sphere": SPHERE, "floor": FLOOR}
    reference = render_geometry(scene, bpy.context.view_layer, WIDTH, HEIGHT, ids, {SPHERE, FLOOR})
    shown = (reference.mask == FLOOR) & (reference.reflected_object == SPHERE)
    assert shown.sum() > 10
    radius = np.linalg.norm(reference.reflected_position[shown][:, :3], axis=1)
    assert radius == pytest.approx(RADIUS, abs=1e-3)


def test_flat_mirror_is_exact(scene: bpy.types.Scene) -> None:
    """The floor as the mirror: what is shown lies on the mirrored ray, to float precision."""
    reference = render_geometry(scene, bpy.context.view_layer, WIDTH, HEIGHT, IDS, {FLOOR})
    sure = reference.valid
    assert sure.sum() > 300
    p = reference.reflector_position[sure].astype(float)
    ray = p - EYE
    mirrored = np.concatenate((ray * (1, 1, -1), np.zeros((len(p), 1))), 1)
    angle = direction_angle_deg(p, reference.reflected_position[sure].astype(float), mirrored)
    assert angle.max() < 1e-3


def test_the_reference_has_no_error_against_itself(scene: bpy.types.Scene) -> None:
    one, two = render(scene), render(scene)
    error = geometry_error(
        mask=one.mask,
        reflected_position=one.reflected_position,
        reflected_object=one.reflected_object,
        reference_mask=two.mask,
        reference_reflector_position=two.reflector_position,
        reference_reflected_position=two.reflected_position,
        reference_reflected_object=two.reflected_object,
        reference_valid=two.valid,
    )
    assert error == {"angle_deg": {"median": 0.0, "p95": 0.0, "p99": 0.0}, "wrong_object": 0.0}


def test_viewport_subdivision_is_what_is_rendered(scene: bpy.types.Scene) -> None:
    """A cube as the reflector: subdivided when rendered by the user, a cube in the viewport."""
    bpy.ops.mesh.primitive_cube_add(size=2, location=(0, 0, 0))
    bpy.context.object.name = "box"
    bpy.data.objects["sphere"].hide_viewport = True
    modifier = bpy.data.objects["box"].modifiers.new("subdivision", "SUBSURF")
    modifier.levels, modifier.render_levels = 0, 3
    bpy.context.view_layer.update()
    reference = render_geometry(scene, bpy.context.view_layer, WIDTH, HEIGHT, {"box": 9}, {9})
    on_box = reference.reflector_position[reference.mask == 9]
    assert np.abs(on_box).max(axis=1) == pytest.approx(1.0, abs=1e-5)
    assert modifier.render_levels == 3
    assert not bpy.data.objects["sphere"].hide_render
