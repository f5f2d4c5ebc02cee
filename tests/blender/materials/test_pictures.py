# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures in pictures, seen directly and in mirrors, beside those of Cycles; a world's image that is too large."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.lighting.programs import textures
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera
from extraction import add_square, cycles_picture, empty_scene, extracted, look_down, new_material
from scene.color_nodes import node, smooth_image

pytestmark = pytest.mark.usefixtures("gpu")

SIZE = 48


def world_of(radiance: float) -> None:
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (radiance, radiance, radiance, 1.0)


def matt(obj: bpy.types.Object, color: Any) -> None:
    """`color` makes the output of a color in a tree."""
    tree, (shader,) = new_material(obj, "ShaderNodeBsdfDiffuse")
    tree.links.new(color(tree), shader.inputs["Color"])


def turned_image(tree: bpy.types.NodeTree, extension: str = "REPEAT") -> Any:
    uv = node(tree, "ShaderNodeTexCoord").outputs["UV"]
    inputs = {"Vector": uv, "Rotation": (0.0, 0.0, 0.7), "Scale": (1.4, 0.6, 1.0), "Location": (0.1, -0.3, 0.0)}
    mapping = node(tree, "ShaderNodeMapping", inputs)
    image = smooth_image()
    return node(tree, "ShaderNodeTexImage", {"Vector": mapping.outputs[0]}, image=image, extension=extension).outputs[0]


def picture_of(*mirrors: bpy.types.Object, method: str = "exact") -> Frame:
    scene = bpy.context.scene
    view = view_of_camera(scene, scene.camera, SIZE, SIZE)
    return Renderer(extracted(*mirrors), Settings(method=method, samples=16)).render(view)


@pytest.mark.parametrize("extension", ["REPEAT", "MIRROR", "CLIP"])
def test_a_turned_image_is_that_of_cycles(extension: str) -> None:
    empty_scene()
    world_of(1.0)
    matt(add_square(size=2.0), lambda tree: turned_image(tree, extension))
    look_down(1.8)
    frame = picture_of()
    assert not frame.warnings
    error = np.abs(frame.color()[..., :3] - cycles_picture(SIZE, SIZE, 64)).max(axis=-1)
    # (Where an image ends there is an edge.)
    assert np.quantile(error, 0.9) < 0.02
    assert np.median(error) < 0.006


@pytest.mark.parametrize("method", ["exact", "newton"])
def test_a_turned_image_in_a_mirror_is_that_of_cycles(method: str) -> None:
    """Seen in the ball alone: above it, behind the camera."""
    empty_scene()
    world_of(0.7)
    above = add_square("above", 12.0)
    above.location.z = 6.0
    above.rotation_euler.x = np.pi
    matt(above, turned_image)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48)
    ball = bpy.context.object
    bpy.ops.object.shade_smooth()
    _, (chrome,) = new_material(ball, "ShaderNodeBsdfGlossy")
    chrome.inputs["Roughness"].default_value = 0.0
    look_down(2.2)
    frame = picture_of(ball, method=method)
    inside = frame.mask() > 0
    error = np.abs(frame.color()[..., :3] - cycles_picture(SIZE, SIZE, 64)).max(axis=-1)[inside]
    assert inside.sum() > 1000
    assert np.quantile(error, 0.85) < 0.03
    assert np.median(error) < 0.01


def test_a_missing_attribute_and_missing_coordinates_are_those_of_cycles() -> None:
    """Black, and the pixel in the corner of the image."""
    empty_scene()
    world_of(1.0)
    pairs = {"gone": ("ShaderNodeAttribute", {}), "flat": ("ShaderNodeTexImage", {"image": smooth_image()})}
    for index, (name, (kind, properties)) in enumerate(pairs.items()):
        square = add_square(name, 1.0)
        square.location.x = index - 0.5
        square.data.uv_layers.remove(square.data.uv_layers[0])
        if kind == "ShaderNodeAttribute":
            properties = {"attribute_name": "gone"}

        def color(tree: bpy.types.NodeTree, kind: str = kind, properties: dict[str, Any] = properties) -> Any:
            return node(tree, kind, **properties).outputs["Color"]

        matt(square, color)
    look_down(2.0)
    frame = picture_of()
    assert not frame.warnings
    ours, cycles = frame.color()[..., :3], cycles_picture(SIZE, SIZE, 64)
    for column in (12, 36):
        np.testing.assert_allclose(ours[24, column], cycles[24, column], atol=0.02)
    assert ours[24, 12].max() < 1e-4 < ours[24, 36].min()


