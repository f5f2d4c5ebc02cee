# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs read of instances, against what Cycles shows of the same nodes on them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.instances.values import values_of_instance
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import with_render_depsgraph
from curvrefl.curvrefl_addon.scene.programs.program import Program, Shape
from extraction import add, add_square, cycles_picture, empty_scene, link, look_down, new_material

COLUMNS = 8
VIEW = 2.0
NAMES = ("age", "tint", "heat", "color", "location", "pass_index", "nothing", "flag")


def square(name: str) -> Any:
    obj: Any = add_square(name, 0.5)
    return obj


def painted() -> Any:
    """The material of all, which shines: what is plugged into its emission is what is asked."""
    obj = square("painted")
    new_material(obj, "ShaderNodeEmission")
    bpy.data.objects.remove(obj)
    return bpy.data.materials["painted"]


def scattered(target: Any, count: int, material: Any) -> Any:
    """Geometry nodes that put `target` on a line of points from (0, 1), with attributes of their instances."""
    tree = bpy.data.node_groups.new("Scattered", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")

    def new(kind: str, **values: Any) -> Any:
        node: Any = tree.nodes.new(kind)
        for name, value in values.items():
            node.inputs[name].default_value = value
        return node

    line = new("GeometryNodeMeshLine", Count=count)
    line.inputs["Offset"].default_value = (1.0, 0.0, 0.0)
    put, of_object, out = new("GeometryNodeInstanceOnPoints"), new("GeometryNodeObjectInfo"), new("NodeGroupOutput")
    of_object.inputs["Object"].default_value = target
    of_object.inputs["As Instance"].default_value = True
    index = new("GeometryNodeInputIndex")
    tree.links.new(line.outputs[0], put.inputs["Points"])
    tree.links.new(of_object.outputs["Geometry"], put.inputs["Instance"])
    last = put
    for name, kind in (("tint", "FLOAT_VECTOR"), ("heat", "FLOAT")):
        store = new("GeometryNodeStoreNamedAttribute", Name=name)
        store.domain, store.data_type = "INSTANCE", kind
        tree.links.new(last.outputs[0], store.inputs["Geometry"])
        tree.links.new(index.outputs[0], store.inputs["Value"])
        last = store
    tree.links.new(last.outputs[0], out.inputs[0])
    holder = add("holder")
    holder.data.materials.append(material)
    holder.modifiers.new("Scattered", "NODES").node_group = tree
    holder["age"], holder["heat"] = 0.25, 0.75
    return holder


@pytest.fixture
def material() -> Any:
    """Of a scene with a plain object, objects in a collection that is instanced, and others by geometry nodes and on
    faces: one each in a cell of a grid."""
    scene = empty_scene()
    look_down(COLUMNS)
    material = painted()
    for column in range(2):
        plain = square(f"plain {column}")
        plain.location = (column, 0.0, 0.0)
        plain.data.materials.append(material)
        plain.color = (0.1, 0.2, 0.3 + 0.1 * column, 0.4)
        plain.pass_index = 1 + column
        plain["age"], plain["flag"] = 0.5 + 0.125 * column, True
        plain.data["heat"] = [0.2, 0.4, 0.6]
    target = square("target")
    target.data.materials.append(material)
    target["tint"], target["age"] = [0.2, 0.3, 0.4, 0.5], 3
    target.hide_render = True
    scattered(target, 3, material).location = (0.0, 1.0, 0.0)
    collection = bpy.data.collections.new("kept")
    scattered(target, 2, material).location = (0.0, 2.0, 0.0)
    inner = bpy.data.objects["holder.001"]
    bpy.context.scene.collection.objects.unlink(inner)
    collection.objects.link(inner)
    other = square("other")
    bpy.context.scene.collection.objects.unlink(other)
    collection.objects.link(other)
    other.data.materials.append(material)
    other.location = (3.0, 2.0, 0.0)
    empty = link(bpy.data.objects.new("empty", None))
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    empty["age"] = 0.375
    parent: Any = add(
        "faces", [(x - 0.5, 2.75 + y, 0) for x in range(3) for y in (0, 0.5)], [(0, 2, 3, 1), (2, 4, 5, 3)]
    )
    parent.data.uv_layers.new(name="UVMap").uv.foreach_set("vector", np.linspace(0.0, 0.9, 16).tolist())
    parent.instance_type, parent.show_instancer_for_render = "FACES", False
    child = square("child")
    child.parent = parent
    child.data.materials.append(material)
    scene["age"] = 0.0625
    scene.world["heat"] = 0.9375
    return material


def fields_by_cell() -> dict[tuple[int, int], dict[str, Any]]:
    """What is read of the instance in each cell."""
    names = tuple(f"{kind}:{name}" for kind in ("OBJECT", "INSTANCER", "VIEW_LAYER") for name in NAMES)
    program = Program(Shape(""), np.zeros((0, 4), np.float32), instance_attributes=names)
    view_layer = bpy.context.view_layer

    def read(depsgraph: Any) -> dict[tuple[int, int], dict[str, Any]]:
        found = {}
        for item in depsgraph.object_instances:
            if item.object.type == "MESH" and len(item.object.data.vertices) == 4 and item.show_self:
                x, y, _ = item.matrix_world.translation
                cell = int(np.floor(x + 0.5)), int(np.floor(y + 0.5))
                found[cell] = values_of_instance(item, (program,), view_layer)
        return found

    return with_render_depsgraph(bpy.context.scene, view_layer, read)


def asked(material: Any, kind: str, output: str, **settings: Any) -> np.ndarray:
    """(rows, columns, 3) of what Cycles shows at the cells' middles."""
    tree = material.node_tree
    node: Any = tree.nodes.new(kind)
    for name, value in settings.items():
        setattr(node, name, value)
    tree.links.new(node.outputs[output], tree.nodes["Emission"].inputs["Color"])
    camera = bpy.context.scene.camera
    camera.location = (0.5 * COLUMNS - 0.5, 0.5 * COLUMNS - 0.5, 3.0)
    size = 8
    picture = cycles_picture(size * COLUMNS, size * COLUMNS, 1)
    tree.nodes.remove(node)
    return picture[size // 2 :: size, size // 2 :: size]


def compare(fields: dict[tuple[int, int], dict[str, Any]], picture: np.ndarray, of: Callable[[Any], Any]) -> None:
    assert len(fields) >= 9
    for (column, row), known in fields.items():
        assert np.allclose(picture[row, column], of(known), atol=1e-5), (column, row)


def test_values_are_those_of_cycles(material: Any, gpu: None) -> None:
    fields = fields_by_cell()
    compare(fields, asked(material, "ShaderNodeObjectInfo", "Random"), lambda known: known["random"])
    compare(fields, asked(material, "ShaderNodeObjectInfo", "Color"), lambda known: known["color"][:3])
    compare(fields, asked(material, "ShaderNodeObjectInfo", "Object Index"), lambda known: known["pass_index"])
    for output, name in (("Generated", "instancer_generated"), ("UV", "instancer_uv")):
        picture = asked(material, "ShaderNodeTexCoord", output, from_instancer=True)

        def of(known: Any, name: str = name) -> Any:
            return np.maximum([*known.get(name, ()), 0.0, 0.0, 0.0][:3], 0.0)

        compare(fields, np.maximum(picture, 0.0), of)


@pytest.mark.parametrize("kind", ["OBJECT", "INSTANCER", "VIEW_LAYER"])
def test_values_by_name_are_those_of_cycles(material: Any, gpu: None, kind: str) -> None:
    fields = fields_by_cell()
    for name in NAMES:
        picture = asked(material, "ShaderNodeAttribute", "Vector", attribute_type=kind, attribute_name=name)
        compare(fields, picture, lambda known, name=name: dict(known["values"])[f"{kind}:{name}"][:3])
