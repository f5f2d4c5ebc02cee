# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors that nodes make of constants and of images, against what Cycles shows of them."""

from __future__ import annotations

import itertools
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.materials.node_formulas import BLENDS, NUMBER_OPERATIONS, VECTOR_OPERATIONS
from extraction import add_square, cycles_picture, empty_scene, extracted, look_down, material_of, new_material
from scene.color_nodes import COLOR, OTHER, BuildColor, Tree, mix, node, smooth_image


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
        np.testing.assert_allclose(
            material_of(scene, name).emission, picture[index], rtol=2e-3, atol=2e-3, err_msg=name
        )


def packed_channels() -> tuple[bpy.types.Image, np.ndarray]:
    """An image like glTF's occlusion, roughness and metallic, as bytes without a color space; and its means."""
    generator = np.random.default_rng(1)
    values = np.ones((16, 16, 4), np.float32)
    values[..., 0] = generator.uniform(0.6, 1.0, (16, 16))
    values[..., 1] = generator.uniform(0.2, 0.8, (16, 16))
    values[..., 2] = generator.uniform(0.0, 0.1, (16, 16)) ** 2
    image = bpy.data.images.new("packed", 16, 16)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(values.reshape(-1))
    return image, np.rint(values * 255.0) / 255.0


@pytest.mark.parametrize("kind", ["ShaderNodeSeparateColor", "ShaderNodeSeparateXYZ"])
def test_metallic_and_roughness_are_their_own_channels_means(kind: str) -> None:
    tree, (shader,) = new_material(add_square(), "ShaderNodeBsdfPrincipled")
    image, values = packed_channels()
    channels = node(tree, kind, {0: node(tree, "ShaderNodeTexImage", image=image).outputs["Color"]})
    tree.links.new(channels.outputs[1], shader.inputs["Roughness"])
    tree.links.new(channels.outputs[2], shader.inputs["Metallic"])
    scene = extracted()
    material = material_of(scene, "square")
    np.testing.assert_allclose(material.roughness, values[..., 1].mean(), rtol=1e-5)
    np.testing.assert_allclose(material.metallic, values[..., 2].mean(), rtol=1e-5, atol=1e-7)
    assert set(scene.warnings) == {
        'Roughness of material "square" is shown as its mean.',
        'Metallic of material "square" is shown as its mean.',
    }
    assert not scene.images


def test_means_are_of_what_nodes_make_of_a_channel() -> None:
    """Roughness = 1 - gloss ** 2, the mean of that and not that of the mean."""
    tree, (shader,) = new_material(add_square(), "ShaderNodeBsdfPrincipled")
    image, values = packed_channels()
    channels = node(tree, "ShaderNodeSeparateColor", {0: node(tree, "ShaderNodeTexImage", image=image).outputs[0]})
    square = node(tree, "ShaderNodeMath", {0: channels.outputs[1], 1: channels.outputs[1]}, operation="MULTIPLY")
    rest = node(tree, "ShaderNodeMath", {0: 1.0, 1: square.outputs[0]}, operation="SUBTRACT")
    low = node(tree, "ShaderNodeMapRange", {"Value": rest.outputs[0], "To Max": 0.5})
    tree.links.new(low.outputs[0], shader.inputs["Roughness"])
    expected = 0.5 * (1.0 - values[..., 1] ** 2).mean()
    assert material_of(extracted(), "square").roughness == pytest.approx(expected, rel=1e-5)


def test_a_mask_between_two_images_of_one_map() -> None:
    """One texture is made of all three, of as many pixels as the largest has."""
    tree, (shader,) = new_material(add_square(), "ShaderNodeBsdfPrincipled")
    mask, values = packed_channels()
    factor = node(tree, "ShaderNodeSeparateColor", {0: node(tree, "ShaderNodeTexImage", image=mask).outputs[0]})
    inputs = {
        "Factor_Float": factor.outputs[1],
        "A_Color": node(tree, "ShaderNodeTexImage", image=smooth_image()).outputs[0],
        "B_Color": OTHER,
    }
    mixed = node(tree, "ShaderNodeMix", inputs, data_type="RGBA")
    tree.links.new(mixed.outputs[2], shader.inputs["Base Color"])
    scene = extracted()
    assert not scene.warnings
    pixels = scene.images[material_of(scene, "square").image].pixels
    assert pixels.shape == (16, 16, 4)
    flat = np.array(smooth_image().pixels[:]).reshape(8, 16, 4)[..., :3]
    below = np.concatenate([flat[-1:], flat, flat[:1]])
    rows = (np.arange(16) + 0.5) / 2 + 0.5
    low = rows.astype(int)
    part = (rows - low)[:, None, None]
    stretched = below[low] * (1.0 - part) + below[low + 1] * part
    mix = values[..., 1:2] * np.array(OTHER[:3]) + (1.0 - values[..., 1:2]) * stretched
    np.testing.assert_allclose(pixels[..., :3], mix, atol=1e-5)
