# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes made by hand, as the extraction reads them."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.programs.program import GEOMETRY, UV, Attribute
from extraction import CUBE_CORNERS, add, add_square, empty_scene, extracted, face_normals, mesh_of, new_material


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def textured(obj: bpy.types.Object) -> None:
    """A material that needs the UV map."""
    tree, (shader, texture) = new_material(obj, "ShaderNodeBsdfPrincipled", "ShaderNodeTexImage")
    texture.image = bpy.data.images.new("image", 2, 2)
    tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])


def test_a_smooth_cube_has_its_vertices_for_corners() -> None:
    cube = add("cube", smooth=True)
    mesh = mesh_of(extracted(cube), "cube")
    np.testing.assert_array_equal(mesh.positions, np.array(CUBE_CORNERS, np.float32))
    np.testing.assert_array_equal(mesh.corner_vertex, np.arange(8))
    assert mesh.triangles.shape == (12, 3)
    np.testing.assert_allclose(mesh.corner_normals, np.array(CUBE_CORNERS) / np.sqrt(3.0), atol=1e-6)
    assert mesh.corner_uv is None
    assert mesh.positions.dtype == mesh.corner_normals.dtype == np.float32
    assert mesh.triangles.dtype == mesh.corner_vertex.dtype == mesh.triangle_slot.dtype == np.int32


def test_a_flat_cube_has_normals_of_its_faces() -> None:
    mesh = mesh_of(extracted(add("cube")), "cube")
    assert len(mesh.corner_vertex) == 24
    for k in range(3):
        np.testing.assert_allclose(mesh.corner_normals[mesh.triangles[:, k]], face_normals(mesh), atol=1e-6)


def test_a_sharp_edge_splits_only_its_own_corners() -> None:
    cube = add("cube", smooth=True)
    sharp = {(0, 1), (1, 5), (4, 5), (0, 4)}  # around the face at y = -1
    attribute = cube.data.attributes.new("sharp_edge", "BOOLEAN", "EDGE")
    for edge in cube.data.edges:
        attribute.data[edge.index].value = tuple(sorted(edge.vertices)) in sharp
    mesh = mesh_of(extracted(cube), "cube")
    assert len(mesh.positions) == 8
    assert len(mesh.corner_vertex) == 12
    front = np.isclose(face_normals(mesh)[:, 1], -1.0)
    corners = mesh.triangles[front].ravel()
    np.testing.assert_allclose(mesh.corner_normals[corners], np.tile([0.0, -1.0, 0.0], (6, 1)), atol=1e-6)


def test_custom_normals() -> None:
    cube = add("cube", smooth=True)
    tilted = np.array([0.6, 0.0, 0.8])
    cube.data.normals_split_custom_set([tilted.tolist()] * 24)
    mesh = mesh_of(extracted(cube), "cube")
    np.testing.assert_allclose(mesh.corner_normals, np.tile(tilted, (len(mesh.corner_vertex), 1)), atol=2e-3)


def test_a_uv_map_splits_corners_at_its_seams() -> None:
    # Two squares side by side on a smooth sheet; the second one's UVs do not continue the first one's.
    sheet = add(
        "sheet", [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0)], [(0, 1, 4, 3), (1, 2, 5, 4)]
    )
    sheet.data.shade_smooth()
    square = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]
    sheet.data.uv_layers.new(name="UVMap").uv.foreach_set("vector", square * 2)
    textured(sheet)
    mesh = mesh_of(extracted(sheet), "sheet")
    assert len(mesh.positions) == 6
    assert len(mesh.corner_vertex) == 8
    assert mesh.corner_uv is not None
    # Within each square u is x, up to whole numbers, and v is y.
    places = mesh.positions[mesh.corner_vertex]
    np.testing.assert_allclose(mesh.corner_uv[:, 1], places[:, 1], atol=1e-6)
    assert set(np.round(mesh.corner_uv[:, 0] - places[:, 0], 6)) == {0.0, -1.0}
    for triangle in mesh.triangles:
        assert np.ptp(np.round(mesh.corner_uv[triangle, 0] - places[triangle, 0], 6)) == 0.0


def test_a_uv_map_without_seams_leaves_the_vertices_whole() -> None:
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=7, y_subdivisions=5)
    grid = bpy.context.object
    bpy.ops.object.shade_smooth()
    textured(grid)
    mesh = mesh_of(extracted(grid), grid.name)
    np.testing.assert_array_equal(mesh.corner_vertex, np.arange(len(mesh.positions)))
    assert mesh.corner_uv is not None
    np.testing.assert_allclose(mesh.corner_uv, 0.5 * mesh.positions[:, :2] + 0.5, atol=1e-5)


def test_a_uv_map_is_read_where_a_material_needs_it_and_of_reflectors() -> None:
    square = add_square()
    assert mesh_of(extracted(), "square").corner_uv is None
    assert mesh_of(extracted(square), "square").corner_uv is not None


def read_of(scene: SceneArrays, kind: str, name: str) -> np.ndarray | None:
    """(corners, 4) of an attribute of the square."""
    mesh = mesh_of(scene, "square")
    if Attribute(kind, name) not in mesh.attributes:
        return None
    assert mesh.corner_attributes is not None
    return mesh.corner_attributes[:, mesh.attributes.index(Attribute(kind, name))]


