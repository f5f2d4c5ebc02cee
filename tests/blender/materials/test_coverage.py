# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Alpha, its thresholds, and mixes with transparent shaders: as read, against what Cycles shows of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from channels import channel_on
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.scene.arrays import Float32Array, MaterialArrays, SceneArrays
from extraction import add_square, cycles_picture, empty_scene, extracted, look_down, material_of, new_material
from scene.color_nodes import COLOR, OTHER, Tree, node

BEHIND = np.array((0.3, 0.6, 0.9))
SIZE = 96

type Build = Callable[[Tree], Any]
"""Makes nodes; returns the output with the shader, or with an alpha"""


pytestmark = pytest.mark.usefixtures("gpu")


@pytest.fixture(autouse=True)
def _scene() -> None:
    """A floor that shines, far below."""
    empty_scene()
    floor = add_square("floor", 40.0)
    floor.location.z = -1.0
    _, (shine,) = new_material(floor, "ShaderNodeEmission")
    shine.inputs["Color"].default_value = (*BEHIND, 1.0)


def shine(tree: Tree, color: Any = COLOR, strength: float = 1.0) -> Any:
    return node(tree, "ShaderNodeEmission", {"Color": color, "Strength": strength}).outputs[0]


def clear(tree: Tree, color: Any = (1.0, 1.0, 1.0, 1.0)) -> Any:
    return node(tree, "ShaderNodeBsdfTransparent", {"Color": color}).outputs[0]


def mixed(tree: Tree, factor: Any, first: Any, second: Any) -> Any:
    return node(tree, "ShaderNodeMixShader", {"Fac": factor, 1: first, 2: second}).outputs[0]


def principled(tree: Tree, alpha: Any) -> Any:
    """That only shines."""
    inputs = {"Base Color": (0.0, 0.0, 0.0, 1.0), "Specular IOR Level": 0.0, "Emission Color": COLOR}
    return node(tree, "ShaderNodeBsdfPrincipled", {**inputs, "Emission Strength": 1.0, "Alpha": alpha}).outputs[0]


def math(tree: Tree, operation: str, a: Any, b: Any = 0.0) -> Any:
    return node(tree, "ShaderNodeMath", {0: a, 1: b}, operation=operation).outputs[0]


CONSTANT: dict[str, Build] = {
    "alpha": lambda tree: principled(tree, 0.25),
    "alpha of nodes": lambda tree: principled(tree, math(tree, "MULTIPLY", 0.5, 0.5)),
    "transparent and another": lambda tree: mixed(tree, 0.25, clear(tree), shine(tree)),
    "another and transparent": lambda tree: mixed(tree, 0.25, shine(tree), clear(tree)),
    "tinted": lambda tree: mixed(tree, 0.25, clear(tree, OTHER), shine(tree)),
    "tinted alone": lambda tree: clear(tree, OTHER),
    "black alone": lambda tree: clear(tree, (0.0, 0.0, 0.0, 1.0)),
    "tinted twice": lambda tree: mixed(tree, 0.25, clear(tree, OTHER), clear(tree)),
    "nested": lambda tree: mixed(tree, 0.5, clear(tree), mixed(tree, 0.75, clear(tree, OTHER), shine(tree))),
    "nested with alpha": lambda tree: mixed(tree, 0.5, principled(tree, 0.5), clear(tree, OTHER)),
    "added light": lambda tree: node(
        tree, "ShaderNodeAddShader", {0: mixed(tree, 0.25, clear(tree), shine(tree)), 1: shine(tree, OTHER)}
    ).outputs[0],
    "two that shine": lambda tree: mixed(tree, 0.25, shine(tree), shine(tree, OTHER, 2.0)),
    "beyond 1": lambda tree: principled(tree, math(tree, "ADD", 0.75, 0.75)),
    "a threshold of a constant": lambda tree: principled(tree, math(tree, "GREATER_THAN", 0.5, 0.25)),
    "a shadow trick": lambda tree: mixed(
        tree, node(tree, "ShaderNodeLightPath").outputs["Is Shadow Ray"], shine(tree), clear(tree)
    ),
}


def seen(material: MaterialArrays) -> Any:
    """(3,) what a surface of constants that shines shows above the floor."""
    share = material.alpha
    return share * np.array(material.emission) + (1.0 - share) * np.array(material.transparent_tint) * BEHIND


def test_constants_show_what_cycles_shows() -> None:
    """One square per kind, in one picture of a pixel each."""
    for index, (name, build) in enumerate(CONSTANT.items()):
        square = add_square(name, 1.0)
        square.location = (index - 0.5 * (len(CONSTANT) - 1), 0.0, 0.0)
        tree, _ = new_material(square, "ShaderNodeEmission")
        tree.links.new(build(tree), tree.nodes["Material Output"].inputs["Surface"])
    look_down(len(CONSTANT))
    scene = extracted()
    picture = cycles_picture(5 * len(CONSTANT), 5, 64)[2, 2::5]
    for index, name in enumerate(CONSTANT):
        np.testing.assert_allclose(seen(material_of(scene, name)), picture[index], atol=2e-3, err_msg=name)
    assert all("Light Path" in warning and '"a shadow trick"' in warning for warning in scene.warnings)


