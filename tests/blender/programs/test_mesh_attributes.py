# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs read of meshes: by domain and type, and tangents against Blender's own and Cycles'."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.arrays import MeshArrays
from curvrefl.curvrefl_addon.scene.meshes.meshes import MeshNeeds, read_mesh
from curvrefl.curvrefl_addon.scene.programs.program import FACTOR, GEOMETRY, TANGENT, UV, Attribute
from extraction import add, add_square, cycles_picture, empty_scene, look_down, new_material


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def read(mesh: Any, *attributes: Attribute) -> MeshArrays:
    return read_mesh(mesh, MeshNeeds(attributes=tuple(sorted(attributes)))).mesh


def at_corners(mesh: MeshArrays, attribute: Attribute) -> np.ndarray:
    """(triangles, 3, 4)"""
    assert mesh.corner_attributes is not None
    return mesh.corner_attributes[:, mesh.attributes.index(attribute)][mesh.triangles]


VALUES: dict[str, tuple[str, Any, tuple[float, ...]]] = {
    "FLOAT": ("value", 0.3, (0.3, 0.3, 0.3, 1.0)),
    "INT": ("value", 2, (2.0, 2.0, 2.0, 1.0)),
    "BOOLEAN": ("value", True, (1.0, 1.0, 1.0, 1.0)),
    "FLOAT2": ("vector", (0.1, 0.2), (0.1, 0.2, 0.0, 1.0)),
    "FLOAT_VECTOR": ("vector", (0.1, 0.2, 0.6), (0.1, 0.2, 0.6, 1.0)),
    "FLOAT_COLOR": ("color", (0.1, 0.2, 0.6, 0.4), (0.1, 0.2, 0.6, 0.4)),
}


@pytest.mark.parametrize("domain", ["POINT", "EDGE", "FACE", "CORNER"])
def test_attributes_are_four_numbers(domain: str) -> None:
    square = add_square()
    for kind, (name, value, _) in VALUES.items():
        for item in square.data.attributes.new(kind, kind, domain).data:
            setattr(item, name, value)
    wanted = [Attribute(GEOMETRY, kind) for kind in VALUES]
    mesh = read(square.data, *wanted, Attribute(GEOMETRY, "none"), Attribute(FACTOR, "FLOAT2"))
    assert mesh.attributes == tuple(sorted([*wanted, Attribute(FACTOR, "FLOAT2")])), "what it lacks is left out"
    for kind, (_, _, expected) in VALUES.items():
        assert np.allclose(at_corners(mesh, Attribute(GEOMETRY, kind)), expected), kind
    assert np.allclose(at_corners(mesh, Attribute(FACTOR, "FLOAT2")), (0.1, 0.1, 0.1, 1.0))


def test_corners_of_different_values_stay_apart() -> None:
    sheet = add("sheet", [(x, y, 0) for y in range(2) for x in range(3)], [(0, 1, 4, 3), (1, 2, 5, 4)])
    sheet.data.attributes.new("face", "FLOAT", "FACE").data.foreach_set("value", [0.25, 0.75])
    sheet.data.shade_smooth()
    assert len(read(sheet.data).corner_vertex) == 6
    mesh = read(sheet.data, Attribute(GEOMETRY, "face"))
    assert len(mesh.corner_vertex) == 8
    assert sorted(set(at_corners(mesh, Attribute(GEOMETRY, "face"))[..., 0].reshape(-1).tolist())) == [0.25, 0.75]


def test_uv_maps_by_name_and_the_one_that_renders() -> None:
    square = add_square()
    second = square.data.uv_layers.new(name="second")
    second.uv.foreach_set("vector", [0.5] * 8)
    mesh = read(square.data, Attribute(UV, ""), Attribute(UV, "second"), Attribute(UV, "third"))
    assert mesh.attributes == (Attribute(UV, ""), Attribute(UV, "second"))
    place = mesh.positions[mesh.corner_vertex][mesh.triangles]
    assert np.allclose(at_corners(mesh, Attribute(UV, ""))[..., :2], 0.5 * place[..., :2] + 0.5)
    assert np.allclose(at_corners(mesh, Attribute(UV, "second")), (0.5, 0.5, 0.0, 1.0))


