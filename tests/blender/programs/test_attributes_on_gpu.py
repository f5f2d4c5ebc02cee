# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes and rows of instances as shaders find them, at corners of chunks and where rays hit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.renderer.device.records import empty_record_texture, read_records
from curvrefl.curvrefl_addon.renderer.device.shaders import Image, Piece, build_shader, dispatch
from curvrefl.curvrefl_addon.renderer.geometry.chunk_attributes import (
    CORNER_ATTRIBUTES,
    CORNER_INSTANCES,
    attributes_of,
)
from curvrefl.curvrefl_addon.renderer.geometry.mesh_facts import MeshFactsCache
from curvrefl.curvrefl_addon.renderer.geometry.scene_geometry import SceneGeometry
from curvrefl.curvrefl_addon.renderer.geometry.split import split_mesh
from curvrefl.curvrefl_addon.renderer.geometry.vertex_uploads import VertexUploads
from curvrefl.curvrefl_addon.renderer.programs.instance_table import PLAIN_VALUES, InstanceTable
from curvrefl.curvrefl_addon.renderer.rays.ray_instances import INSTANCE_RECORDS
from curvrefl.curvrefl_addon.renderer.rays.ray_records import TRIANGLE_RECORDS
from curvrefl.curvrefl_addon.renderer.rays.ray_scene import RAYS, RayScene
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays
from curvrefl.curvrefl_addon.scene.programs.program import GEOMETRY, UV, Attribute, Program, Shape
from curvrefl.gpu_shaders.loader import Snippet

TINT, HEAT, MAP = Attribute(GEOMETRY, "tint"), Attribute(GEOMETRY, "heat"), Attribute(UV, "")


def mesh(shift: float, *attributes: Attribute) -> MeshArrays:
    """A triangle whose attributes are numbers of their own at each corner."""
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], np.float32)
    values = None
    if attributes:
        values = (np.arange(12 * len(attributes), dtype=np.float32) + 100.0 * shift).reshape(3, len(attributes), 4)
    return MeshArrays(
        name=f"mesh {shift}",
        positions=corners + np.float32(shift),
        corner_vertex=np.arange(3, dtype=np.int32),
        corner_normals=np.tile(np.array([0.0, 0.0, 1.0], np.float32), (3, 1)),
        corner_uv=None,
        triangles=np.array([[0, 1, 2]], np.int32),
        triangle_slot=np.zeros(1, np.int32),
        attributes=attributes,
        corner_attributes=values,
    )


def scene_of(*meshes: MeshArrays) -> SceneArrays:
    """One instance of each, and a program that reads all three attributes, and a value of instances."""
    program = Program(
        Shape("", needs=frozenset({"PROGRAM_INSTANCE"})),
        np.zeros((0, 4), np.float32),
        (TINT, MAP, HEAT),
        instance_attributes=("OBJECT:age",),
    )
    instances = tuple(
        InstanceArrays(f"object {index}", index + 1, index, np.eye(4), (0,), random=0.125 * index)
        for index in range(len(meshes))
    )
    return SceneArrays(meshes, instances, (MaterialArrays("m", program=program),), (), (), WorldArrays())


def computed(count: int, glsl: str, *pieces: Piece, **samplers: Any) -> np.ndarray:
    """(count, 4) what the expressions `glsl` of `index` are."""
    text = f"void main()\n{{\n  int index = int(gl_GlobalInvocationID.x);\n  if (index < {count}) {{\n"
    text += f"    imageStore(result, texel_of_record(index), {glsl});\n  }}\n}}\n"
    result = empty_record_texture(count)
    shader = build_shader(
        "of a test", *pieces, Piece(images={"result": Image()}, group=64, compute=Snippet("test", text))
    )
    shader.bind()
    shader.image("result", result)
    for name, value in samplers.items():
        if isinstance(value, tuple):
            shader.uniform_int(name, value)
        elif isinstance(value, RayScene):
            value.bind(shader)
        else:
            shader.uniform_sampler(name, value)
    dispatch(shader, count, 64)
    return read_records(result, count)


def test_corners_have_the_attributes_of_their_meshes(gpu: None) -> None:
    meshes = (mesh(1.0, HEAT, TINT), mesh(2.0, MAP), mesh(3.0))
    scene = scene_of(*meshes)
    order = attributes_of(scene)
    assert order == (HEAT, TINT, MAP)
    geometry = SceneGeometry()
    geometry.update(scene, {})
    (chunk,) = geometry.chunks
    texture = chunk.attributes.texture(order)
    assert chunk.attributes.texture(order) is texture
    found = computed(
        27,
        "corner_attribute(index / 3, index % 3)",
        CORNER_ATTRIBUTES,
        Piece(compute="common/corner_attributes.glsl"),
        corner_attribute_records=texture,
    ).reshape(3, 3, 3, 4)
    by_name, nothing = np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(4)
    for index, one in enumerate(meshes):
        for number, attribute in enumerate(order):
            lacking = by_name if attribute.name else nothing
            expected = np.tile(lacking, (3, 1))
            if attribute in one.attributes:
                assert one.corner_attributes is not None
                expected = one.corner_attributes[:, one.attributes.index(attribute)]
            assert np.array_equal(found[index, :, number], expected), (index, attribute)