def test_full_transparency_is_no_surface() -> None:
    for build in (
        lambda tree: principled(tree, math(tree, "SUBTRACT", 0.25, 1.0)),
        lambda tree: mixed(tree, 0.5, clear(tree), principled(tree, 0.0)),
    ):
        square = add_square("square", 1.0)
        tree, _ = new_material(square, "ShaderNodeEmission")
        tree.links.new(build(tree), tree.nodes["Material Output"].inputs["Surface"])
    assert [instance.object_name for instance in extracted().instances] == ["floor"]


def test_opaque_shadows_of_what_is_transparent_are_said() -> None:
    square = add_square("square", 1.0)
    tree, _ = new_material(square, "ShaderNodeEmission")
    tree.links.new(principled(tree, 0.5), tree.nodes["Material Output"].inputs["Surface"])
    square.data.materials[0].use_transparent_shadow = False
    said = 'Shadows of material "square" let light through, though its settings turn that off.'
    assert extracted().warnings == (said,)


def test_diffuse_surfaces_are_mixed_by_images() -> None:
    tree, _ = new_material(add_square("square", 1.0), "ShaderNodeEmission")
    both = [node(tree, "ShaderNodeBsdfDiffuse", {"Color": color}).outputs[0] for color in (COLOR, OTHER)]
    shader = mixed(tree, alpha_of(tree), *both)
    tree.links.new(shader, tree.nodes["Material Output"].inputs["Surface"])
    scene = extracted()
    material = material_of(scene, "square")
    assert material.specular_level == 0.0 and not scene.warnings
    share = pixels_of(bpy.data.images["leaf"])[..., 3:]
    expected = (1.0 - share) * np.array(COLOR[:3]) + share * np.array(OTHER[:3])
    np.testing.assert_allclose(on_square(scene, "base_color", 16), expected, atol=5e-3)


def pixels_of(image: bpy.types.Image) -> Float32Array:
    """(h, w, 4)"""
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], 4)


