# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The demo scene keeps what it promises: star-shaped mirrors in a room, in contact with things, all in one file."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from curvrefl.curvrefl_addon.demo import kettle  # noqa: E402
from curvrefl.curvrefl_addon.demo import scene as demo  # noqa: E402
from curvrefl.curvrefl_addon.demo.shapes import star_level  # noqa: E402

TOUCHING = ("Lid knob", "Handle", "Ball", "Book cover", "Table")
STANDING = ("Kettle", "Suzanne", "Ball", "Book cover", "Lacquer jar", "Carafe", "Bowl", "Lamp foot", "Candle dish")
UNSEEN = ("Mug", "Lemon", "Pencil", "Candle")
"""On the table, out of the picture"""
MOST_TRIANGLES = 150_000


@pytest.fixture(scope="module")
def demo_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The demo, built in an otherwise empty folder and opened again."""
    path = tmp_path_factory.mktemp("demo") / "demo.blend"
    start = time.perf_counter()
    demo.build_demo(path)
    assert time.perf_counter() - start < 15.0  # 1 s alone
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return path


def world_triangles(name: str) -> np.ndarray:
    """(triangles, 3, 3) world corners of an evaluated object."""
    graph = bpy.context.evaluated_depsgraph_get()
    thing = bpy.data.objects[name].evaluated_get(graph)
    mesh = thing.data
    mesh.calc_loop_triangles()
    positions = np.array([v.co[:] for v in mesh.vertices]) @ np.array(thing.matrix_world)[:3, :3].T
    return (positions + np.array(thing.matrix_world)[:3, 3])[[t.vertices[:] for t in mesh.loop_triangles]]


def distance_to_body(name: str) -> float:
    """Smallest radial distance of an object's surface samples from the kettle, in meters; negative is inside it."""
    triangles = world_triangles(name)
    weights = np.array([(i, j, 20 - i - j) for i in range(21) for j in range(21 - i)]) / 20.0
    points = np.einsum("wc,tcx->twx", weights, triangles).reshape(-1, 3)
    return float(star_level(kettle.body_radius, points - np.array(kettle.BODY_CENTER)).min())


def mesh_of(name: str) -> bpy.types.Mesh:
    return bpy.data.objects[name].data


@pytest.mark.parametrize("name, least", [("Kettle", 0.02), ("Lacquer jar", 0.5)])
def test_mirrors_are_star_shaped_and_closed(demo_file: Path, name: str, least: float) -> None:
    triangles = world_triangles(name)
    assert 5_000 <= len(triangles) <= 40_000
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    outward = triangles.mean(1) - np.array(bpy.data.objects[name].location)
    facing = (normals * outward).sum(1) / np.linalg.norm(outward, axis=1)
    assert facing.min() > least
    # Every edge has two faces.
    mesh = mesh_of(name)
    assert len(mesh.edges) == 2 * len(mesh.polygons)
    assert len(mesh.vertices) - len(mesh.edges) + len(mesh.polygons) == 2


def test_kettle_bends_both_ways_at_lid_and_spout_alone(demo_file: Path) -> None:
    triangles = world_triangles(demo.KETTLE) - np.array(kettle.BODY_CENTER)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    directions = triangles.mean(1) / np.linalg.norm(triangles.mean(1), axis=1, keepdims=True)
    from_spout = np.degrees(np.arccos(np.clip(directions @ kettle.spout_axis(), -1.0, 1.0)))
    plain = (from_spout > 30.0) & (np.degrees(np.arccos(directions[:, 2])) > 47.0)
    vertices = triangles[plain].reshape(-1, 3)

    def height(faces: np.ndarray) -> float:
        """How far a vertex of the plain part stands out before the plane of a face."""
        return float((normals[faces] @ vertices.T - (normals[faces] * triangles[faces, 0]).sum(1)[:, None]).max())

    assert height(np.flatnonzero(plain)[::97]) < 1e-3 * kettle.BODY_WIDTH
    assert height(np.flatnonzero(from_spout < 15.0)[::37]) > 0.1 * kettle.BODY_WIDTH


@pytest.mark.parametrize("name", TOUCHING)
def test_things_touch_the_kettle_without_entering_it(demo_file: Path, name: str) -> None:
    gap = distance_to_body(name)
    radius = 0.5 * kettle.BODY_WIDTH
    # Between the vertices of a landed ring a straight edge runs a little deeper into the round body.
    assert -0.01 * radius < gap < 0.01 * radius


@pytest.mark.parametrize("name", [*STANDING, "Mug", "Lemon", "Pencil"])
def test_things_stand_on_the_table(demo_file: Path, name: str) -> None:
    assert -3e-4 < world_triangles(name)[..., 2].min() < 1e-3


def test_camera_sees_a_large_mirror_and_not_the_unseen_things(demo_file: Path) -> None:
    scene = bpy.context.scene
    assert (scene.render.resolution_x, scene.render.resolution_y) == (640, 480)
    camera = scene.camera
    graph = bpy.context.evaluated_depsgraph_get()
    frame = np.array([c[:] for c in camera.data.view_frame(scene=scene)])
    low, high = frame.min(0), frame.max(0)
    turn, eye = np.array(camera.matrix_world)[:3, :3], np.array(camera.matrix_world)[:3, 3]
    seen = []
    for row in range(24):
        for column in range(32):
            at = [low[0] + (column + 0.5) / 32 * (high[0] - low[0]), low[1] + (row + 0.5) / 24 * (high[1] - low[1])]
            way = turn @ np.array([*at, low[2]])
            hit, _, _, _, thing, _ = scene.ray_cast(graph, eye, way)
            seen.append(thing.name if hit else "")
    assert seen.count(demo.KETTLE) > 0.15 * len(seen)
    assert set(demo.MIRRORS) <= set(seen)
    assert {"Suzanne", "Ball", "Table", "Handle", "Back wall", "Lamp shade", "Neon cup", "Picture", "Carafe"} <= set(
        seen
    )
    assert not set(UNSEEN) & set(seen)
    # The room is closed but for its windows, and these show the garden or the sky.
    assert seen.count("") < 0.05 * len(seen)


def test_file_holds_all_it_needs(demo_file: Path) -> None:
    pictures = [image for image in bpy.data.images if image.type == "IMAGE"]
    assert {"Oak planks", "Striped rubber", "Rug", "Print"} <= {image.name for image in pictures}
    for image in pictures:
        assert image.packed_file is not None, image.name
        assert image.has_data or image.pixels[0] >= 0.0
        assert min(image.size) > 0
    assert not bpy.data.libraries
    assert sorted(light.type for light in bpy.data.lights) == ["AREA", "SUN"]
    assert all(light.use_shadow for light in bpy.data.lights)
    count = sum(len(world_triangles(thing.name)) for thing in bpy.data.objects if thing.type == "MESH")
    assert 50_000 < count < MOST_TRIANGLES
    for thing in bpy.data.objects:
        if thing.type == "MESH":
            assert thing.material_slots and all(slot.material for slot in thing.material_slots)
