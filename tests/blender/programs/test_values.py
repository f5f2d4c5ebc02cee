# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes of values as programs: what is known beforehand, what is the same program, what is said.

(Whether they are right is judged by tests/blender/nodes.)
"""

from __future__ import annotations

from typing import Any

import bpy
import pytest
from curvrefl.curvrefl_addon.scene.materials.node_links import Source, find_input
from curvrefl.curvrefl_addon.scene.programs.builder import Builder
from curvrefl.curvrefl_addon.scene.programs.expression import Expression
from curvrefl.curvrefl_addon.scene.programs.registry import HANDLERS

_OF_OTHERS = ("TEX_IMAGE", "TEX_ENVIRONMENT", "TEX_SKY")
"""Types of nodes that need an image or a sky"""


class _NoImages:
    def index_of(self, node: Any, note: Any, splits_alpha: bool) -> int | None:
        return None


@pytest.fixture
def tree() -> Any:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    tree = bpy.data.materials.new("material").node_tree
    tree.nodes.clear()
    return tree


def _builder(is_world: bool = False) -> tuple[Builder, list[str]]:
    notes: list[str] = []
    return Builder(HANDLERS, _NoImages(), notes, is_world=is_world), notes


def _node(tree: Any, kind: str, inputs: dict[str, Any] | None = None, **settings: Any) -> Any:
    node = tree.nodes.new(kind)
    for name, value in settings.items():
        setattr(node, name, value)
    for name, value in (inputs or {}).items():
        socket = find_input(node, name)
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = value
    return node


def _value(socket: Any, kind: Any = "color") -> Expression:
    return _builder()[0].value(Source(socket), kind)


def test_what_is_known_needs_no_program(tree: Any) -> None:
    red = _node(tree, "ShaderNodeRGB").outputs[0]
    red.default_value = (0.8, 0.2, 0.1, 1.0)
    darker = _node(tree, "ShaderNodeHueSaturation", {"Color": red, "Value": 0.5}).outputs[0]
    colors = {"Factor_Float": 0.5, "A_Color": darker, "B_Color": (0.0, 1.0, 0.0, 1.0)}
    mixed = _node(tree, "ShaderNodeMix", colors, data_type="RGBA")
    part = _node(tree, "ShaderNodeSeparateColor", {"Color": mixed.outputs[2]}).outputs["Green"]
    doubled = _node(tree, "ShaderNodeMath", {"Value": part, "Value_001": 2.0}, operation="MULTIPLY").outputs[0]
    assert _value(darker).constant == pytest.approx((0.4, 0.1, 0.05), abs=1e-6)
    assert _value(doubled, "float").constant == pytest.approx((1.1,), abs=1e-6)
    warm = _node(tree, "ShaderNodeBlackbody", {"Temperature": 6500.0}).outputs[0]
    assert _value(warm).constant == pytest.approx((1.0426, 0.9841, 1.0353), abs=1e-3)


def test_other_constants_are_the_same_program(tree: Any) -> None:
    def shape(scale: float, stop: float) -> Any:
        place = _node(tree, "ShaderNodeTexCoord").outputs["Object"]
        moved = _node(tree, "ShaderNodeMapping", {"Vector": place, "Scale": (scale,) * 3}).outputs[0]
        ramp = _node(tree, "ShaderNodeValToRGB", {"Fac": moved})
        ramp.color_ramp.elements[1].position = stop
        b, notes = _builder()
        program = b.finished({"base_color": b.value(Source(ramp.outputs[0]), "color")})
        assert not notes
        return program.shape

    assert shape(1.0, 0.9) == shape(2.5, 0.4)


def test_bounds_say_what_can_be_seen_through(tree: Any) -> None:
    across = _node(tree, "ShaderNodeAttribute", attribute_name="across").outputs["Fac"]
    assert _value(across, "float").high > 1.0
    clamped = _node(tree, "ShaderNodeClamp", {"Value": across, "Min": 0.25, "Max": 0.75}).outputs[0]
    sharp = _node(tree, "ShaderNodeMath", {"Value": across, "Value_001": 0.5}, operation="GREATER_THAN").outputs[0]
    both = _node(tree, "ShaderNodeMath", {"Value": clamped, "Value_001": sharp}, operation="MULTIPLY").outputs[0]
    mapped = _node(tree, "ShaderNodeMapRange", {"Value": across, "To Min": 0.5, "To Max": 0.9}).outputs[0]
    for socket, low, high in ((clamped, 0.25, 0.75), (sharp, 0.0, 1.0), (both, 0.0, 0.75), (mapped, 0.5, 0.9)):
        found = _value(socket, "float")
        assert (found.low, found.high) == pytest.approx((low, high))


def test_values_of_all_kinds_and_menus(tree: Any) -> None:
    number = _node(tree, "FunctionNodeInputInt", integer=3).outputs[0]
    vector = _node(tree, "FunctionNodeInputVector", vector=(1.0, 2.0, 4.0)).outputs[0]
    assert _value(number, "float").constant == (3.0,)
    assert _value(vector, "vector").constant == (1.0, 2.0, 4.0)
    switch = _node(tree, "GeometryNodeMenuSwitch", {"Item_1": (0.5, 0.25, 0.125, 1.0)}, data_type="RGBA")
    switch.inputs["Menu"].default_value = "B"
    assert _value(switch.outputs["Output"]).constant == (0.5, 0.25, 0.125)
    assert _value(switch.outputs["Item_0"], "float").constant == (0.0,)


@pytest.mark.parametrize("is_world", [False, True])
def test_each_output_of_each_node_has_a_value(tree: Any, is_world: bool) -> None:
    """Or is named: nothing that the shader editor has stops a material from being read."""
    names = [name for name in dir(bpy.types) if name.startswith(("ShaderNode", "FunctionNode", "GeometryNode", "Node"))]
    known = 0
    for name in names:
        try:
            node = tree.nodes.new(name)
        except RuntimeError:
            continue
        if node.type in _OF_OTHERS:
            continue
        for output in node.outputs:
            if output.type not in ("VALUE", "VECTOR", "RGBA", "INT", "BOOLEAN"):
                continue
            b, notes = _builder(is_world)
            value = b.value(Source(output), "color")
            assert value.text, (name, output.name)
            known += not notes
    assert known > 140
