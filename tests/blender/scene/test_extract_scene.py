# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What of a scene is there, where, and for which rays."""

from __future__ import annotations

import math

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from extraction import add, empty_scene, extracted, face_normals, instances_of, link, mesh_of
from mathutils import Matrix


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def collection(name: str, parent: bpy.types.Collection | None = None) -> bpy.types.Collection:
    made = bpy.data.collections.new(name)
    (parent or bpy.context.scene.collection).children.link(made)
    return made


def instancer(name: str, shown: bpy.types.Collection) -> bpy.types.Object:
    empty = link(bpy.data.objects.new(name, None))
    empty.instance_type = "COLLECTION"
    empty.instance_collection = shown
    return empty


def names() -> set[str]:
    return {instance.object_name for instance in extracted().instances}


def test_ids_and_shared_meshes() -> None:
    first, second = add("first"), add("second")
    link(bpy.data.objects.new("third", first.data))
    scene = extracted(second)
    assert [instance.object_name for instance in scene.instances] == ["first", "second", "third"]
    assert [instance.object_id for instance in scene.instances] == [1, 2, 3]
    assert len(scene.meshes) == 2
    assert scene.instances[0].mesh == scene.instances[2].mesh != scene.instances[1].mesh
    assert scene.reflectors == (2,)
    assert all(instance.materials == (0,) for instance in scene.instances)


def test_instances_of_a_collection() -> None:
    library = bpy.data.collections.new("library")
    part = add("part", collection=library)
    part.location = (0.0, 0.0, 1.0)
    for index in range(3):
        instancer(f"place {index}", library).location = (5.0 * index, 0.0, 0.0)
    scene = extracted()
    shown = instances_of(scene, "part")
    assert len(shown) == 3 and len(scene.meshes) == 1
    assert len({instance.object_id for instance in shown}) == 1
    places = sorted(instance.matrix[:3, 3].tolist() for instance in shown)
    np.testing.assert_allclose(places, [(0, 0, 1), (5, 0, 1), (10, 0, 1)])


def test_world_transforms_of_parents() -> None:
    parent = link(bpy.data.objects.new("parent", None))
    parent.rotation_euler = (0.0, 0.0, math.pi / 2.0)
    parent.scale = (2.0, 2.0, 2.0)
    child = add("child")
    child.parent = parent
    child.location = (1.0, 0.0, 0.0)
    (instance,) = extracted().instances
    expected = np.array([(0, -2, 0, 0), (2, 0, 0, 2), (0, 0, 2, 0), (0, 0, 0, 1)], float)
    np.testing.assert_allclose(instance.matrix, expected, atol=1e-6)


@pytest.mark.parametrize("smooth", [False, True])
def test_negative_scale_keeps_outside_outside(smooth: bool) -> None:
    plain = add("plain", smooth=smooth)
    inverted = link(bpy.data.objects.new("inverted", plain.data))
    inverted.scale = (-1.0, 2.0, 1.0)
    scene = extracted(plain)
    for name in ("plain", "inverted"):
        (instance,) = instances_of(scene, name)
        mesh = scene.meshes[instance.mesh]
        linear = instance.matrix[:3, :3]
        a, b, c = (mesh.positions[mesh.corner_vertex[mesh.triangles[:, k]]] @ linear.T for k in range(3))
        by_winding = np.cross(b - a, c - a)
        outward = np.sum(by_winding * (a + b + c), axis=1)
        assert (outward > 0.0).all(), name
        shading = mesh.corner_normals[mesh.triangles[:, 0]] @ np.linalg.inv(linear)
        assert (np.sum(shading * by_winding, axis=1) > 0.0).all(), name
    plain_mesh, inverted_mesh = mesh_of(scene, "plain"), mesh_of(scene, "inverted")
    assert inverted_mesh.positions is plain_mesh.positions
    assert inverted_mesh.signature != plain_mesh.signature
    np.testing.assert_allclose(face_normals(inverted_mesh), -face_normals(plain_mesh), atol=1e-6)


def test_what_renders_hide() -> None:
    scene = bpy.context.scene
    add("seen")
    add("hidden").hide_render = True
    unseen = collection("unseen")
    unseen.hide_render = True
    add("in hidden collection", collection=unseen)
    add("in hidden parent collection", collection=collection("inner", unseen))
    both = add("in both", collection=unseen)
    scene.collection.objects.link(both)
    assert names() == {"seen", "in both"}
    shown = {instance.object_name for instance in extracted(for_render=False).instances}
    assert shown == {"seen", "hidden", "in hidden collection", "in hidden parent collection", "in both"}


def test_what_the_viewport_hides() -> None:
    add("seen")
    add("hidden").hide_viewport = True
    add("closed eye").hide_set(True)
    add("in hidden collection", collection=collection("hidden")).data.update()
    bpy.data.collections["hidden"].hide_viewport = True
    add("excluded", collection=collection("excluded"))
    bpy.context.view_layer.layer_collection.children["excluded"].exclude = True
    shown = {instance.object_name for instance in extracted(for_render=False).instances}
    assert shown == {"seen"}
    assert names() == {"seen", "hidden", "closed eye", "in hidden collection"}