def crumpled(count: int) -> Any:
    """A sheet of triangles with bumps and a jittered UV map, a part of which lies the other way round."""
    random = np.random.default_rng(5)
    places = [(x, y, 0.3 * random.random()) for y in range(count) for x in range(count)]
    faces = []
    for y in range(count - 1):
        for x in range(count - 1):
            a = y * count + x
            faces += [(a, a + 1, a + count + 1), (a, a + count + 1, a + count)]
    sheet: Any = add("sheet", places, faces, smooth=True)
    corners = np.array([vertex for face in faces for vertex in face])
    uv = np.array(places)[:, :2] + 0.3 * random.random((len(places), 2))
    uv[:, 0] = np.abs(uv[:, 0] - 0.5 * count)
    sheet.data.uv_layers.new(name="UVMap").uv.foreach_set("vector", uv[corners].astype(np.float32).reshape(-1))
    return sheet


def test_tangents_of_triangles_are_blenders_own() -> None:
    sheet = crumpled(12)
    mesh = read(sheet.data, Attribute(TANGENT, ""))
    found = at_corners(mesh, Attribute(TANGENT, "")).reshape(-1, 4)
    sheet.data.calc_tangents(uvmap="UVMap")
    tangents = np.empty((len(sheet.data.loops), 3), np.float32)
    signs = np.empty(len(sheet.data.loops), np.float32)
    sheet.data.loops.foreach_get("tangent", tangents.reshape(-1))
    sheet.data.loops.foreach_get("bitangent_sign", signs)
    # (Loops of triangles are in their order, but for where each begins.)
    sheet.data.calc_loop_triangles()
    order = np.array([tuple(triangle.loops) for triangle in sheet.data.loop_triangles]).reshape(-1)
    assert set(signs.tolist()) == {-1.0, 1.0}
    assert np.array_equal(found[:, 3], signs[order])
    assert np.abs(found[:, :3] - tangents[order]).max() < 2e-4


def test_tangents_of_quads_are_those_of_cycles(gpu: None) -> None:
    random = np.random.default_rng(3)
    places = np.array([(x, y, 0.0) for y in range(4) for x in range(4)]) - (1.5, 1.5, 0.0)
    places[:, :2] += 0.3 * random.random((16, 2))
    faces = [(a, a + 1, a + 5, a + 4) for y in range(3) for a in range(4 * y, 4 * y + 3)]
    sheet: Any = add("sheet", places.tolist(), faces, smooth=True)
    corners = np.array(faces).reshape(-1)
    uv = (places[:, :2] + 0.8 * random.random((16, 2))).astype(np.float32)
    sheet.data.uv_layers.new(name="UVMap").uv.foreach_set("vector", uv[corners].reshape(-1))
    tree, (emission, tangent, lift) = new_material(
        sheet, "ShaderNodeEmission", "ShaderNodeTangent", "ShaderNodeVectorMath"
    )
    tangent.direction_type, tangent.uv_map = "UV_MAP", "UVMap"
    lift.operation = "ADD"
    lift.inputs[1].default_value = (2.0, 2.0, 2.0)
    tree.links.new(tangent.outputs[0], lift.inputs[0])
    tree.links.new(lift.outputs[0], emission.inputs["Color"])
    look_down(4.0)
    picture = cycles_picture(32, 32, 1) - 2.0
    mesh = read(sheet.data, Attribute(TANGENT, "UVMap"))
    at = at_corners(mesh, Attribute(TANGENT, "UVMap"))
    worst, count = 0.0, 0
    for triangle, own in zip(mesh.triangles, at, strict=True):
        a, b, c = mesh.positions[mesh.corner_vertex[triangle]][:, :2]
        for y in range(32):
            for x in range(32):
                place = (np.array([x, y]) + 0.5) / 8.0 - 2.0
                v, w = np.linalg.solve(np.column_stack([b - a, c - a]), place - a)
                if min(v, w, 1.0 - v - w) > 0.15:
                    expected = np.array([1.0 - v - w, v, w]) @ own[:, :3]
                    expected /= np.linalg.norm(expected)
                    worst = max(worst, float(np.abs(picture[y, x] - expected).max()))
                    count += 1
    assert count > 100
    assert worst < 1.0 / 255.0


def test_generated_and_uv_are_attributes_too() -> None:
    square = add_square(size=4.0)
    bpy.context.view_layer.update()
    mesh = read(square.data, Attribute(GEOMETRY, "generated"), Attribute(GEOMETRY, "uv"))
    place = mesh.positions[mesh.corner_vertex][mesh.triangles]
    assert np.allclose(at_corners(mesh, Attribute(GEOMETRY, "generated"))[..., :2], 0.25 * place[..., :2] + 0.5)
    assert np.allclose(at_corners(mesh, Attribute(GEOMETRY, "uv"))[..., :2], 0.25 * place[..., :2] + 0.5)
