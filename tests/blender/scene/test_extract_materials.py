# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials as read, against what Cycles shows of them."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.arrays import Glass, MaterialArrays
from extraction import add, add_square, cycles_picture, empty_scene, extracted, look_down, material_of, new_material
from scene.color_nodes import COLOR, OTHER, BuildColor, Tree, mix, node


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def _ramp(tree: Tree) -> Any:
    value = node(tree, "ShaderNodeValue")
    value.outputs[0].default_value = 0.3
    ramp = node(tree, "ShaderNodeValToRGB", {"Fac": value.outputs[0]})
    ramp.color_ramp.elements[0].color = (1.0, 0.0, 0.5, 1.0)
    ramp.color_ramp.elements[1].color = (0.0, 1.0, 0.25, 1.0)
    return ramp.outputs["Color"]


def _group(tree: Tree) -> Any:
    inner = bpy.data.node_groups.new("half", "ShaderNodeTree")
    inner.interface.new_socket("In", in_out="INPUT", socket_type="NodeSocketColor")
    inner.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketColor")
    start, end = node(inner, "NodeGroupInput"), node(inner, "NodeGroupOutput")
    change = node(inner, "ShaderNodeGamma", {"Color": start.outputs[0], "Gamma": 2.0})
    inner.links.new(change.outputs[0], end.inputs[0])
    color = node(tree, "ShaderNodeRGB")
    color.outputs[0].default_value = COLOR
    through = node(tree, "NodeReroute", {0: color.outputs[0]})
    group = node(tree, "ShaderNodeGroup", node_tree=inner)
    tree.links.new(through.outputs[0], group.inputs[0])
    return group.outputs[0]


def _muted(tree: Tree) -> Any:
    made = node(tree, "ShaderNodeInvert", {"Color": COLOR})
    after = node(tree, "ShaderNodeGamma", {"Color": made.outputs[0], "Gamma": 3.0})
    after.mute = True
    return after.outputs[0]


CONSTANTS: dict[str, BuildColor] = {
    **{
        f"{blend} {factor}": mix(blend, factor)
        for blend in ("MIX", "MULTIPLY", "ADD", "SCREEN")
        for factor in (0.3, 1.0)
    },
    **{blend: mix(blend, 0.7) for blend in ("SUBTRACT", "DARKEN", "LIGHTEN", "DIFFERENCE")},
    "old mix": lambda tree: node(
        tree, "ShaderNodeMixRGB", {"Fac": 0.25, "Color1": COLOR, "Color2": OTHER}, blend_type="MULTIPLY"
    ).outputs[0],
    "gamma": lambda tree: node(tree, "ShaderNodeGamma", {"Color": COLOR, "Gamma": 2.2}).outputs[0],
    "invert": lambda tree: node(tree, "ShaderNodeInvert", {"Color": COLOR, "Fac": 0.8}).outputs[0],
    "contrast": lambda tree: node(
        tree, "ShaderNodeBrightContrast", {"Color": COLOR, "Bright": 0.1, "Contrast": 0.4}
    ).outputs[0],
    "hue": lambda tree: node(
        tree, "ShaderNodeHueSaturation", {"Color": COLOR, "Hue": 0.8, "Saturation": 0.7, "Value": 1.3, "Fac": 0.9}
    ).outputs[0],
    "gray": lambda tree: node(tree, "ShaderNodeRGBToBW", {"Color": COLOR}).outputs[0],
    "math": lambda tree: node(tree, "ShaderNodeMath", {0: 0.3, 1: 0.4}, operation="POWER").outputs[0],
    "ramp": _ramp,
    "group": _group,
    "muted": _muted,
}


def test_colors_that_nodes_make_are_those_of_cycles() -> None:
    """One emitting square per kind, in one picture of a pixel each; the view is wider than the pixel filter."""
    count = len(CONSTANTS)
    for index, (name, build) in enumerate(CONSTANTS.items()):
        square = add_square(name, 1.0)
        square.location = (index - 0.5 * (count - 1), 0.0, 0.0)
        tree, (emission,) = new_material(square, "ShaderNodeEmission")
        tree.links.new(build(tree), emission.inputs["Color"])
        emission.inputs["Strength"].default_value = 2.0
    look_down(count)
    scene = extracted()
    assert not scene.warnings
    picture = cycles_picture(5 * count, 5, 1)[2, 2::5]
    for index, name in enumerate(CONSTANTS):
        np.testing.assert_allclose(
            material_of(scene, name).emission, picture[index], rtol=2e-3, atol=1e-3, err_msg=name
        )


