# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of roughness, metallic, transmission and alpha, packed into one for mirrors and what is seen through."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.arrays import Float32Array, SceneArrays
from curvrefl.curvrefl_addon.scene.changes import Changes
from curvrefl.curvrefl_addon.scene.extract import SceneReader
from extraction import add_square, empty_scene, extracted, material_of, mesh_of, new_material
from scene.color_nodes import Tree, node

MEANS = (
    'Roughness of material "square" is shown as its mean.',
    'Metallic of material "square" is shown as its mean.',
)


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


def pixels_of(image: bpy.types.Image) -> Float32Array:
    width, height = image.size
    values = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, 4)


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


def scalars_of(scene: SceneArrays, name: str = "square") -> Float32Array:
    scalars = material_of(scene, name).scalars
    assert scalars is not None
    return scene.images[scalars.image].pixels


def test_a_mirror_has_gltfs_packed_image() -> None:
    square, tree, shader = plastic()
    image = noisy("packed")
    packed(tree, shader, image, 3.0)
    shader.inputs["Alpha"].default_value = 1.0
    scene = extracted(square)
    material = material_of(scene, "square")
    found, values = scalars_of(scene), pixels_of(image)
    np.testing.assert_allclose(found[..., :2], values[..., 1:3], rtol=1e-6)
    assert (found[..., 2] == 0.0).all() and (found[..., 3] == 1.0).all()
    assert material.scalars is not None and material.scalars.uv_scale == (3.0, 3.0)
    np.testing.assert_allclose((material.roughness, material.metallic), values[..., 1:3].mean(axis=(0, 1)), rtol=1e-5)
    assert not material.is_seen_through and mesh_of(scene, "square").corner_uv is not None
    assert not [warning for warning in scene.warnings if "mean" in warning]


def test_scenery_has_the_means_and_says_so() -> None:
    _, tree, shader = plastic()
    packed(tree, shader, noisy("packed"))
    scene = extracted()
    assert scene.warnings == MEANS and not scene.images
    assert material_of(scene, "square").scalars is None and mesh_of(scene, "square").corner_uv is None


def test_a_material_of_both_is_said_of_its_scenery_alone() -> None:
    """Whichever of the two comes first."""
    first, tree, shader = plastic()
    packed(tree, shader, noisy("packed"))
    second = add_square("second")
    second.data.materials.append(first.data.materials[0])
    for mirror in (first, second):
        scene = extracted(mirror)
        assert scalars_of(scene).shape == (8, 8, 4)
        assert mesh_of(scene, mirror.name).corner_uv is not None
        assert [warning for warning in scene.warnings if "mean" in warning] == list(MEANS)


def test_what_is_seen_through_has_them_too() -> None:
    """Images of several sizes lie on each other; what is everywhere the same is spread."""
    _, tree, shader = plastic()
    small, large = noisy("small", 4), noisy("large", 8, 2)
    tree.links.new(texture(tree, small).outputs["Alpha"], shader.inputs["Alpha"])
    tree.links.new(texture(tree, large).outputs["Color"], shader.inputs["Transmission Weight"])
    shader.inputs["Roughness"].default_value = 0.25
    scene = extracted()
    found = scalars_of(scene)
    assert found.shape == (8, 8, 4) and not scene.warnings
    np.testing.assert_allclose(found[..., 2], pixels_of(large)[..., :3] @ (0.2126, 0.7152, 0.0722), rtol=1e-3)
    assert (found[..., 0] == 0.25).all() and (found[..., 1] == 0.0).all()
    inner = pixels_of(small)[..., 3]
    # Between pixels as linear interpolation has it: a quarter of the way from one to the next.
    np.testing.assert_allclose(
        found[0, 1, 3], 0.5625 * inner[0, 0] + 0.1875 * (inner[0, 1] + inner[-1, 0]) + 0.0625 * inner[-1, 1], rtol=1e-5
    )


@pytest.mark.parametrize("other", ["scale", "interpolation", "extension"])
def test_what_does_not_lie_on_alpha_is_its_mean(other: str) -> None:
    _, tree, shader = plastic()
    tree.links.new(texture(tree, noisy("alpha")).outputs["Alpha"], shader.inputs["Alpha"])
    rough = noisy("rough", 8, 2)
    changes: dict[str, Any] = {
        "scale": {"scale": 2.0},
        "interpolation": {"interpolation": "Closest"},
        "extension": {"extension": "EXTEND"},
    }[other]
    channels = node(tree, "ShaderNodeSeparateColor", {0: texture(tree, rough, **changes).outputs["Color"]})
    tree.links.new(channels.outputs[1], shader.inputs["Roughness"])
    scene = extracted()
    np.testing.assert_allclose(scalars_of(scene)[..., 0], pixels_of(rough)[..., 1].mean(), rtol=1e-5)
    assert scene.warnings == MEANS[:1]