def on_square(scene: SceneArrays, of: str, size: int = SIZE) -> Float32Array:
    """(size, size, 3) a channel in the middles of pixels, of a square that fills the picture."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size - 0.5
    return channel_on(scene, "square", of, np.column_stack([x.ravel(), y.ravel()])).reshape(size, size, 3)


def leaf_image(float_buffer: bool = False) -> bpy.types.Image:
    """16 x 16 pixels of smooth alpha, without color."""
    y, x = np.mgrid[0:16, 0:16] / 15.0
    pixels = np.ones((16, 16, 4), np.float32)
    pixels[..., 3] = 0.5 + 0.5 * np.sin(7.0 * x + 2.0 * y) * np.cos(5.0 * y - x)
    image = bpy.data.images.new("leaf", 16, 16, alpha=True, float_buffer=float_buffer)
    image.alpha_mode = "CHANNEL_PACKED"
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    return image


def leaf(tree: Tree, **properties: Any) -> Any:
    uv = node(tree, "ShaderNodeUVMap")
    return node(tree, "ShaderNodeTexImage", {"Vector": uv.outputs[0]}, image=leaf_image(), **properties)


def alpha_of(tree: Tree, **properties: Any) -> Any:
    return leaf(tree, **properties).outputs["Alpha"]


CLIPPED: dict[str, Build] = {
    "greater": lambda tree: math(tree, "GREATER_THAN", alpha_of(tree), 0.4),
    "less": lambda tree: math(tree, "LESS_THAN", alpha_of(tree), 0.4),
    "round": lambda tree: math(tree, "ROUND", alpha_of(tree)),
    "as of glTF": lambda tree: math(
        tree, "SUBTRACT", 1.0, math(tree, "LESS_THAN", math(tree, "MULTIPLY", alpha_of(tree), 0.75), 0.4)
    ),
    "the other way round": lambda tree: math(tree, "LESS_THAN", 0.4, alpha_of(tree)),
}


def shown(scene: SceneArrays) -> Any:
    """(SIZE, SIZE, 3) what a square that shines shows above the floor."""
    alpha, emission, tint = (on_square(scene, of) for of in ("alpha", "emission", "transparent_tint"))
    return alpha * emission + (1.0 - alpha) * tint * BEHIND


def in_middles_of_pixels() -> Float32Array:
    """(SIZE, SIZE, 3) one sample of each pixel, in its middle."""
    scene = bpy.context.scene
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
    still = render_reference(scene, bpy.context.view_layer, SIZE, SIZE, 1, "full")
    return np.asarray(still.pixels)[..., :3]


def square_of(build: Build) -> Tree:
    """One that fills the picture; `build` makes its alpha."""
    tree, _ = new_material(add_square("square", 1.0), "ShaderNodeEmission")
    shader = principled(tree, build(tree))
    tree.links.new(shader, tree.nodes["Material Output"].inputs["Surface"])
    look_down(1.0)
    return tree


@pytest.mark.parametrize("name", CLIPPED)
def test_thresholds_come_after_interpolation(name: str) -> None:
    square_of(CLIPPED[name])
    scene = extracted()
    assert material_of(scene, "square").is_seen_through and not scene.warnings
    there = on_square(scene, "alpha")
    assert set(np.unique(there)) == {0.0, 1.0} and 0.2 < there.mean() < 0.8
    wrong = np.abs(shown(scene) - in_middles_of_pixels()).max(axis=-1) > 0.01
    # (Cycles' images have positions in steps of 1/256 of a pixel.)
    assert wrong.mean() < 3e-3


def test_alpha_of_an_image_beside_its_color() -> None:
    """Both out of one node; alpha is as smooth as in Cycles, its color is read as where alpha is used."""
    tree = square_of(alpha_of)
    texture = next(item for item in tree.nodes if item.type == "TEX_IMAGE")
    shader = next(item for item in tree.nodes if item.type == "BSDF_PRINCIPLED")
    tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    scene = extracted()
    material = material_of(scene, "square")
    assert material.varies("alpha") and material.varies("base_color") and not scene.warnings
    bpy.context.scene.cycles.filter_width = 0.01
    still = render_reference(bpy.context.scene, bpy.context.view_layer, SIZE, SIZE, 256, "full")
    cycles = np.asarray(still.pixels)[..., :3]
    blocks = (SIZE // 8, 8, SIZE // 8, 8, 3)
    # (The mean of blocks: whether a ray goes on is up to chance in Cycles.)
    np.testing.assert_allclose(
        shown(scene).reshape(blocks).mean(axis=(1, 3)), cycles.reshape(blocks).mean(axis=(1, 3)), atol=0.02
    )


def test_images_as_mix_factors() -> None:
    tree, _ = new_material(add_square("square", 1.0), "ShaderNodeEmission")
    factor = math(tree, "GREATER_THAN", alpha_of(tree), 0.4)
    shader = mixed(tree, factor, shine(tree), clear(tree, OTHER))
    tree.links.new(shader, tree.nodes["Material Output"].inputs["Surface"])
    look_down(1.0)
    scene = extracted()
    assert not scene.warnings
    wrong = np.abs(shown(scene) - in_middles_of_pixels()).max(axis=-1) > 0.01
    assert wrong.mean() < 3e-3


def test_products_of_alpha() -> None:
    tree, _ = new_material(add_square("square", 1.0), "ShaderNodeEmission")
    inner = principled(tree, math(tree, "GREATER_THAN", alpha_of(tree), 0.4))
    shader = mixed(tree, 0.5, clear(tree), inner)
    tree.links.new(shader, tree.nodes["Material Output"].inputs["Surface"])
    scene = extracted()
    assert not scene.warnings
    assert set(np.unique(on_square(scene, "alpha"))) == {0.0, 0.5}


def test_tints_that_differ_are_said() -> None:
    tree, _ = new_material(add_square("square", 1.0), "ShaderNodeEmission")
    shader = mixed(tree, alpha_of(tree), clear(tree, OTHER), principled(tree, 0.5))
    tree.links.new(shader, tree.nodes["Material Output"].inputs["Surface"])
    (sentence,) = extracted().warnings
    assert sentence == 'The tint of transparency of material "square" differs from place to place and is drawn as one.'


def test_images_without_holes_make_nothing_transparent() -> None:
    image = bpy.data.images.new("solid", 8, 8)
    for build in (
        lambda tree: node(tree, "ShaderNodeTexImage", image=image).outputs["Alpha"],
        lambda tree: math(tree, "GREATER_THAN", node(tree, "ShaderNodeTexImage", image=image).outputs["Alpha"], 0.5),
        lambda tree: math(tree, "GREATER_THAN", alpha_of(tree), -0.5),
        lambda tree: math(tree, "LESS_THAN", alpha_of(tree), 1.5),
    ):
        square_of(build)
    scene = extracted()
    found = [scene.materials[index] for instance in scene.instances for index in instance.materials]
    assert not any(material.is_seen_through or material.program for material in found) and not scene.warnings


def test_an_image_that_ends_is_not_there_beyond_it() -> None:
    """Where an image is clipped its alpha is 0, and what nodes make of that."""

    def inverted(tree: Tree) -> Any:
        mapping = node(tree, "ShaderNodeMapping", {"Vector": node(tree, "ShaderNodeUVMap").outputs[0]})
        mapping.inputs["Scale"].default_value = (2.0, 2.0, 1.0)
        texture = leaf(tree, extension="CLIP")
        tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
        return math(tree, "GREATER_THAN", math(tree, "SUBTRACT", 1.0, texture.outputs["Alpha"]), 0.4)

    square_of(inverted)
    scene = extracted()
    there = on_square(scene, "alpha")
    assert there[: SIZE // 2, SIZE // 2 + 2 :].all() and not there.all()
    wrong = np.abs(shown(scene) - in_middles_of_pixels()).max(axis=-1) > 0.01
    assert wrong.mean() < 5e-3
