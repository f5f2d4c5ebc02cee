# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What changes its shape is read by itself, and all are gone through only where others may have changed with it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import bpy
import pytest
from curvrefl.curvrefl_addon.scene.changes import Changes
from curvrefl.curvrefl_addon.scene.extract import SceneReader
from extraction import add_mesh, empty_scene
from reader_session import Session, assert_equal


@pytest.fixture
def session() -> Iterator[Session]:
    empty_scene()
    for name in ("Mirror", "First"):
        add_mesh(name)
    things_that_change_their_shapes()
    made = Session()
    made.read()
    yield made
    made.end()


def pose() -> None:
    bone = bpy.data.objects["Skeleton"].pose.bones[0]
    bone.rotation_mode = "XYZ"
    bone.rotation_euler.x = 0.7


def turn_shape_key() -> None:
    bpy.data.objects["Keyed"].data.shape_keys.key_blocks["Moved"].value = 0.6


def edited(name: str) -> Callable[[], None]:
    def act() -> None:
        bpy.data.meshes[name].vertices[1].co.x = 7.0
        bpy.data.meshes[name].update()

    return act


def fill() -> None:
    mesh = bpy.data.meshes["Nothing"]
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    mesh.update()


def turn_and_move() -> None:
    turn_shape_key()
    bpy.data.objects["First"].location.x = 2.0
    bpy.data.objects["Keyed"].location.x = 3.0


def things_that_change_their_shapes() -> None:
    """A mesh under an armature, one with a shape key, one that a collection instances, one with geometry nodes, one
    without faces."""
    link = bpy.context.scene.collection.objects.link
    bpy.ops.object.armature_add()
    skeleton = bpy.context.object
    skeleton.name = "Skeleton"
    skinned = add_mesh("Skinned")
    skinned.vertex_groups.new(name=skeleton.data.bones[0].name).add([0, 1, 2, 3], 1.0, "REPLACE")
    skinned.modifiers.new("Armature", "ARMATURE").object = skeleton
    keyed = add_mesh("Keyed")
    keyed.shape_key_add(name="Basis")
    keyed.shape_key_add(name="Moved").data[2].co.z = 3.0
    inner = add_mesh("Inner")
    bpy.context.scene.collection.objects.unlink(inner)
    collection = bpy.data.collections.new("Inner")
    collection.objects.link(inner)
    empty = bpy.data.objects.new("Instancer", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    link(empty)
    nodes = add_mesh("With nodes").modifiers.new("Nodes", "NODES")
    nodes.node_group = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    for kind in ("INPUT", "OUTPUT"):
        nodes.node_group.interface.new_socket("Geometry", in_out=kind, socket_type="NodeSocketGeometry")
    group = nodes.node_group.nodes
    nodes.node_group.links.new(
        group.new("NodeGroupInput").outputs["Geometry"], group.new("NodeGroupOutput").inputs["Geometry"]
    )
    link(bpy.data.objects.new("Nothing", bpy.data.meshes.new("Nothing")))


@pytest.mark.parametrize(
    ("act", "walks", "objects"),
    [
        (pose, 0, 1),
        (turn_shape_key, 0, 1),
        (turn_and_move, 0, 2),
        (edited("Skinned"), 0, 1),
        (edited("Inner"), 1, None),
        (edited("With nodes"), 1, None),
        (fill, 1, None),
    ],
)
def test_what_changes_its_shape_is_read_alone(
    session: Session, act: Callable[[], None], walks: int, objects: int | None
) -> None:
    before = session.read()
    counts = session.reader.reads
    act()
    found = session.read()
    spent = {name: count - counts[name] for name, count in session.reader.reads.items()}
    assert spent["walks"] == walks and spent["meshes read"] == 1
    assert objects is None or spent["objects read"] == objects
    assert [mesh.positions.tolist() for mesh in found.meshes] != [mesh.positions.tolist() for mesh in before.meshes]
    depsgraph = bpy.context.evaluated_depsgraph_get()
    everything = Changes(everything=True)
    fresh = SceneReader().read(depsgraph, bpy.context.scene, [bpy.data.objects["Mirror"]], everything)
    assert_equal(found, fresh)
    assert not session.reader._meshes._replaced
