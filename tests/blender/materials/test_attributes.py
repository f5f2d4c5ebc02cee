# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of all types and domains as colors, against what Cycles shows of them."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from channels import channel_on
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from extraction import add_square, cycles_picture, empty_scene, extracted, look_down, new_material
from scene.color_nodes import Tree, node, smooth_image

TYPES: dict[str, tuple[str, Any]] = {
    "FLOAT": ("value", 0.3),
    "INT": ("value", 1),
    "INT8": ("value", 1),
    "BOOLEAN": ("value", True),
    "FLOAT2": ("vector", (0.1, 0.2)),
    "FLOAT_VECTOR": ("vector", (0.1, 0.2, 0.6)),
    "FLOAT_COLOR": ("color", (0.1, 0.2, 0.6, 0.4)),
    "BYTE_COLOR": ("color", (0.1, 0.2, 0.6, 0.4)),
    "QUATERNION": ("value", (0.1, 0.2, 0.6, 0.4)),
    "INT32_2D": ("value", (1, 1)),
}
DOMAINS = {
    "POINT": [0.1, 0.9, 0.3, 0.5],
    "CORNER": [0.1, 0.9, 0.3, 0.5],
    "EDGE": [0.0, 0.2, 0.6, 1.0],
    "FACE": [0.4],
}


pytestmark = pytest.mark.usefixtures("gpu")


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def attribute_square(name: str, kind: str, domain: str, values: list[Any]) -> bpy.types.Object:
    """A square with an attribute "a", of one value or of one for each element."""
    square = add_square(name, 1.0)
    attribute: Any = square.data.attributes.new("a", kind, domain)
    for item, value in zip(attribute.data, values * (len(attribute.data) // len(values)), strict=True):
        setattr(item, TYPES[kind][0], value)
    return square


def show(square: bpy.types.Object, column: int, output: str, attribute: str = "a", painted: bool = False) -> None:
    """As the base color of a matt surface, which `shown_by_cycles` makes shine."""
    square.location.x = column
    tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    made = node(tree, "ShaderNodeVertexColor" if painted else "ShaderNodeAttribute")
    setattr(made, "layer_name" if painted else "attribute_name", attribute)
    tree.links.new(made.outputs[output], shader.inputs["Color"])


def shown_by_cycles(count: int) -> np.ndarray:
    """(count, 3) at the middle of each square."""
    for obj in bpy.context.scene.objects:
        tree: Tree = obj.data.materials[0].node_tree
        color = tree.nodes["Diffuse BSDF"].inputs["Color"].links[0].from_socket
        emission = node(tree, "ShaderNodeEmission", {"Color": color})
        tree.links.new(emission.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    look_down(count).location.x = 0.5 * (count - 1)
    return cycles_picture(9 * count, 9, 4)[4, 4::9]


def middle(scene: SceneArrays, name: str) -> np.ndarray:
    """(3,) color in the middle of a square."""
    return channel_on(scene, name, "base_color", [(0.0, 0.0)])[0]


def test_types_are_those_of_cycles() -> None:
    names = []
    for kind, (_, value) in TYPES.items():
        for output in ("Color", "Fac", "Alpha", "Vector"):
            names.append(f"{kind} {output}")
            show(attribute_square(names[-1], kind, "POINT", [value]), len(names) - 1, output)
    for painted, attribute in ((False, "gone"), (True, "gone"), (True, ""), (False, "UVMap")):
        for output in ("Color", "Alpha"):
            names.append(f"{painted} {attribute} {output}")
            show(add_square(names[-1], 1.0), len(names) - 1, output, attribute, painted)
    names.append("default")
    show(attribute_square("default", "FLOAT_COLOR", "POINT", [(0.3, 0.4, 0.5, 0.6)]), len(names) - 1, "Color", "", True)
    scene = extracted()
    assert not scene.warnings
    cycles = shown_by_cycles(len(names))
    for name, color in zip(names, cycles, strict=True):
        # (Coordinates change within the pixel.)
        np.testing.assert_allclose(middle(scene, name), color, atol=0.02 if "UVMap" in name else 4e-3, err_msg=name)


def test_domains_are_those_of_cycles() -> None:
    for column, (domain, values) in enumerate(DOMAINS.items()):
        show(attribute_square(domain, "FLOAT", domain, values), column, "Color")
    scene = extracted()
    cycles = shown_by_cycles(len(DOMAINS))
    for domain, color in zip(DOMAINS, cycles, strict=True):
        np.testing.assert_allclose(middle(scene, domain), color, atol=0.03, err_msg=domain)


def test_values_beyond_1_are_those_of_cycles() -> None:
    show(attribute_square("bright", "FLOAT", "POINT", [1.2, 1.8, 1.8, 1.2]), 0, "Color")
    scene = extracted()
    assert not scene.warnings
    np.testing.assert_allclose(middle(scene, "bright"), shown_by_cycles(1)[0], atol=0.03)


def test_an_attribute_of_points_gives_coordinates() -> None:
    """As a UV map would; an image node's own are others."""
    square = attribute_square("square", "FLOAT_VECTOR", "POINT", [(0.1, 0.4, 9.0)])
    tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    place = node(tree, "ShaderNodeAttribute", attribute_name="a").outputs["Vector"]
    texture = node(tree, "ShaderNodeTexImage", {"Vector": place}, image=smooth_image())
    tree.links.new(texture.outputs["Color"], shader.inputs["Color"])
    scene = extracted()
    assert not scene.warnings
    np.testing.assert_allclose(middle(scene, "square"), shown_by_cycles(1)[0], atol=2e-3)


def test_generated_coordinates_of_a_deformed_object_are_said() -> None:
    square = add_square()
    tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    place = node(tree, "ShaderNodeTexCoord").outputs["Generated"]
    texture = node(tree, "ShaderNodeTexImage", {"Vector": place}, image=smooth_image())
    tree.links.new(texture.outputs["Color"], shader.inputs["Color"])
    assert not extracted().warnings
    square.modifiers.new("bend", "SIMPLE_DEFORM")
    (warning,) = extracted().warnings
    assert warning.startswith('Generated coordinates of object "square"')
