# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where images lie on what mirrors show: UV maps, mappings, coordinates; attributes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import awkward
from ..stage import (
    find,
    matte,
    node,
    picture,
    principled_node,
    stage,
    stripes,
    textured,
    wall_of,
)


def _mapped(kind: str = "POINT", **values: tuple[float, float, float]) -> None:
    """Stripes placed by a Mapping node of this kind with these values for its sockets."""
    stage()
    material, tree, texture = textured("Turned", picture("Stripes", stripes()))
    mapping, coordinate = node(tree, "Mapping"), node(tree, "TexCoord")
    mapping.vector_type = kind
    for name, value in values.items():
        mapping.inputs[name].default_value = value
    tree.links.new(coordinate.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    wall_of(material)


@awkward("a rotated mapping")
def mapping_rotation(folder: Path) -> None:
    _mapped(Rotation=(0.0, 0.0, 0.8))


@awkward("a mapping as of a texture", words=("mapping",))
def mapping_texture_type(folder: Path) -> None:
    _mapped("TEXTURE", Rotation=(0.0, 0.0, 0.8), Scale=(0.5, 2.0, 1.0), Location=(0.3, 0.1, 0.0))


@awkward("a mapping turned about X", words=("mapping",))
def mapping_about_x(folder: Path) -> None:
    _mapped(Rotation=(1.0, 0.0, 0.7))


def _by_coordinate(output: str) -> None:
    stage()
    material, tree, texture = textured("Placed", picture("Stripes", stripes()))
    coordinate = node(tree, "TexCoord")
    tree.links.new(coordinate.outputs[output], texture.inputs["Vector"])
    wall_of(material)


@awkward("generated coordinates", words=("generated", "coordinate"))
def coordinates_generated(folder: Path) -> None:
    _by_coordinate("Generated")


@awkward("object coordinates", words=("object", "coordinate"))
def coordinates_object(folder: Path) -> None:
    _by_coordinate("Object")


@awkward("window coordinates", words=("without a UV map",))
def coordinates_window(folder: Path) -> None:
    _by_coordinate("Window")


@awkward("reflection coordinates", words=("without a UV map",))
def coordinates_reflection(folder: Path) -> None:
    _by_coordinate("Reflection")


@awkward("a named UV map that is not the active one")
def uv_named(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Named", picture("Stripes", stripes()))
    uv = node(tree, "UVMap")
    uv.uv_map = "Second"
    tree.links.new(uv.outputs[0], texture.inputs["Vector"])
    wall_of(material)
    for name in ("Wall", "Sample"):
        layers = find(name).data.uv_layers
        values = np.empty(2 * len(layers[0].uv), np.float32)
        layers[0].uv.foreach_get("vector", values)
        second = layers.new(name="Second")
        second.uv.foreach_set("vector", np.ascontiguousarray(values.reshape(-1, 2)[:, ::-1].ravel() * 0.7))
        layers.active_index = 0


@awkward("a UV map that does not exist")
def uv_missing(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Named", picture("Stripes", stripes()))
    uv = node(tree, "UVMap")
    uv.uv_map = "Nowhere"
    tree.links.new(uv.outputs[0], texture.inputs["Vector"])
    wall_of(material)


@awkward("a mesh without UVs under an image")
def uv_none(folder: Path) -> None:
    stage()
    wall_of(textured("Striped", picture("Stripes", stripes()))[0])
    for name in ("Wall", "Sample"):
        layers = find(name).data.uv_layers
        layers.remove(layers[0])


@awkward("the render UV map is another than the active one")
def uv_active_render(folder: Path) -> None:
    stage()
    wall_of(textured("Striped", picture("Stripes", stripes()))[0])
    layers = find("Wall").data.uv_layers
    second = layers.new(name="Second")
    values = np.empty(2 * len(layers[0].uv), np.float32)
    layers[0].uv.foreach_get("vector", values)
    second.uv.foreach_set("vector", np.ascontiguousarray(values.reshape(-1, 2)[:, ::-1].ravel()))
    layers["Second"].active_render = True
    layers.active_index = 0


def _attribute(kind: str, domain: str, values: Any, field: str) -> None:
    """Wall and ball whose color is an attribute of them of this kind and domain."""
    stage()
    material = matte("Attributed", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    attribute = node(tree, "Attribute")
    attribute.attribute_name = "Tint"
    tree.links.new(attribute.outputs["Color"], principled_node(material).inputs["Base Color"])
    wall_of(material)
    for name in ("Wall", "Sample"):
        made = find(name).data.attributes.new("Tint", kind, domain)
        count = len(made.data)
        made.data.foreach_set(field, np.ascontiguousarray(np.resize(values, (count, *np.shape(values)[1:]))).ravel())


@awkward("a color attribute of vertices")
def attribute_color(folder: Path) -> None:
    _attribute("FLOAT_COLOR", "POINT", [(0.9, 0.2, 0.1, 1.0), (0.1, 0.3, 0.9, 1.0), (0.2, 0.8, 0.2, 1.0)], "color")


@awkward("a byte color attribute of corners")
def attribute_byte_color(folder: Path) -> None:
    _attribute("BYTE_COLOR", "CORNER", [(0.9, 0.2, 0.1, 1.0), (0.1, 0.3, 0.9, 1.0)], "color")


@awkward("a float attribute of vertices")
def attribute_float(folder: Path) -> None:
    _attribute("FLOAT", "POINT", [0.1, 0.9, 0.5], "value")


@awkward("a float attribute of faces")
def attribute_face(folder: Path) -> None:
    _attribute("FLOAT", "FACE", [0.1, 0.9], "value")


@awkward("a vector attribute of vertices")
def attribute_vector(folder: Path) -> None:
    _attribute("FLOAT_VECTOR", "POINT", [(0.9, 0.2, 0.1), (0.1, 0.3, 0.9)], "vector")


@awkward("an integer attribute of faces")
def attribute_int(folder: Path) -> None:
    _attribute("INT", "FACE", [0, 1], "value")


@awkward("a boolean attribute of faces")
def attribute_bool(folder: Path) -> None:
    _attribute("BOOLEAN", "FACE", [True, False, False], "value")


@awkward("an attribute that no mesh has")
def attribute_missing(folder: Path) -> None:
    stage()
    material = matte("Attributed", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    attribute = node(tree, "Attribute")
    attribute.attribute_name = "Nowhere"
    tree.links.new(attribute.outputs["Color"], principled_node(material).inputs["Base Color"])
    wall_of(material)


@awkward("an attribute of the object", words=("attributes of the object",))
def attribute_of_object(folder: Path) -> None:
    stage()
    material = matte("Attributed", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    attribute = node(tree, "Attribute")
    attribute.attribute_type, attribute.attribute_name = "OBJECT", "tint"
    tree.links.new(attribute.outputs["Color"], principled_node(material).inputs["Base Color"])
    wall_of(material)
    find("Wall")["tint"], find("Sample")["tint"] = (0.9, 0.3, 0.1), (0.1, 0.3, 0.9)


@awkward("the Color Attribute node")
def vertex_color_node(folder: Path) -> None:
    stage()
    material = matte("Painted", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    color = node(tree, "VertexColor")
    color.layer_name = "Paint"
    tree.links.new(color.outputs["Color"], principled_node(material).inputs["Base Color"])
    wall_of(material)
    for name in ("Wall", "Sample"):
        paint = find(name).data.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
        colors = np.resize([(0.9, 0.2, 0.1, 1.0), (0.1, 0.3, 0.9, 1.0)], (len(paint.data), 4))
        paint.data.foreach_set("color", colors.ravel())
