# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pointiness and numbers of islands against Cycles: hills in three pieces, some of whose edges are split."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bmesh
import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.meshes.connectivity import ISLAND, POINTINESS, island_numbers, pointiness
from mathutils import Vector
from mathutils.bvhtree import BVHTree

SIDE = 32


def _hills() -> bpy.types.Mesh:
    rng = np.random.default_rng(1)
    made = bmesh.new()
    for x, y, segments in ((-0.5, -0.5, 5), (0.5, 0.5, 6), (-0.5, 0.5, 3)):
        hill = bmesh.ops.create_grid(made, x_segments=segments, y_segments=segments, size=0.45)
        for vertex in hill["verts"]:
            vertex.co += Vector((x, y, 0.3 * rng.random()))
    bmesh.ops.split_edges(made, edges=[edge for number, edge in enumerate(made.edges) if number % 17 == 0])
    mesh = bpy.data.meshes.new("hills")
    made.to_mesh(mesh)
    return mesh


def _rendered(mesh: bpy.types.Mesh, output: str, folder: Path) -> np.ndarray:
    """(SIDE, SIDE) by Cycles, from above: x and y from -1 to 1, rows from below."""
    scene = bpy.context.scene
    material = bpy.data.materials.new("shown")
    tree: Any = material.node_tree
    tree.nodes.clear()
    geometry, shine, end = (
        tree.nodes.new(f"ShaderNode{kind}") for kind in ("NewGeometry", "Emission", "OutputMaterial")
    )
    tree.links.new(geometry.outputs[output], shine.inputs["Color"])
    tree.links.new(shine.outputs[0], end.inputs["Surface"])
    mesh.materials.append(material)
    camera = bpy.data.cameras.new("above")
    camera.type, camera.ortho_scale = "ORTHO", 2.0
    eye = bpy.data.objects.new("above", camera)
    eye.location.z = 5.0
    for item in (eye, bpy.data.objects.new("hills", mesh)):
        scene.collection.objects.link(item)
    scene.camera, scene.render.engine = eye, "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
    scene.render.resolution_x = scene.render.resolution_y = SIDE
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = str(folder / "hills.exr")
    bpy.ops.render.render(write_still=True)
    return np.array(bpy.data.images.load(scene.render.filepath).pixels[:]).reshape(SIDE, SIDE, 4)[..., 0]


@pytest.mark.parametrize(("output", "name"), [("Pointiness", POINTINESS), ("Random Per Island", ISLAND)])
def test_they_are_those_of_cycles(output: str, name: str, tmp_path: Path) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = _hills()
    picture = _rendered(mesh, output, tmp_path)
    places = np.array([vertex.co for vertex in mesh.vertices], np.float32)
    edges = np.array([edge.vertices[:] for edge in mesh.edges], np.int32)
    normals = np.array([normal.vector for normal in mesh.vertex_normals], np.float32)
    values = pointiness(places, normals, edges) if name == POINTINESS else island_numbers(len(places), edges)
    mesh.calc_loop_triangles()
    triangles = [triangle.vertices[:] for triangle in mesh.loop_triangles]
    surface = BVHTree.FromPolygons([vertex.co for vertex in mesh.vertices], triangles)
    seen = 0
    for y, x in np.ndindex(SIDE, SIDE):
        start = Vector(((x + 0.5) / (SIDE / 2) - 1.0, (y + 0.5) / (SIDE / 2) - 1.0, 5.0))
        hit, _, number, _ = surface.ray_cast(start, Vector((0.0, 0.0, -1.0)))
        if hit is None:
            continue
        corners = list(triangles[number])
        weights = np.linalg.solve(np.vstack([places[corners].T[:2], np.ones(3)]), np.array([*hit[:2], 1.0]))
        assert weights @ values[corners] == pytest.approx(picture[y, x], abs=1e-3)
        seen += 1
    assert seen > 400
