# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The demo scene keeps what it promises: a star-shaped convex mirror in contact with things, all in one file."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from curvrefl.curvrefl_addon.demo import scene as demo  # noqa: E402
from curvrefl.curvrefl_addon.demo.shapes import star_level  # noqa: E402

TOUCHING = ("Spout", "Lid knob", "Handle", "Block 1", "Ball", "Book cover", "Table")


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
    return float(star_level(demo.body_radius, points - np.array(demo.BODY_CENTER)).min())


def test_body_is_star_shaped_and_convex(demo_file: Path) -> None:
    triangles = world_triangles(demo.KETTLE)
    assert 5_000 <= len(triangles) <= 20_000
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    outward = triangles.mean(1) - np.array(demo.BODY_CENTER)
    facing = (normals * outward).sum(1) / np.linalg.norm(outward, axis=1)
    assert facing.min() > 0.5
    # Convex: no vertex stands out before the plane of any face by more than rounding.
    vertices = np.unique(triangles.reshape(-1, 3).round(9), axis=0)
    sample = slice(None, None, 37)
    heights = normals[sample] @ vertices.T - (normals[sample] * triangles[sample, 0]).sum(1)[:, None]
    assert heights.max() < 1e-3 * demo.BODY_WIDTH
    # Closed: every edge has two faces.
    mesh = bpy.data.objects[demo.KETTLE].data
    assert len(mesh.edges) == 2 * len(mesh.polygons)
    assert len(mesh.vertices) - len(mesh.edges) + len(mesh.polygons) == 2


@pytest.mark.parametrize("name", TOUCHING)
def test_things_touch_the_kettle_without_entering_it(demo_file: Path, name: str) -> None:
    gap = distance_to_body(name)
    radius = 0.5 * demo.BODY_WIDTH
    # Between the vertices of a landed ring a straight edge runs a little deeper into the round body.
    assert -0.01 * radius < gap < 0.01 * radius


def test_nothing_sinks_into_the_table(demo_file: Path) -> None:
    for thing in bpy.data.objects:
        if thing.type == "MESH" and thing.name != "Table":
            assert world_triangles(thing.name)[..., 2].min() > -3e-4, thing.name


@pytest.mark.parametrize(
    "name", ["Suzanne", "Block 1", "Block 2", "Ball", "Book cover", "Mug", "Lemon", "Tower 1", "Pencil"]
)
def test_nothing_floats_above_the_table(demo_file: Path, name: str) -> None:
    assert world_triangles(name)[..., 2].min() < 1e-3


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
    assert seen.count(demo.KETTLE) > 0.2 * len(seen)
    assert {"Suzanne", "Ball", "Block 1", "Book cover", "Table", "Spout", "Handle", ""} <= set(seen)
    assert not {"Mug", "Lemon", "Pencil", "Tower 1", "Tower 4"} & set(seen)


def test_file_holds_all_it_needs(demo_file: Path) -> None:
    pictures = [image for image in bpy.data.images if image.type == "IMAGE"]
    assert {"Planks", "Stripes", "forest.exr"} <= {image.name for image in pictures}
    for image in pictures:
        assert image.packed_file is not None, image.name
        assert image.has_data or image.pixels[0] >= 0.0
        assert min(image.size) > 0
    assert not bpy.data.libraries
    kinds = [light.type for light in bpy.data.lights]
    assert kinds == ["SUN"] and bpy.data.lights[0].use_shadow
    rest = sum(len(world_triangles(o.name)) for o in bpy.data.objects if o.type == "MESH" and o.name != demo.KETTLE)
    assert 4_000 < rest < 8_000
    for thing in bpy.data.objects:
        if thing.type == "MESH":
            assert thing.material_slots and all(slot.material for slot in thing.material_slots)