def test_an_image_beyond_the_largest_texture_is_made_smaller(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the world, which surfaces do not mind: nearly the same picture, and a sentence."""
    scene = empty_scene()
    square = add_square(size=1.0)
    image = bpy.data.images.new("wide", 96, 16, float_buffer=True)
    x = (np.arange(96, dtype=np.float32) + 0.5) / 96
    pixels = np.ones((16, 96, 4), np.float32)
    pixels[..., :3] = (0.5 + 0.4 * np.sin(2.0 * np.pi * x))[:, None]
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    matt(square, lambda tree: node(tree, "ShaderNodeTexImage", image=image).outputs["Color"])
    tree = scene.world.node_tree
    sky = node(tree, "ShaderNodeTexEnvironment", image=image)
    tree.links.new(sky.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    look_down(2.0)
    whole = picture_of()
    assert not whole.warnings
    monkeypatch.setattr(textures, "largest_texture", lambda: 64)
    smaller = picture_of()
    assert smaller.warnings == (
        "Fewer pixels of the world's image are drawn than there are: as many as the graphics driver takes.",
    )
    assert np.abs(smaller.color() - whole.color()).max() < 0.03


def diffuse(tree: bpy.types.NodeTree, *color: float) -> Any:
    return node(tree, "ShaderNodeBsdfDiffuse", {"Color": (*color, 1.0)}).outputs[0]


def shine(tree: bpy.types.NodeTree, *color: float) -> Any:
    return node(tree, "ShaderNodeEmission", {"Color": (*color, 1.0)}).outputs[0]


def mixed(tree: bpy.types.NodeTree, share: Any, first: Any, second: Any) -> Any:
    return node(tree, "ShaderNodeMixShader", {"Fac": share, 1: first, 2: second}).outputs[0]


def added(tree: bpy.types.NodeTree, first: Any, second: Any) -> Any:
    return node(tree, "ShaderNodeAddShader", {0: first, 1: second}).outputs[0]


def glossy(tree: bpy.types.NodeTree) -> Any:
    return node(tree, "ShaderNodeBsdfAnisotropic", {"Color": (0.9, 0.5, 0.2, 1.0), "Roughness": 0.4}).outputs[0]


def pane(tree: bpy.types.NodeTree) -> Any:
    return node(tree, "ShaderNodeBsdfTransparent", {"Color": (0.9, 0.6, 0.3, 1.0)}).outputs[0]


MIXES = {
    "two of one kind": lambda tree: mixed(tree, 0.3, diffuse(tree, 0.8, 0.1, 0.1), diffuse(tree, 0.1, 0.8, 0.1)),
    "gloss and none": lambda tree: mixed(tree, 0.3, diffuse(tree, 0.8, 0.1, 0.1), glossy(tree)),
    "nested": lambda tree: mixed(
        tree, 0.6, mixed(tree, 0.5, diffuse(tree, 0.1, 0.1, 0.9), glossy(tree)), shine(tree, 0.2, 0.5, 0.1)
    ),
    "gloss and a sum": lambda tree: added(tree, glossy(tree), diffuse(tree, 0.2, 0.3, 0.1)),
    "a pane that shines": lambda tree: added(tree, pane(tree), shine(tree, 0.1, 0.2, 0.4)),
    "a pane in part": lambda tree: mixed(tree, 0.4, pane(tree), diffuse(tree, 0.2, 0.8, 0.4)),
}


def squares_of(mixes: Mapping[str, Any]) -> None:
    """In a row above a floor, under an even sky."""
    empty_scene()
    world_of(0.6)
    floor = add_square("floor", 20.0)
    floor.location.z = -1.0
    tree, (shader,) = new_material(floor, "ShaderNodeEmission")
    shader.inputs["Color"].default_value = (0.3, 0.5, 0.7, 1.0)
    for index, (name, build) in enumerate(mixes.items()):
        square = add_square(name, 0.9)
        square.location.x = index - 0.5 * (len(mixes) - 1)
        tree, _ = new_material(square, "ShaderNodeEmission")
        tree.links.new(build(tree), tree.nodes["Material Output"].inputs["Surface"])


def test_mixed_shaders_are_those_of_cycles_in_the_mean() -> None:
    squares_of(MIXES)
    look_down(len(MIXES))
    scene, size = bpy.context.scene, 10 * len(MIXES)
    view = view_of_camera(scene, scene.camera, size, 10)
    frame = Renderer(extracted(), Settings(method="exact", samples=64)).render(view)
    known = ("Shadows", "Rough gloss")
    assert not [warning for warning in frame.warnings if "material" in warning and not warning.startswith(known)]
    ours, cycles = frame.color()[..., :3], cycles_picture(size, 10, 256)
    for index, name in enumerate(MIXES):
        inside = (slice(2, 8), slice(10 * index + 2, 10 * index + 8))
        means = [picture[inside].mean(axis=(0, 1)) for picture in (ours, cycles)]
        # (Of a sum the gloss is a little too bright.)
        np.testing.assert_allclose(*means, atol=0.02 if name == "gloss and a sum" else 0.015, err_msg=name)