def test_corners_know_the_rows_of_their_instances(gpu: None) -> None:
    geometry = SceneGeometry()
    scene = scene_of(mesh(1.0), mesh(2.0), mesh(3.0))
    geometry.update(scene, {1: 1})
    for chunk in geometry.chunks:
        rows = geometry.rows_of(chunk)
        count = 3 * len(rows)
        found = computed(
            count,
            "vec4(float(instance_of_corner(index)))",
            CORNER_INSTANCES,
            Piece(compute="common/corner_instances.glsl"),
            corner_instance_records=chunk.attributes.instance_texture(rows),
        )
        assert found[:, 0].tolist() == np.repeat(rows, 3).tolist()
    # One less: rows move up.
    geometry.update(replace(scene, instances=scene.instances[1:]), {0: 1})
    rows = sorted(row for chunk in geometry.chunks for row in geometry.rows_of(chunk).tolist())
    assert rows == [0, 1]


def test_rays_find_the_attributes_of_what_they_hit(gpu: None) -> None:
    meshes = (mesh(1.0, HEAT, TINT), mesh(2.0, MAP), mesh(3.0))
    scene = scene_of(*meshes)
    order = attributes_of(scene)
    rays = RayScene(MeshFactsCache(), VertexUploads())
    rays.follow(scene, {})
    instance = f"rays_top.y + {INSTANCE_RECORDS} * (index / 3)"
    triangle = f"REGION_UNIT * int(fetch_record(rays, {instance} + 4).y)"
    found = computed(
        9,
        f"hit_attribute({instance}, {triangle}, vec3(0.5, 0.25, 0.25), index % 3)",
        RAYS,
        Piece(compute="rays/hit_attributes.glsl"),
        rays=rays,
    ).reshape(3, 3, 4)
    assert TRIANGLE_RECORDS == 4
    for index, one in enumerate(meshes):
        for number, attribute in enumerate(order):
            expected = np.array([0.0, 0.0, 0.0, 1.0 if attribute.name else 0.0])
            if attribute in one.attributes:
                assert one.corner_attributes is not None
                expected = np.array([0.5, 0.25, 0.25]) @ one.corner_attributes[:, one.attributes.index(attribute)]
            assert np.allclose(found[index, number], expected), (index, attribute)
    rows = computed(
        3,
        f"vec4(float(row_of_instance(rays_top.y + {INSTANCE_RECORDS} * index)))",
        RAYS,
        Piece(compute="rays/hit_attributes.glsl"),
        rays=rays,
    )
    assert rows[:, 0].tolist() == [0.0, 1.0, 2.0]


def test_split_meshes_have_attributes_between() -> None:
    whole = mesh(1.0, HEAT, TINT)
    parts, _ = split_mesh(whole, whole.positions - np.float32(1.2), 0.5)
    assert whole.corner_attributes is not None and parts.corner_attributes is not None
    assert len(parts.corner_attributes) == len(parts.corner_vertex) > 3
    # Linear in the place on the triangle.
    places = parts.positions[parts.corner_vertex] - np.float32(1.0)
    weights = np.column_stack([1.0 - places[:, 0] - places[:, 1], places[:, :2]])
    expected = np.einsum("nk,kij->nij", weights, whole.corner_attributes)
    assert np.allclose(parts.corner_attributes, expected, atol=1e-3)


def test_a_row_of_the_table_follows_its_instance(gpu: None) -> None:
    scene = scene_of(mesh(1.0), mesh(2.0), mesh(3.0))
    values = (("OBJECT:age", (7.0, 7.0, 7.0, 1.0)),)
    scene = replace(scene, instances=(*scene.instances[:2], replace(scene.instances[2], values=values)))
    table = InstanceTable()
    table.follow(scene)
    records = PLAIN_VALUES + 1

    def rows() -> np.ndarray:
        return read_records(table._regions.texture, 3 * records).reshape(3, records, 4)

    assert np.array_equal(rows()[:, :3], np.tile(np.eye(4)[:3], (3, 1, 1)))
    assert rows()[:, 7, 0].tolist() == [0.0, 0.125, 0.25]
    assert rows()[:, 12].tolist() == [[0.0] * 4, [0.0] * 4, [7.0, 7.0, 7.0, 1.0]]
    # One moves, whose mesh lies about its middle: object space stays that of the object.
    matrix = np.eye(4)
    matrix[:3, :3] *= 2.0
    matrix[:3, 3] = (10.0, 0.0, 0.0)
    moved = replace(scene.instances[1], matrix=matrix, shift=(1.0, 2.0, 3.0))
    written = table.counters["instance rows written"]
    table.follow(replace(scene, instances=(scene.instances[0], moved, scene.instances[2])))
    assert table.counters["instance rows written"] == written + 1
    to_world, to_object = rows()[1, :3], rows()[1, 3:6]
    of_mesh = np.array([0.5, 0.5, 0.5, 1.0])
    of_object = np.array([1.5, 2.5, 3.5, 1.0])
    place = np.append(matrix[:3] @ of_mesh, 1.0)
    assert np.allclose(to_world @ of_object, place[:3])
    assert np.allclose(to_object @ place, of_object[:3])
    assert rows()[2, 12, 0] == 7.0
