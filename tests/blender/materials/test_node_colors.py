# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors that nodes make of constants, most of them known without a program, against what Cycles shows of them."""

from __future__ import annotations

import itertools
from typing import Any

import bpy
import numpy as np
import pytest
from channels import channel_on
from extraction import add_square, cycles_picture, empty_scene, extracted, look_down, new_material
from scene.color_nodes import COLOR, OTHER, BuildColor, Tree, mix, node

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def _color(tree: Tree, color: tuple[float, ...] = COLOR) -> Any:
    made = node(tree, "ShaderNodeRGB")
    made.outputs[0].default_value = color
    return made.outputs[0]


def _bright(**more: Any) -> BuildColor:
    inputs = {"Factor_Float": 1.5, "A_Color": (0.9, 0.5, 0.1, 1.0), "B_Color": (0.8, 0.1, 0.3, 1.0)}
    return lambda tree: node(tree, "ShaderNodeMix", inputs, data_type="RGBA", blend_type="ADD", **more).outputs[2]


def _math(operation: str, a: float, b: float, **more: Any) -> BuildColor:
    return lambda tree: node(
        tree, "ShaderNodeMath", {0: a, 1: b, "Value_002": 0.3}, operation=operation, **more
    ).outputs[0]


def _vector_math(operation: str) -> BuildColor:
    inputs = {"Vector": (0.7, 0.3, 0.9), "Vector_001": (0.4, 0.6, 0.2), "Vector_002": (0.1, 0.2, 0.3)}
    return lambda tree: node(tree, "ShaderNodeVectorMath", inputs, operation=operation).outputs[0]


def _map_range(kind: str, value: float, clamp: bool) -> BuildColor:
    inputs = {"Value": value, "From Min": 0.2, "From Max": 0.8, "To Min": 0.9, "To Max": 0.1}
    return lambda tree: node(tree, "ShaderNodeMapRange", inputs, interpolation_type=kind, clamp=clamp).outputs[0]


def _channel(mode: str, channel: int) -> BuildColor:
    return lambda tree: node(tree, "ShaderNodeSeparateColor", {"Color": _color(tree)}, mode=mode).outputs[channel]


def _combined(mode: str) -> BuildColor:
    return lambda tree: node(
        tree, "ShaderNodeCombineColor", {"Red": 0.6, "Green": 0.4, "Blue": 0.7}, mode=mode
    ).outputs[0]


def _ramp(output: str) -> BuildColor:
    def build(tree: Tree) -> Any:
        ramp = node(tree, "ShaderNodeValToRGB", {"Fac": _color(tree)})
        ramp.color_ramp.elements[0].color = (1.0, 0.0, 0.5, 0.2)
        ramp.color_ramp.elements[1].color = (0.0, 1.0, 0.25, 1.0)
        return ramp.outputs[output]

    return build


def _curves(tree: Tree) -> Any:
    made = node(tree, "ShaderNodeRGBCurve", {"Color": COLOR, "Fac": 0.8})
    made.mapping.curves[3].points.new(0.5, 0.7)
    made.mapping.curves[0].points.new(0.5, 0.3)
    made.mapping.update()
    return made.outputs[0]


def _mixed_vectors(tree: Tree) -> Any:
    inputs = {"Factor_Vector": (0.2, 0.5, 0.9), "A_Vector": COLOR[:3], "B_Vector": OTHER[:3]}
    return node(tree, "ShaderNodeMix", inputs, data_type="VECTOR", factor_mode="NON_UNIFORM").outputs[1]


def _group(kind: str, passes: bool = True, mute: bool = False) -> BuildColor:
    """A color through a group whose input is of this kind; without a link if it is not passed."""

    def build(tree: Tree) -> Any:
        inner = bpy.data.node_groups.new("group", "ShaderNodeTree")
        entry = inner.interface.new_socket("In", in_out="INPUT", socket_type=kind)
        inner.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketColor")
        start, end = node(inner, "NodeGroupInput"), node(inner, "NodeGroupOutput")
        entry.default_value = 0.7 if kind == "NodeSocketFloat" else (0.2, 0.8, 0.4, 1.0)
        change = node(inner, "ShaderNodeGamma", {"Color": start.outputs[0], "Gamma": 2.0})
        inner.links.new(change.outputs[0], end.inputs[0])
        group = node(tree, "ShaderNodeGroup", node_tree=inner)
        group.mute = mute
        if passes:
            tree.links.new(node(tree, "NodeReroute", {0: _color(tree)}).outputs[0], group.inputs[0])
        return group.outputs[0]

    return build


