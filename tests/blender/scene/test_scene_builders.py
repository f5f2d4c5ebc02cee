# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The test scenes in Blender: Cycles shows what the hidden-surface scenes promise; the others have their parts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from curvrefl.curvrefl_addon.demo.shapes import RadiusFunction, star_level  # noqa: E402
from scenes.builders import (  # noqa: E402
    SCENES,
    build_case,
    bumpy_radius,
    ellipsoid_radius,
    sphere_radius,
)
from scenes.hidden_surfaces import CASES  # noqa: E402
from scenes.sheets import MIRROR, SIZE  # noqa: E402


@pytest.mark.parametrize("name", CASES)
def test_cycles_shows_what_the_case_expects(name: str, tmp_path: Path) -> None:
    case = CASES[name]()
    build_case(case)
    settings = bpy.context.scene.render
    settings.image_settings.media_type = "IMAGE"
    settings.image_settings.file_format = "OPEN_EXR"
    settings.filepath = str(tmp_path / "case.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(settings.filepath)
    pixels = np.empty(SIZE * SIZE * 4, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(SIZE, SIZE, 4)
    for pixel in case.pixels:
        assert np.allclose(pixels[pixel.row, pixel.column, :3], pixel.color, atol=0.004), pixel


@pytest.mark.parametrize(
    ("name", "radius"), [("sphere", sphere_radius), ("ellipsoid", ellipsoid_radius), ("bumpy", bumpy_radius)]
)
def test_mirrors_stand_among_things_near_and_far(name: str, radius: RadiusFunction) -> None:
    SCENES[name]()
    graph = bpy.context.evaluated_depsgraph_get()
    nearest, farthest, rest = [], 0.0, 0
    for thing in bpy.data.objects:
        if thing.type != "MESH":
            continue
        mesh = thing.evaluated_get(graph).data
        mesh.calc_loop_triangles()
        if thing.name == MIRROR:
            assert len(mesh.loop_triangles) > 20_000
            continue
        rest += len(mesh.loop_triangles)
        points = np.array([thing.matrix_world @ v.co for v in mesh.vertices])
        nearest.append(star_level(radius, points).min())
        farthest = max(farthest, float(np.linalg.norm(points, axis=1).max()))
    assert 4_000 < rest < 8_000
    assert -1e-6 < min(nearest) < 0.1
    assert farthest > 10.0
    assert bpy.context.scene.camera is not None


def test_mirror_normals_are_the_surface_s_own() -> None:
    mesh = SCENES["ellipsoid"]().data
    corner_normals = np.array([n.vector[:] for n in mesh.corner_normals])
    vertices = np.array([v.co[:] for v in mesh.vertices])[[loop.vertex_index for loop in mesh.loops]]
    exact = vertices / np.array([2.0, 0.5, 1.0]) ** 2
    exact /= np.linalg.norm(exact, axis=1, keepdims=True)
    assert np.abs(corner_normals - exact).max() < 2e-3  # custom normals are kept in 16 bits


def test_million_has_a_million_vertices() -> None:
    SCENES["million"]()
    graph = bpy.context.evaluated_depsgraph_get()
    vertices = sum(
        len(instance.object.data.vertices) for instance in graph.object_instances if instance.object.type == "MESH"
    )
    assert vertices > 1_000_000
    assert len(bpy.data.objects) > 2_000
    assert bpy.data.meshes["Ground"].validate() is False