def test_another_uv_map_than_the_colors_is_said() -> None:
    square, tree, shader = plastic()
    square.data.uv_layers.new(name="other")
    color = texture(tree, noisy("color"), uv_map="UVMap")
    tree.links.new(color.outputs["Color"], shader.inputs["Base Color"])
    channels = node(tree, "ShaderNodeSeparateColor", {0: texture(tree, noisy("rough"), uv_map="other").outputs[0]})
    tree.links.new(channels.outputs[1], shader.inputs["Roughness"])
    scene = extracted(square)
    assert material_of(scene, "square").scalars is None
    assert [warning for warning in scene.warnings if "UV" in warning] == [
        'Roughness, metallic, transmission and alpha of material "square" are their means: '
        "they are on another UV map than its color."
    ]


def test_values_beyond_their_range_are_limited() -> None:
    square, tree, shader = plastic()
    image = noisy("rough")
    channels = node(tree, "ShaderNodeSeparateColor", {0: texture(tree, image).outputs["Color"]})
    wide = node(tree, "ShaderNodeMath", {0: channels.outputs[1], 1: 4.0, 2: -1.0}, operation="MULTIPLY_ADD")
    tree.links.new(wide.outputs[0], shader.inputs["Roughness"])
    expected = np.clip(4.0 * pixels_of(image)[..., 1] - 1.0, 0.0, 1.0)
    np.testing.assert_allclose(scalars_of(extracted(square))[..., 0], expected, atol=1e-6)


def test_vertex_colors_as_alpha_are_said() -> None:
    square, tree, shader = plastic()
    square.data.color_attributes.new("paint", "FLOAT_COLOR", "CORNER")
    paint = node(tree, "ShaderNodeVertexColor", layer_name="paint")
    tree.links.new(paint.outputs["Alpha"], shader.inputs["Alpha"])
    scene = extracted()
    assert scene.warnings == ('Vertex colors in the alpha of material "square" are left out.',)
    assert not material_of(scene, "square").is_seen_through


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


def test_scalars_follow_changes_and_stay_where_they_are_the_same() -> None:
    square, tree, shader = plastic()
    image = noisy("packed")
    packed(tree, shader, image)
    material = square.data.materials[0]
    viewport = Viewport(square)
    before, index = viewport.scene.images, material_of(viewport.scene, "square").scalars
    shader.inputs["Coat Weight"].default_value = 0.5
    viewport.read(Changes(materials={material.session_uid}))
    assert material_of(viewport.scene, "square").coat_weight == 0.5
    assert viewport.scene.images is before and material_of(viewport.scene, "square").scalars == index
    shader.inputs["Transmission Weight"].default_value = 0.5
    viewport.read(Changes(materials={material.session_uid}))
    assert (scalars_of(viewport.scene)[..., 2] == 0.5).all()
    image.pixels.foreach_set(np.full(256, 0.75, np.float32))
    image.update()
    viewport.read(Changes(images={image.session_uid}))
    # (The same everywhere now: no image.)
    found = material_of(viewport.scene, "square")
    assert found.scalars is None and (found.roughness, found.metallic) == (0.75, 0.75)


def test_images_of_others_are_not_put_in_their_place() -> None:
    square, tree, shader = plastic()
    packed(tree, shader, noisy("packed"))
    viewport = Viewport(square)
    kept = scalars_of(viewport.scene)
    other = add_square("other")
    other_tree, (diffuse,) = new_material(other, "ShaderNodeBsdfDiffuse")
    other_tree.links.new(texture(other_tree, noisy("color")).outputs[0], diffuse.inputs["Color"])
    viewport.read(Changes(listing=True, instances=True))
    assert scalars_of(viewport.scene) is kept and len(viewport.scene.images) == 2


def test_one_image_serves_all_materials_that_have_the_same() -> None:
    image = noisy("packed")
    squares = []
    for name in ("one", "two"):
        square, tree, shader = plastic(name)
        packed(tree, shader, image)
        squares.append(square)
    assert len(extracted(*squares).images) == 1
