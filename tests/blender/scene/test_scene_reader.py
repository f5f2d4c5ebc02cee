# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene that changes is read again in the parts that changed, and comes out as if it had been read anew."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.arrays import MaterialArrays
from curvrefl.curvrefl_addon.scene.changes import Changes
from curvrefl.curvrefl_addon.scene.extract import SceneReader
from extraction import add_mesh
from reader_session import Session, assert_equal


@pytest.fixture
def session() -> Any:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_mesh("Mirror")
    first = add_mesh("First")
    add_mesh("Second", 2.0)
    twin = bpy.data.objects.new("Twin", first.data)
    bpy.context.scene.collection.objects.link(twin)
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    lamp.location.z = 5.0
    bpy.context.scene.collection.objects.link(lamp)
    bpy.context.scene.world = bpy.data.worlds.new("World")
    bpy.context.scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.scene.collection.objects.link(bpy.context.scene.camera)
    made = Session()
    made.read()
    yield made
    made.end()


def move() -> None:
    bpy.data.objects["First"].location.x = 3.0


def edit_mesh() -> None:
    mesh = bpy.data.meshes["First"]
    mesh.vertices[1].co.x = 7.0
    mesh.update()


def touch_mesh() -> None:
    bpy.data.meshes["First"].update()


def paint() -> None:
    material = bpy.data.materials["Second"]
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (1.0, 0.0, 0.0, 1.0)


def dim() -> None:
    bpy.data.lights["Lamp"].energy = 3.0


def move_lamp() -> None:
    bpy.data.objects["Lamp"].location.x = 3.0


def change_world() -> None:
    bpy.data.worlds["World"].node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 1.0, 0.0, 1.0)


def hide() -> None:
    bpy.data.objects["Second"].hide_set(True)


def select() -> None:
    bpy.data.objects["Second"].select_set(True)


def unseen_by_camera() -> None:
    bpy.data.objects["Second"].visible_camera = False


def unseen_at_all() -> None:
    for name in ("visible_camera", "visible_glossy", "visible_shadow"):
        setattr(bpy.data.objects["Second"], name, False)


def duplicate() -> None:
    bpy.context.scene.collection.objects.link(bpy.data.objects["Second"].copy())


def delete() -> None:
    bpy.data.objects.remove(bpy.data.objects["Second"])


def rename() -> None:
    bpy.data.objects["Second"].name = "Third"


def subdivide() -> None:
    bpy.data.objects["Second"].modifiers.new("Subdivision", "SUBSURF")


def subdivide_one_of_two() -> None:
    bpy.data.objects["First"].modifiers.new("Subdivision", "SUBSURF")


def parent() -> None:
    bpy.data.objects["First"].parent = bpy.data.objects["Second"]
    bpy.data.objects["Second"].location.y = 4.0


def negative_scale() -> None:
    bpy.data.objects["First"].scale.x = -1.0


def other_material() -> None:
    bpy.data.objects["Second"].material_slots[0].link = "OBJECT"
    bpy.data.objects["Second"].material_slots[0].material = bpy.data.materials["First"]


def move_camera() -> None:
    bpy.context.scene.camera.location.x = 2.0


def nothing() -> None:
    pass


@pytest.mark.parametrize(
    ("act", "counts"),
    [
        (nothing, {}),
        (move_camera, {}),
        (select, {}),
        (move, {"objects read": 1}),
        (move_lamp, {"objects read": 1}),
        (unseen_by_camera, {"objects read": 1}),
        (change_world, {"worlds read": 1}),
        (dim, {"walks": 1, "objects read": 5}),
        (paint, {"walks": 1, "objects read": 5, "materials read": 1}),
        (edit_mesh, {"walks": 0, "objects read": 2, "meshes read": 1}),
        (touch_mesh, {"walks": 0, "objects read": 2, "meshes read": 1}),
        (hide, {"walks": 1, "objects read": 4}),
        (duplicate, {"walks": 1}),
        (delete, {"walks": 1}),
        (rename, {}),
        (subdivide, {"walks": 0, "meshes read": 1}),
        (subdivide_one_of_two, {"walks": 0, "meshes read": 2}),
        (parent, {}),
        (negative_scale, {"objects read": 1}),
        (other_material, {}),
        (unseen_at_all, {"objects read": 1}),
    ],
    ids=lambda value: value.__name__ if callable(value) else "",
)
def test_only_what_changed_is_read(session: Session, act: Callable[[], None], counts: dict[str, int]) -> None:
    before = session.reader.reads
    act()
    found = session.read()
    spent = {name: count - before[name] for name, count in session.reader.reads.items()}
    assert {name: spent[name] for name in counts} == counts
    if act in (nothing, move_camera, select, move, change_world, dim, paint, hide, unseen_by_camera):
        assert spent["meshes read"] == 0
    fresh = SceneReader().read(
        bpy.context.evaluated_depsgraph_get(),
        bpy.context.scene,
        [bpy.data.objects["Mirror"]],
        Changes(everything=True),
    )
    assert_equal(found, fresh)


def radiance(session: Session) -> tuple[float, float, float]:
    return session.read().world.color


def colored_world(name: str, color: tuple[float, float, float]) -> bpy.types.World:
    world = bpy.data.worlds.new(name)
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*color, 1.0)
    return world