def test_hidden_within_an_instanced_collection() -> None:
    library = bpy.data.collections.new("library")
    add("seen", collection=library)
    add("hidden", collection=library).hide_render = True
    inner = bpy.data.collections.new("inner")
    library.children.link(inner)
    inner.hide_render = True
    add("in hidden collection", collection=inner)
    place = instancer("place", library)
    assert names() == {"seen"}
    place.hide_render = True
    assert names() == set()


def test_rays_that_objects_hide_from() -> None:
    switches = {"visible_camera": "camera", "visible_glossy": "mirror", "visible_shadow": "shadow"}
    for switch, name in switches.items():
        setattr(add(name), switch, False)
    scene = extracted()
    for switch, name in switches.items():
        (instance,) = instances_of(scene, name)
        for other in switches:
            assert getattr(instance, other) is (other != switch)
        assert not instance.holdout


def test_an_instance_is_hidden_with_what_places_it() -> None:
    library = bpy.data.collections.new("library")
    add("part", collection=library)
    instancer("place", library).visible_glossy = False
    (instance,) = extracted().instances
    assert not instance.visible_glossy and instance.visible_camera


def test_holdouts_and_collections_seen_only_indirectly() -> None:
    add("object").is_holdout = True
    add("in collection", collection=collection("cut"))
    bpy.context.view_layer.layer_collection.children["cut"].holdout = True
    add("indirect", collection=collection("indirect"))
    bpy.context.view_layer.layer_collection.children["indirect"].indirect_only = True
    add("plain")
    scene = extracted()
    held = {instance.object_name for instance in scene.instances if instance.holdout}
    assert held == {"object", "in collection"}
    unseen = {instance.object_name for instance in scene.instances if not instance.visible_camera}
    assert unseen == {"indirect"}


def test_materials_linked_to_the_object_and_empty_slots() -> None:
    cube = add("cube")
    red, blue = bpy.data.materials.new("red"), bpy.data.materials.new("blue")
    cube.data.materials.append(red)
    cube.data.materials.append(None)
    other = link(bpy.data.objects.new("other", cube.data))
    other.material_slots[0].link = "OBJECT"
    other.material_slots[0].material = blue
    scene = extracted()
    names_of = {
        instance.object_name: [scene.materials[index].name for index in instance.materials]
        for instance in scene.instances
    }
    assert names_of == {"cube": ["red", "default"], "other": ["blue", "default"]}
    bpy.context.view_layer.material_override = red
    scene = extracted()
    assert {scene.materials[index].name for instance in scene.instances for index in instance.materials} == {"red"}


def test_a_flattened_object() -> None:
    flat, mirror = add("flat"), add("mirror")
    flat.matrix_world = Matrix.Diagonal((1.0, 1.0, 0.0, 1.0))
    scene = extracted(mirror)
    assert [instance.object_name for instance in scene.instances] == ["mirror"]
    assert scene.warnings == ('"flat" is flattened by a zero or endless scale and is left out.',)
    with pytest.raises(InputError, match='"flat" is flattened'):
        extracted(flat)


@pytest.mark.parametrize("hide", ["hide_render", "hide_viewport"])
def test_a_hidden_reflector(hide: str) -> None:
    cube = add("cube")
    setattr(cube, hide, True)
    in_render = hide == "hide_viewport"
    assert extracted(cube, for_render=in_render).reflectors
    with pytest.raises(InputError, match='"cube" is hidden'):
        extracted(cube, for_render=not in_render)


def test_a_reflector_that_modifiers_leave_nothing_of() -> None:
    cube = add("cube")
    cube.vertex_groups.new(name="none")
    mask = cube.modifiers.new("mask", "MASK")
    mask.vertex_group = "none"
    with pytest.raises(InputError, match='"cube" has no faces'):
        extracted(cube)


def test_instances_made_by_geometry_nodes() -> None:
    tree = bpy.data.node_groups.new("scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    scatter = tree.nodes.new("GeometryNodeInstanceOnPoints")
    ball = tree.nodes.new("GeometryNodeMeshIcoSphere")
    tree.links.new(start.outputs[0], scatter.inputs["Points"])
    tree.links.new(ball.outputs["Mesh"], scatter.inputs["Instance"])
    tree.links.new(scatter.outputs["Instances"], end.inputs[0])
    add("points").modifiers.new("scatter", "NODES").node_group = tree
    scene = extracted()
    assert len(instances_of(scene, "points")) == 8
    assert len(scene.meshes) == 1
    places = {tuple(np.sign(instance.matrix[:3, 3])) for instance in scene.instances}
    assert len(places) == 8
