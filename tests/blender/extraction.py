# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes made by hand, and what the extraction reads of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.scene.arrays import Float32Array, InstanceArrays, MaterialArrays, MeshArrays, SceneArrays
from curvrefl.curvrefl_addon.scene.extract import extract_scene
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import with_render_depsgraph

CUBE_CORNERS = [(x, y, z) for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)]
CUBE_FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def empty_scene() -> bpy.types.Scene:
    """A new file with a black world."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    return scene


def add(
    name: str,
    vertices: Sequence[Sequence[float]] = CUBE_CORNERS,
    faces: Sequence[Sequence[int]] = CUBE_FACES,
    smooth: bool = False,
    collection: bpy.types.Collection | None = None,
) -> bpy.types.Object:
    """A mesh object; a cube without more words."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    if smooth:
        mesh.shade_smooth()
    return link(bpy.data.objects.new(name, mesh), collection)


def add_square(name: str = "square", size: float = 2.0) -> bpy.types.Object:
    """In the plane z = 0, with a UV map from 0 to 1."""
    half = 0.5 * size
    obj = add(name, [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [(0, 1, 2, 3)])
    obj.data.uv_layers.new(name="UVMap").uv.foreach_set("vector", [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0])
    return obj


def add_mesh(name: str, size: float = 1.0) -> bpy.types.Object:
    """A tetrahedron with a material of its name."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(
        [(0, 0, 0), (size, 0, 0), (0, size, 0), (0, 0, size)], [], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    )
    mesh.materials.append(bpy.data.materials.new(name))
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def link(obj: bpy.types.Object, collection: bpy.types.Collection | None = None) -> bpy.types.Object:
    """Into the scene, or into a collection."""
    (collection or bpy.context.scene.collection).objects.link(obj)
    return obj


def extracted(*reflectors: bpy.types.Object, for_render: bool = True) -> SceneArrays:
    """The open scene, as it renders or as the viewport has it."""
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    view_layer.update()
    if not for_render:
        return extract_scene(bpy.context.evaluated_depsgraph_get(), scene, reflectors)
    return with_render_depsgraph(scene, view_layer, lambda depsgraph: extract_scene(depsgraph, scene, reflectors))


def instances_of(scene: SceneArrays, name: str) -> list[InstanceArrays]:
    """All that show the object called `name`."""
    return [instance for instance in scene.instances if instance.object_name == name]


def mesh_of(scene: SceneArrays, name: str) -> MeshArrays:
    """Of the one instance of the object called `name`."""
    (instance,) = instances_of(scene, name)
    return scene.meshes[instance.mesh]


def material_of(scene: SceneArrays, name: str) -> MaterialArrays:
    """Of the first slot of the one instance of the object called `name`."""
    (instance,) = instances_of(scene, name)
    return scene.materials[instance.materials[0]]


def face_normals(mesh: MeshArrays) -> np.ndarray:
    """(triangles, 3) unit, by the triangles' winding."""
    a, b, c = (mesh.positions[mesh.corner_vertex[mesh.triangles[:, k]]] for k in range(3))
    normals = np.cross(b - a, c - a)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def new_material(obj: bpy.types.Object, *node_types: str) -> tuple[bpy.types.NodeTree, list[Any]]:
    """A material with these nodes; the first is plugged into the output."""
    material = bpy.data.materials.new(obj.name)
    tree = material.node_tree
    tree.nodes.clear()
    nodes = [tree.nodes.new(node_type) for node_type in node_types]
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(nodes[0].outputs[0], output.inputs["Surface"])
    obj.data.materials.append(material)
    return tree, nodes


def look_down(width: float) -> bpy.types.Object:
    """An orthographic camera above the origin that sees `width` meters."""
    camera = bpy.data.cameras.new("camera")
    camera.type = "ORTHO"
    camera.ortho_scale = width
    obj = link(bpy.data.objects.new("camera", camera))
    obj.location = (0.0, 0.0, 3.0)
    bpy.context.scene.camera = obj
    return obj


def cycles_picture(width: int, height: int, samples: int) -> Float32Array:
    """(height, width, 3) of the open scene, row 0 at the bottom."""
    still = render_reference(bpy.context.scene, bpy.context.view_layer, width, height, samples, "direct")
    return np.asarray(still.pixels)[..., :3]