def test_the_map_active_for_rendering_and_a_named_map() -> None:
    square = add_square()
    other = square.data.uv_layers.new(name="other")
    other.uv.foreach_set("vector", [0.5] * 8)
    textured(square)
    assert np.ptp(read_of(extracted(square), UV, "")[:, :2]) == 1.0
    other.active_render = True
    assert np.ptp(read_of(extracted(square), UV, "")[:, :2]) == 0.0
    tree = square.data.materials[0].node_tree
    named = tree.nodes.new("ShaderNodeUVMap")
    named.uv_map = "UVMap"
    tree.links.new(named.outputs["UV"], tree.nodes["Image Texture"].inputs["Vector"])
    assert np.ptp(read_of(extracted(square), UV, "UVMap")[:, :2]) == 1.0
    named.uv_map = "gone"
    scene = extracted(square)
    assert read_of(scene, UV, "gone") is None
    # Cycles shows the pixel at the image's corner all over, and so does a mesh without coordinates.
    assert not any("UV" in warning or "coordinates" in warning for warning in scene.warnings)


@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
@pytest.mark.parametrize("data_type", ["FLOAT_COLOR", "BYTE_COLOR"])
def test_vertex_colors_are_scene_linear(domain: str, data_type: str) -> None:
    square = add_square()
    colors = square.data.color_attributes.new("Color", data_type, domain)
    for item in colors.data:
        item.color = (0.5, 0.25, 0.0, 1.0)
    tree, (shader, source) = new_material(square, "ShaderNodeBsdfDiffuse", "ShaderNodeVertexColor")
    tree.links.new(source.outputs["Color"], shader.inputs["Color"])
    scene = extracted(square)
    np.testing.assert_allclose(read_of(scene, GEOMETRY, ""), np.tile([0.5, 0.25, 0.0, 1.0], (4, 1)), atol=5e-3)
    assert not scene.warnings


def test_modifiers_and_polygons_of_many_sides() -> None:
    turns = np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
    disk = add("disk", [(np.cos(t), np.sin(t), 0.0) for t in turns], [tuple(range(8))])
    array = disk.modifiers.new("array", "ARRAY")
    array.count = 3
    mesh = mesh_of(extracted(disk), "disk")
    assert len(mesh.positions) == 24
    assert mesh.triangles.shape == (18, 3)
    np.testing.assert_allclose(face_normals(mesh), np.tile([0.0, 0.0, 1.0], (18, 1)), atol=1e-6)
    array.show_render = False
    assert len(mesh_of(extracted(disk), "disk").positions) == 8


def test_material_slots_of_triangles() -> None:
    cube = add("cube")
    for _ in range(2):
        cube.data.materials.append(bpy.data.materials.new("m"))
    cube.data.polygons[5].material_index = 1
    mesh = mesh_of(extracted(cube), "cube")
    np.testing.assert_array_equal(mesh.triangle_slot, np.isclose(face_normals(mesh)[:, 0], 1.0).astype(int))


def test_vertices_without_faces_are_left_out() -> None:
    triangle = add("triangle", [(9, 9, 9), (0, 0, 0), (1, 0, 0), (0, 1, 0), (8, 8, 8)], [(1, 2, 3)], smooth=True)
    mesh = mesh_of(extracted(triangle), "triangle")
    np.testing.assert_array_equal(mesh.positions, [(0, 0, 0), (1, 0, 0), (0, 1, 0)])


def test_coordinates_that_are_not_finite() -> None:
    square = add_square()
    strip = add(
        "strip", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)], [(0, 1, 2, 3), (1, 4, 2)], smooth=True
    )
    strip.data.vertices[4].co.x = float("nan")
    scene = extracted(square)
    mesh = mesh_of(scene, "strip")
    assert mesh.triangles.shape == (2, 3)
    assert np.isfinite(mesh.positions).all() and np.isfinite(mesh.corner_normals).all()
    np.testing.assert_allclose(mesh.corner_normals, np.tile([0.0, 0.0, 1.0], (4, 1)), atol=1e-6)
    assert any('1 triangles of "strip"' in warning for warning in scene.warnings)
    with pytest.raises(InputError, match='"strip" has vertices at no finite place'):
        extracted(strip)


def test_a_signature_follows_the_mesh() -> None:
    cube = add("cube")
    first = mesh_of(extracted(cube), "cube").signature
    assert mesh_of(extracted(cube), "cube").signature == first
    cube.data.vertices[0].co.x += 1e-5
    cube.data.update()
    assert mesh_of(extracted(cube), "cube").signature != first


def test_surfaces_that_are_no_meshes() -> None:
    bpy.ops.surface.primitive_nurbs_surface_sphere_add(radius=1.0)
    bpy.ops.object.text_add()
    bpy.ops.curve.primitive_bezier_circle_add()
    bpy.context.object.data.bevel_depth = 0.1
    bpy.ops.object.metaball_add()
    bpy.ops.object.metaball_add(location=(1.0, 0.0, 0.0))
    bpy.ops.curve.primitive_bezier_circle_add()
    bpy.context.object.name = "no surface"
    scene = extracted()
    names = [instance.object_name for instance in scene.instances]
    assert names.count("Mball") == 1
    assert sorted(set(names)) == sorted(["SurfSphere", "Text", "BézierCircle", "Mball"])


def test_what_is_being_edited() -> None:
    cube = add("cube")
    bpy.context.view_layer.objects.active = cube
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        assert len(mesh_of(extracted(cube), "cube").triangles) == 12
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
