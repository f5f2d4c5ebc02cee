# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of roughness, metallic, transmission and alpha, and how they follow changes."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from channels import channel_on
from curvrefl.curvrefl_addon.scene.changes import Changes
from curvrefl.curvrefl_addon.scene.extract import SceneReader
from extraction import add_square, empty_scene, extracted, material_of, new_material
from scene.color_nodes import Tree, node


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def noisy(name: str, size: int = 8, seed: int = 1) -> bpy.types.Image:
    """(size, size) pixels, no colors."""
    values = np.random.default_rng(seed).uniform(0.1, 0.9, (size, size, 4)).astype(np.float32)
    image = bpy.data.images.new(name, size, size, alpha=True, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(values.reshape(-1))
    image.update()
    return image


def texture(tree: Tree, image: bpy.types.Image, scale: float = 1.0, uv_map: str = "", **properties: Any) -> Any:
    place = node(tree, "ShaderNodeUVMap", uv_map=uv_map).outputs[0]
    mapping = node(tree, "ShaderNodeMapping", {"Vector": place, "Scale": (scale, scale, 1.0)})
    return node(tree, "ShaderNodeTexImage", {"Vector": mapping.outputs[0]}, image=image, **properties)


def plastic(name: str = "square") -> tuple[bpy.types.Object, Tree, Any]:
    square = add_square(name)
    tree, (shader,) = new_material(square, "ShaderNodeBsdfPrincipled")
    return square, tree, shader


def packed(tree: Tree, shader: Any, image: bpy.types.Image, scale: float = 1.0) -> None:
    """As glTF has them: roughness in green, metallic in blue."""
    channels = node(tree, "ShaderNodeSeparateColor", {0: texture(tree, image, scale).outputs["Color"]})
    tree.links.new(channels.outputs[1], shader.inputs["Roughness"])
    tree.links.new(channels.outputs[2], shader.inputs["Metallic"])


def test_a_packed_image_is_drawn_of_mirrors_and_of_scenery() -> None:
    square, tree, shader = plastic()
    packed(tree, shader, noisy("packed"), 3.0)
    for scene in (extracted(square), extracted()):
        material = material_of(scene, "square")
        assert material.varies("roughness") and material.varies("metallic") and not material.is_seen_through
        assert material.range_of("roughness") == (0.0, 1.0)
        assert not [warning for warning in scene.warnings if "material" in warning]


@pytest.mark.usefixtures("gpu")
def test_images_may_lie_on_several_maps() -> None:
    square, tree, shader = plastic()
    other = square.data.uv_layers.new(name="other")
    other.uv.foreach_set("vector", [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0])
    image = noisy("image")
    for uv_map, name in (("UVMap", "Roughness"), ("other", "Metallic")):
        channels = node(tree, "ShaderNodeSeparateColor", {0: texture(tree, image, uv_map=uv_map).outputs[0]})
        tree.links.new(channels.outputs[1], shader.inputs[name])
    scene = extracted()
    assert not [warning for warning in scene.warnings if "material" in warning]
    one = channel_on(scene, "square", "roughness", [(0.3, -0.6), (0.1, 0.7)])
    # (Across its diagonal the other map is the same.)
    np.testing.assert_allclose(channel_on(scene, "square", "metallic", [(-0.6, 0.3), (0.7, 0.1)]), one, atol=1e-5)


@pytest.mark.usefixtures("gpu")
def test_values_beyond_their_range_are_limited() -> None:
    _, tree, shader = plastic()
    channels = node(tree, "ShaderNodeSeparateColor", {0: texture(tree, noisy("rough")).outputs["Color"]})
    wide = node(tree, "ShaderNodeMath", {0: channels.outputs[1], 1: 4.0, 2: -1.0}, operation="MULTIPLY_ADD")
    tree.links.new(wide.outputs[0], shader.inputs["Roughness"])
    tree.links.new(channels.outputs[1], shader.inputs["Metallic"])
    scene = extracted()
    places = np.random.default_rng(1).uniform(-1.0, 1.0, (64, 2))
    plain, found = (channel_on(scene, "square", name, places) for name in ("metallic", "roughness"))
    np.testing.assert_allclose(found, np.clip(4.0 * plain - 1.0, 0.0, 1.0), atol=1e-5)


def test_vertex_colors_as_alpha() -> None:
    square, tree, shader = plastic()
    square.data.color_attributes.new("paint", "FLOAT_COLOR", "CORNER")
    paint = node(tree, "ShaderNodeVertexColor", layer_name="paint")
    tree.links.new(paint.outputs["Alpha"], shader.inputs["Alpha"])
    scene = extracted()
    assert not scene.warnings and material_of(scene, "square").is_seen_through


class Viewport:
    """Reads again what changed, as a 3D view does."""

    def __init__(self, mirror: bpy.types.Object) -> None:
        self.mirrors = [mirror]
        self.reader = SceneReader()
        self.read(Changes(everything=True))

    def read(self, changes: Changes) -> None:
        bpy.context.view_layer.update()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        self.scene = self.reader.read(depsgraph, bpy.context.scene, self.mirrors, changes)


def test_images_stay_where_materials_change() -> None:
    square, tree, shader = plastic()
    image = noisy("packed")
    packed(tree, shader, image)
    material = square.data.materials[0]
    viewport = Viewport(square)
    before, program = viewport.scene.images, material_of(viewport.scene, "square").program
    shader.inputs["Coat Weight"].default_value = 0.5
    viewport.read(Changes(materials={material.session_uid}))
    after = material_of(viewport.scene, "square")
    assert after.coat_weight == 0.5 and viewport.scene.images is before
    assert after.program is not None and program is not None and after.program.shape == program.shape
    image.pixels.foreach_set(np.full(256, 0.75, np.float32))
    image.update()
    viewport.read(Changes(images={image.session_uid}))
    assert len(viewport.scene.images) == 1 and viewport.scene.images[0] is not before[0]


def test_materials_that_are_gone_ask_for_no_images() -> None:
    square, tree, shader = plastic()
    packed(tree, shader, noisy("packed"))
    viewport = Viewport(square)
    tree, (plain,) = new_material(square, "ShaderNodeBsdfDiffuse")
    tree.links.new(texture(tree, noisy("color")).outputs[0], plain.inputs["Color"])
    square.data.materials.pop(index=0)
    viewport.read(Changes(everything=True))
    used = {use.image for item in viewport.scene.materials if item.program for use in item.program.images}
    assert used == {0} and len(viewport.scene.images) == 1


def test_one_image_serves_all_materials_that_have_the_same() -> None:
    image = noisy("packed")
    squares = []
    for name in ("one", "two"):
        square, tree, shader = plastic(name)
        packed(tree, shader, image)
        squares.append(square)
    assert len(extracted(*squares).images) == 1
