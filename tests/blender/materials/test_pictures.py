# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures in pictures, seen directly and in mirrors, beside those of Cycles; a world's image that is too large."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.lighting import lighting
from curvrefl.curvrefl_addon.renderer.lighting.left_out import INDIRECT
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
    assert set(frame.warnings) <= {INDIRECT}
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
    assert set(frame.warnings) <= {INDIRECT}
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
    assert set(whole.warnings) <= {INDIRECT}
    monkeypatch.setattr(lighting, "largest_texture", lambda: 64)
    smaller = picture_of()
    assert tuple(warning for warning in smaller.warnings if warning != INDIRECT) == (
        "Fewer pixels of the world's image are drawn than there are: as many as the graphics driver takes.",
    )
    assert np.abs(smaller.color() - whole.color()).max() < 0.03