def _muted_source(tree: Tree) -> Any:
    """Nothing goes through it: what it is plugged into has its own value."""
    noise = node(tree, "ShaderNodeTexNoise")
    noise.mute = True
    return node(tree, "ShaderNodeGamma", {"Color": (0.5, 0.25, 0.75, 1.0), "Gamma": noise.outputs[0]}).outputs[0]


def _to_number(output: str) -> BuildColor:
    """A color, or a vector, where a number is asked for."""

    def build(tree: Tree) -> Any:
        source = _color(tree)
        if output == "Vector":
            source = node(tree, "ShaderNodeVectorMath", {"Vector": source}, operation="ABSOLUTE").outputs[0]
        return node(tree, "ShaderNodeMath", {0: source, 1: 0.1}, operation="ADD").outputs[0]

    return build


def choices(kind: str, name: str) -> list[str]:
    """Of a node's setting."""
    return [item.identifier for item in getattr(bpy.types, kind).bl_rna.properties[name].enum_items]


BLENDS = choices("ShaderNodeMix", "blend_type")
NUMBER_OPERATIONS = choices("ShaderNodeMath", "operation")
VECTOR_OPERATIONS = choices("ShaderNodeVectorMath", "operation")
KINDS = ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP")
CONSTANTS: dict[str, BuildColor] = {
    **{f"{blend} {factor}": mix(blend, factor) for blend in BLENDS for factor in (0.3, 1.0)},
    "clamped factor": _bright(clamp_factor=True),
    "clamped result": _bright(clamp_factor=False, clamp_result=True),
    "no clamp": _bright(clamp_factor=False),
    "old mix": lambda tree: node(
        tree,
        "ShaderNodeMixRGB",
        {"Fac": 0.7, "Color1": COLOR, "Color2": (0.9, 0.9, 0.9, 1.0)},
        blend_type="ADD",
        use_clamp=True,
    ).outputs[0],
    "mixed vectors": _mixed_vectors,
    **{f"math {name}": _math(name, 0.7, 0.4) for name in NUMBER_OPERATIONS},
    **{f"math {name} below 0": _math(name, -0.7, 3.0) for name in ("POWER", "MODULO", "FLOORED_MODULO", "SNAP")},
    "math clamped": _math("ADD", 0.7, 0.4, use_clamp=True),
    **{f"vectors {name}": _vector_math(name) for name in VECTOR_OPERATIONS},
    **{
        f"range {kind} {value} {clamp}": _map_range(kind, value, clamp)
        for kind, value, clamp in itertools.product(KINDS, (0.35, 0.9), (True, False))
    },
    "clamp": lambda tree: node(tree, "ShaderNodeClamp", {"Value": 0.9, "Min": 0.8, "Max": 0.2}).outputs[0],
    "clamp range": lambda tree: node(
        tree, "ShaderNodeClamp", {"Value": 0.9, "Min": 0.8, "Max": 0.2}, clamp_type="RANGE"
    ).outputs[0],
    **{f"channel {mode} {k}": _channel(mode, k) for mode in ("RGB", "HSV", "HSL") for k in range(3)},
    **{f"combined {mode}": _combined(mode) for mode in ("RGB", "HSV", "HSL")},
    "x of a color": lambda tree: node(tree, "ShaderNodeSeparateXYZ", {0: _color(tree)}).outputs[1],
    "ramp": _ramp("Color"),
    "ramp's alpha": _ramp("Alpha"),
    "curves": _curves,
    "group": _group("NodeSocketColor"),
    "group of a number": _group("NodeSocketFloat"),
    "group without a link": _group("NodeSocketColor", passes=False),
    "muted group": _group("NodeSocketColor", mute=True),
    "muted source": _muted_source,
    "luminance": _to_number("Color"),
    "mean": _to_number("Vector"),
}


def test_colors_that_nodes_make_are_those_of_cycles() -> None:
    """One emitting square per kind, in one picture of a pixel each; the view is wider than the pixel filter."""
    count = len(CONSTANTS)
    for index, (name, build) in enumerate(CONSTANTS.items()):
        square = add_square(name, 1.0)
        square.location = (index - 0.5 * (count - 1), 0.0, 0.0)
        tree, (emission,) = new_material(square, "ShaderNodeEmission")
        tree.links.new(build(tree), emission.inputs["Color"])
    look_down(count)
    scene = extracted()
    assert not scene.warnings
    picture = cycles_picture(5 * count, 5, 1)[2, 2::5]
    for index, name in enumerate(CONSTANTS):
        found = channel_on(scene, name, "emission", [(0.0, 0.0)])[0]
        np.testing.assert_allclose(found, picture[index], rtol=2e-3, atol=2e-3, err_msg=name)