def test_the_principled_shader() -> None:
    cube = add("cube")
    tree, (shader,) = new_material(cube, "ShaderNodeBsdfPrincipled")
    for name, value in {
        "Base Color": COLOR,
        "Metallic": 0.25,
        "Roughness": 0.125,
        "IOR": 1.75,
        "Specular IOR Level": 0.375,
        "Emission Color": OTHER,
        "Emission Strength": 2.0,
    }.items():
        shader.inputs[name].default_value = value
    scene = extracted()
    material = material_of(scene, "cube")
    np.testing.assert_allclose(material.base_color, COLOR[:3], rtol=1e-6)
    np.testing.assert_allclose(material.emission, 2.0 * np.array(OTHER[:3]), rtol=1e-6)
    assert (material.metallic, material.roughness, material.ior, material.specular_level) == (0.25, 0.125, 1.75, 0.375)
    assert not material.glossy_only and material.program is None and not scene.warnings
    tree.links.new(node(tree, "ShaderNodeTexNoise").outputs[0], shader.inputs["Roughness"])
    scene = extracted()
    assert material_of(scene, "cube").varies("roughness") and not scene.warnings


def simple(kind: str, **inputs: Any) -> tuple[MaterialArrays, tuple[str, ...]]:
    """A cube with one shader node, read."""
    cube = add("cube")
    _, (shader,) = new_material(cube, kind)
    for name, value in inputs.items():
        shader.inputs[name].default_value = value
    scene = extracted()
    return material_of(scene, "cube"), scene.warnings


def test_other_shaders() -> None:
    material, warnings = simple("ShaderNodeBsdfDiffuse", Color=COLOR)
    assert (material.specular_level, material.metallic, warnings) == (0.0, 0.0, ())
    np.testing.assert_allclose(material.base_color, COLOR[:3], rtol=1e-6)


def test_the_glossy_shader() -> None:
    material, warnings = simple("ShaderNodeBsdfGlossy", Color=COLOR, Roughness=0.25)
    assert material.glossy_only and material.roughness == 0.25 and not warnings
    np.testing.assert_allclose(material.base_color, COLOR[:3], rtol=1e-6)


def test_the_emission_shader() -> None:
    material, warnings = simple("ShaderNodeEmission", Color=COLOR, Strength=3.0)
    np.testing.assert_allclose(material.emission, 3.0 * np.array(COLOR[:3]), rtol=1e-6)
    assert material.base_color == (0.0, 0.0, 0.0) and material.specular_level == 0.0 and not warnings


def test_glass_is_what_its_node_says() -> None:
    material, warnings = simple("ShaderNodeBsdfGlass", Color=COLOR, Roughness=0.25, IOR=1.33)
    np.testing.assert_allclose(material.base_color, COLOR[:3], rtol=1e-6)
    assert (material.transmission, material.glass, material.roughness) == (1.0, Glass.GLASS, 0.25)
    assert material.ior == pytest.approx(1.33) and not warnings


def test_an_unsupported_shader_warns_once_by_name() -> None:
    material, warnings = simple("ShaderNodeBsdfToon", Color=COLOR)
    np.testing.assert_allclose(material.base_color, COLOR[:3], rtol=1e-6)
    assert warnings == ('Toon BSDF shaders of material "cube" are drawn as the nearest plain surface.',)


def test_mixed_and_added_shaders() -> None:
    cube = add("cube")
    tree, (mix, diffuse, glossy) = new_material(
        cube, "ShaderNodeMixShader", "ShaderNodeBsdfDiffuse", "ShaderNodeBsdfGlossy"
    )
    tree.links.new(diffuse.outputs[0], mix.inputs[1])
    tree.links.new(glossy.outputs[0], mix.inputs[2])
    mix.inputs["Fac"].default_value = 1.0
    scene = extracted()
    assert material_of(scene, "cube").glossy_only and not scene.warnings
    mix.inputs["Fac"].default_value = 0.25
    scene = extracted()
    assert material_of(scene, "cube").varies("kind") and not scene.warnings
    both = node(tree, "ShaderNodeAddShader")
    emission = node(tree, "ShaderNodeEmission", {"Color": OTHER, "Strength": 1.0})
    tree.links.new(emission.outputs[0], both.inputs[0])
    tree.links.new(diffuse.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    scene = extracted()
    np.testing.assert_allclose(material_of(scene, "cube").emission, OTHER[:3], rtol=1e-6)
    assert material_of(scene, "cube").base_color != (0.0, 0.0, 0.0) and not scene.warnings
