# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How nodes are linked: groups, reroutes, muted nodes and links, values turned into those of another kind."""

from __future__ import annotations

from typing import Any

import bpy

from ..trees import ACROSS, DAMP, PAINT, PLACE, UP, WIND, Row, rows, shader_node


def _group(inner: Any, default: float = 0.7) -> Any:
    """A group with inputs "In" and "Free" (`default`), and outputs "Sum" and "Free" too."""
    group = bpy.data.node_groups.new("judged", "ShaderNodeTree")
    for name, way in (("In", "INPUT"), ("Free", "INPUT"), ("Sum", "OUTPUT"), ("Through", "OUTPUT")):
        socket = group.interface.new_socket(name, in_out=way, socket_type="NodeSocketFloat")
        if name == "Free":
            socket.default_value = default
    start, end = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    group.links.new(inner(group, start.outputs["In"], start.outputs["Free"]), end.inputs["Sum"])
    group.links.new(start.outputs["Free"], end.inputs["Through"])
    return group


def _sum(tree: Any, first: Any, second: Any) -> Any:
    node = tree.nodes.new("ShaderNodeMath")
    tree.links.new(first, node.inputs[0])
    tree.links.new(second, node.inputs[1])
    return node.outputs[0]


def _placed_group(tree: Any, group: Any) -> Any:
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    return node


def in_group(tree: Any) -> Any:
    node = _placed_group(tree, _group(_sum))
    tree.links.new(ACROSS(tree), node.inputs["In"])
    return node.outputs["Sum"]


def in_nested_group(tree: Any) -> Any:
    def inner(group: Any, first: Any, second: Any) -> Any:
        node = _placed_group(group, _group(_sum, 0.3))
        group.links.new(first, node.inputs["In"])
        return _sum(group, node.outputs["Sum"], second)

    node = _placed_group(tree, _group(inner))
    tree.links.new(UP(tree), node.inputs["In"])
    node.inputs["Free"].default_value = -0.2
    return _sum(tree, node.outputs["Sum"], node.outputs["Through"])


def same_group_twice(tree: Any) -> Any:
    group = _group(_sum)
    first, second = _placed_group(tree, group), _placed_group(tree, group)
    tree.links.new(ACROSS(tree), first.inputs["In"])
    tree.links.new(first.outputs["Sum"], second.inputs["In"])
    tree.links.new(DAMP(tree), second.inputs["Free"])
    return second.outputs["Sum"]


def empty_group(tree: Any) -> Any:
    node = _placed_group(tree, _group(lambda group, first, second: first))
    return node.outputs["Sum"]


def muted_group(tree: Any) -> Any:
    node = _placed_group(tree, _group(_sum))
    tree.links.new(ACROSS(tree), node.inputs["In"])
    node.mute = True
    return node.outputs["Sum"]


def reroutes(tree: Any) -> Any:
    first, second = tree.nodes.new("NodeReroute"), tree.nodes.new("NodeReroute")
    tree.links.new(PAINT(tree), first.inputs[0])
    tree.links.new(first.outputs[0], second.inputs[0])
    return second.outputs[0]


def loose_reroute(tree: Any) -> Any:
    node = tree.nodes.new("ShaderNodeMath")
    node.inputs[0].default_value = node.inputs[1].default_value = 0.3
    tree.links.new(tree.nodes.new("NodeReroute").outputs[0], node.inputs[0])
    return node.outputs[0]


def muted_node(tree: Any) -> Any:
    socket = shader_node("Math", {0: ACROSS, 1: 3.0}, operation="MULTIPLY")(tree)
    socket.node.mute = True
    return socket


def muted_mix(tree: Any) -> Any:
    socket = shader_node("Mix", {"Factor": 0.5, "A": PAINT, "B": (1.0, 0.0, 0.0, 1.0)}, data_type="RGBA")(tree)
    socket.node.mute = True
    return socket


def muted_without_way(tree: Any) -> Any:
    socket = shader_node("TexNoise")(tree)
    socket.node.mute = True
    return _sum(tree, socket, ACROSS(tree))


def muted_without_link(tree: Any) -> Any:
    """Its own value does not pass."""
    socket = shader_node("Math", {0: 0.8, 1: 3.0}, operation="MULTIPLY")(tree)
    socket.node.mute = True
    return _sum(tree, socket, ACROSS(tree))


def muted_group_without_link(tree: Any) -> Any:
    node = _placed_group(tree, _group(_sum))
    node.inputs["In"].default_value = 0.3
    node.mute = True
    return _sum(tree, node.outputs["Sum"], ACROSS(tree))


def muted_link(tree: Any) -> Any:
    socket = shader_node("Math", {0: ACROSS, 1: 0.4})(tree)
    socket.node.inputs[0].default_value = 0.25
    socket.node.inputs[0].links[0].is_muted = True
    return socket


def several_outputs(tree: Any) -> Any:
    """One node asked for two of its outputs."""
    node = shader_node("SeparateXYZ", {0: WIND})(tree).node
    return _sum(tree, node.outputs[0], node.outputs[2])


def mapped(kind: str) -> Any:
    """A texture with a mapping of its own, which scripts and old files set."""

    def adjust(node: Any) -> None:
        mapping = node.texture_mapping
        mapping.vector_type = kind
        mapping.translation, mapping.rotation, mapping.scale = (0.2, -0.1, 0.3), (0.3, -0.2, 0.5), (1.5, 0.7, 1.2)
        mapping.mapping_x, mapping.mapping_z = "Z", "X"

    return shader_node("TexGradient", {"Vector": PLACE}, adjust=adjust)


def framed(tree: Any) -> Any:
    socket = ACROSS(tree)
    socket.node.parent = tree.nodes.new("NodeFrame")
    return socket


ROWS: list[Row] = [
    *rows(
        "Group",
        ("", in_group),
        ("Nested", in_nested_group),
        ("Twice", same_group_twice),
        ("With nothing plugged in", empty_group),
        ("Muted", muted_group),
        ("Muted, with nothing plugged in", muted_group_without_link),
    ),
    *rows("Reroute", ("", reroutes), ("With nothing plugged in", loose_reroute)),
    *rows("Frame", ("", framed)),
    *rows(
        "Muted nodes",
        ("", muted_node),
        ("Mix", muted_mix),
        ("Without a way through", muted_without_way),
        ("With nothing plugged in", muted_without_link),
        ("Muted links", muted_link),
    ),
    *rows(
        "Textures' own mapping",
        *((kind.capitalize(), mapped(kind)) for kind in ("POINT", "TEXTURE", "VECTOR", "NORMAL")),
    ),
    *rows("Several outputs", ("", several_outputs)),
    *rows(
        "Conversion",
        ("Color to float", shader_node("Math", {0: PAINT, 1: 0.0})),
        ("Vector to float", shader_node("Math", {0: WIND, 1: 0.0})),
        ("Float to vector", shader_node("VectorMath", {0: ACROSS, 1: (0.1, 0.2, 0.3)})),
        ("Color to vector", shader_node("VectorMath", {0: PAINT, 1: (0.1, 0.2, 0.3)})),
    ),
]