def test_a_world_that_is_taken_away_leaves_no_light(session: Session) -> None:
    scene = bpy.context.scene
    scene.world = colored_world("Red", (1.0, 0.0, 0.0))
    assert radiance(session) == (1.0, 0.0, 0.0)
    scene.world = None
    before = session.reader.reads
    assert radiance(session) == (0.0, 0.0, 0.0)
    assert session.reader.reads["walks"] == before["walks"], "no object is looked at for that"
    scene.world = bpy.data.worlds["Red"]
    assert radiance(session) == (1.0, 0.0, 0.0)
    bpy.data.worlds.remove(bpy.data.worlds["Red"])
    assert radiance(session) == (0.0, 0.0, 0.0)


def test_a_view_layers_own_world_comes_and_goes(session: Session) -> None:
    scene, layer = bpy.context.scene, bpy.context.view_layer
    scene.world, blue = colored_world("Red", (1.0, 0.0, 0.0)), colored_world("Blue", (0.0, 0.0, 1.0))
    assert radiance(session) == (1.0, 0.0, 0.0)
    layer.world_override = blue
    assert radiance(session) == (0.0, 0.0, 1.0)
    scene.world = None
    before = session.reader.reads
    assert radiance(session) == (0.0, 0.0, 1.0)
    assert session.reader.reads["worlds read"] == before["worlds read"], "the scene's own world is not shown"
    layer.world_override = None
    assert radiance(session) == (0.0, 0.0, 0.0)
    layer.world_override = blue
    scene.world = bpy.data.worlds["Red"]
    assert radiance(session) == (0.0, 0.0, 1.0)
    layer.world_override = None
    assert radiance(session) == (1.0, 0.0, 0.0)


def test_what_stays_is_the_same_object(session: Session) -> None:
    before = session.read()
    assert session.read() is before
    move()
    after = session.read()
    changed = [name.object_name for name, old in zip(after.instances, before.instances, strict=True) if name is not old]
    assert changed == ["First"]
    assert after.meshes is before.meshes and after.materials is before.materials and after.lights is before.lights


def test_a_material_follows_the_object_whose_place_it_knows(session: Session) -> None:
    guide = bpy.data.objects.new("Guide", None)
    bpy.context.scene.collection.objects.link(guide)
    material = bpy.data.materials.new("Guided")
    tree: Any = material.node_tree
    place, surface = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes["Principled BSDF"]
    place.object = guide
    tree.links.new(place.outputs["Object"], surface.inputs["Base Color"])
    bpy.data.objects["First"].data.materials.append(material)

    def shift() -> float:
        found = next(item.program for item in session.read().materials if item.name == "Guided")
        assert found is not None
        return float(found.records[:, 3].min())

    assert shift() == 0.0
    guide.location.x = 2.0
    assert shift() == -2.0


def test_an_edit_that_changes_nothing_keeps_the_arrays(session: Session) -> None:
    before = session.read()
    touch_mesh()
    assert session.read() is before


def test_undoing_an_edit_brings_the_arrays_back(session: Session) -> None:
    mesh = bpy.data.meshes["First"]
    place = mesh.vertices[1].co.copy()
    before = session.read()
    edit_mesh()
    edited = session.read()
    assert edited.meshes is not before.meshes
    mesh.vertices[1].co = place
    mesh.update()
    np.testing.assert_array_equal(session.read().meshes[1].positions, before.meshes[1].positions)


def test_instances_of_a_collection_follow(session: Session) -> None:
    kept = bpy.data.collections.new("Kept")
    kept.objects.link(bpy.data.objects["First"])
    holder = bpy.data.objects.new("Holder", None)
    holder.instance_type, holder.instance_collection = "COLLECTION", kept
    bpy.context.scene.collection.objects.link(holder)
    count = len(session.read().instances)
    holder.location.z = 9.0
    moved = session.read()
    assert len(moved.instances) == count
    assert max(instance.matrix[2, 3] for instance in moved.instances) == 9.0


def test_playback_reads_what_moves(session: Session) -> None:
    obj = bpy.data.objects["First"]
    obj.keyframe_insert("location", frame=1)
    obj.location.x = 9.0
    obj.keyframe_insert("location", frame=10)
    session.read()
    before = session.reader.reads
    bpy.context.scene.frame_set(10)
    found = session.read()
    assert found.instances[1].matrix[0, 3] == pytest.approx(9.0)
    assert session.reader.reads["meshes read"] == before["meshes read"]
    assert session.reader.reads["objects read"] <= before["objects read"] + 1


def test_override_takes_the_place_of_the_material(session: Session) -> None:
    tint = MaterialArrays("override", (1.0, 0.5, 0.25), metallic=1.0)
    uid = bpy.data.objects["Mirror"].session_uid
    depsgraph, scene = bpy.context.evaluated_depsgraph_get(), bpy.context.scene
    found = session.reader.read(depsgraph, scene, [bpy.data.objects["Mirror"]], Changes(), {uid: tint})
    assert found.materials[found.instances[0].materials[0]] is tint
    again = session.reader.read(depsgraph, scene, [bpy.data.objects["Mirror"]], Changes())
    assert again.materials[again.instances[0].materials[0]].name == "Mirror"
