# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures as read, against what Cycles shows of them."""

from __future__ import annotations

import math
from typing import Any

import bpy
import numpy as np
import pytest
from channels import channel_on
from extraction import add_square, cycles_picture, empty_scene, extracted, look_down, material_of, new_material
from scene.color_nodes import COLOR, OTHER, BuildColor, Tree, node, smooth_image

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def _mapped(kind: str, turn: float = 0.0) -> BuildColor:
    def build(tree: Tree) -> Any:
        uv = node(tree, "ShaderNodeTexCoord").outputs["UV"]
        inputs = {"Vector": uv, "Scale": (2.0, 0.5, 1.0), "Rotation": (0.0, 0.0, turn)}
        mapping = node(tree, "ShaderNodeMapping", inputs, vector_type=kind)
        if kind != "VECTOR":
            mapping.inputs["Location"].default_value = (0.3, 0.1, 0.0)
        return node(tree, "ShaderNodeTexImage", {"Vector": mapping.outputs[0]}, image=smooth_image()).outputs["Color"]

    return build


def _image(float_buffer: bool) -> BuildColor:
    return lambda tree: node(tree, "ShaderNodeTexImage", image=smooth_image(float_buffer=float_buffer)).outputs["Color"]


def _non_color(tree: Tree) -> Any:
    image = smooth_image(float_buffer=False)
    image.colorspace_settings.name = "Non-Color"
    return node(tree, "ShaderNodeTexImage", image=image).outputs["Color"]


def _checker(tree: Tree) -> Any:
    uv = node(tree, "ShaderNodeUVMap").outputs["UV"]
    inputs = {"Vector": uv, "Scale": 5.0, "Color1": COLOR, "Color2": OTHER}
    return node(tree, "ShaderNodeTexChecker", inputs).outputs["Color"]


def _changed(tree: Tree) -> Any:
    texture = node(tree, "ShaderNodeTexImage", image=smooth_image()).outputs["Color"]
    gamma = node(tree, "ShaderNodeGamma", {"Color": texture, "Gamma": 1.5}).outputs[0]
    inputs = {"Factor_Float": 1.0, "A_Color": gamma, "B_Color": OTHER}
    return node(tree, "ShaderNodeMix", inputs, data_type="RGBA", blend_type="MULTIPLY").outputs[2]


def _extended(tree: Tree) -> Any:
    uv = node(tree, "ShaderNodeTexCoord").outputs["UV"]
    mapping = node(tree, "ShaderNodeMapping", {"Vector": uv, "Scale": (1.5, 1.5, 1.0)})
    texture = node(tree, "ShaderNodeTexImage", {"Vector": mapping.outputs[0]}, image=smooth_image(), extension="EXTEND")
    return texture.outputs["Color"]


def _beyond(extension: str) -> BuildColor:
    def build(tree: Tree) -> Any:
        uv = node(tree, "ShaderNodeTexCoord").outputs["UV"]
        inputs = {"Vector": uv, "Scale": (2.5, 2.5, 1.0), "Location": (-0.8, -0.7, 0.0)}
        mapping = node(tree, "ShaderNodeMapping", inputs)
        image = smooth_image()
        return node(
            tree, "ShaderNodeTexImage", {"Vector": mapping.outputs[0]}, image=image, extension=extension
        ).outputs[0]

    return build


def _twice_mapped(tree: Tree) -> Any:
    """By nodes of two kinds, about all axes."""
    vector = node(tree, "ShaderNodeTexCoord").outputs["UV"]
    for kind, turn in (("POINT", (0.4, -0.3, 0.7)), ("TEXTURE", (0.2, 0.5, -1.1))):
        inputs = {"Vector": vector, "Rotation": turn, "Scale": (1.5, 0.8, 2.0)}
        vector = node(tree, "ShaderNodeMapping", inputs, vector_type=kind).outputs[0]
    return node(tree, "ShaderNodeTexImage", {"Vector": vector}, image=smooth_image()).outputs["Color"]


def _turned_checker(tree: Tree) -> Any:
    uv = node(tree, "ShaderNodeUVMap").outputs["UV"]
    mapping = node(tree, "ShaderNodeMapping", {"Vector": uv, "Rotation": (0.0, 0.0, 0.5)})
    inputs = {"Vector": mapping.outputs[0], "Scale": 5.0, "Color1": COLOR, "Color2": OTHER}
    return node(tree, "ShaderNodeTexChecker", inputs).outputs["Color"]


def _generated(tree: Tree) -> Any:
    place = node(tree, "ShaderNodeTexCoord").outputs["Generated"]
    return node(tree, "ShaderNodeTexImage", {"Vector": place}, image=smooth_image()).outputs["Color"]


def _object_space(tree: Tree) -> Any:
    place = node(tree, "ShaderNodeTexCoord").outputs["Object"]
    return node(tree, "ShaderNodeTexImage", {"Vector": place}, image=smooth_image()).outputs["Color"]


TEXTURES: dict[str, BuildColor] = {
    "byte sRGB": _image(False),
    "float": _image(True),
    "non-color": _non_color,
    "closest": lambda tree: node(tree, "ShaderNodeTexImage", image=smooth_image(), interpolation="Closest").outputs[
        "Color"
    ],
    "mapped as point": _mapped("POINT"),
    "turned by half": _mapped("POINT", math.pi),
    **{f"turned as {kind}": _mapped(kind, 0.6) for kind in ("POINT", "TEXTURE", "VECTOR")},
    "mapped twice": _twice_mapped,
    "turned checker": _turned_checker,
    "clipped": _beyond("CLIP"),
    "mirrored": _beyond("MIRROR"),
    "mapped as texture": _mapped("TEXTURE"),
    "mapped as vector": _mapped("VECTOR"),
    "extended": _extended,
    "checker": _checker,
    "changed": _changed,
    "generated": _generated,
    "object space": _object_space,
}


def test_textures_are_those_of_cycles() -> None:
    """Squares beside each other in one picture, read as base colors and then shown by emission."""
    pixels, count = 30, len(TEXTURES)
    shown = []
    for index, (name, build) in enumerate(TEXTURES.items()):
        square = add_square(name, 1.0)
        square.location = (index - 0.5 * (count - 1), 0.0, 0.0)
        tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
        color = build(tree)
        tree.links.new(color, shader.inputs["Color"])
        shown.append((tree, color))
    scene = extracted()
    for tree, color in shown:
        emission = node(tree, "ShaderNodeEmission", {"Color": color})
        tree.links.new(emission.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    look_down(count)
    picture = cycles_picture(pixels * count, pixels, 64)
    y, x = (np.mgrid[0:pixels, 0:pixels] + 0.5) / pixels - 0.5
    places = np.column_stack([x.ravel(), y.ravel()])
    for index, name in enumerate(TEXTURES):
        ours = channel_on(scene, name, "base_color", places).reshape(pixels, pixels, 3)
        theirs = picture[:, index * pixels : (index + 1) * pixels]
        # The pixel filter blurs sharp edges, and the neighbor comes in at the border.
        error = np.abs(ours - theirs)[2:-2, 2:-2].max(axis=-1)
        quantile = 0.4 if name in ("closest", "checker", "turned checker") else 0.9
        limit = 0.035 if name in ("turned as TEXTURE", "clipped", "mirrored") else 0.02
        assert np.quantile(error, quantile) < limit, (name, np.quantile(error, [0.4, 0.9, 1.0]))


def test_vertex_colors_times_a_texture() -> None:
    square = add_square()
    square.data.color_attributes.new("paint", "FLOAT_COLOR", "POINT")
    tree, (shader,) = new_material(square, "ShaderNodeBsdfPrincipled")
    texture = node(tree, "ShaderNodeTexImage", image=smooth_image()).outputs["Color"]
    paint = node(tree, "ShaderNodeAttribute", attribute_name="paint").outputs["Color"]
    inputs = {"Factor_Float": 1.0, "A_Color": texture, "B_Color": paint}
    product = node(tree, "ShaderNodeMix", inputs, data_type="RGBA", blend_type="MULTIPLY").outputs[2]
    tree.links.new(product, shader.inputs["Base Color"])
    square.data.attributes["paint"].data.foreach_set("color", np.tile([0.5, 0.25, 2.0, 1.0], 4).astype(np.float32))
    scene = extracted()
    assert not scene.warnings
    found = channel_on(scene, "square", "base_color", [(0.3, 0.6)])
    tree.links.new(texture, shader.inputs["Base Color"])
    plain = channel_on(extracted(), "square", "base_color", [(0.3, 0.6)])
    np.testing.assert_allclose(found, plain * (0.5, 0.25, 2.0), rtol=1e-5)


def test_one_image_in_many_materials_is_read_once() -> None:
    image = smooth_image()
    for name in ("one", "two"):
        square = add_square(name)
        tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
        tree.links.new(node(tree, "ShaderNodeTexImage", image=image).outputs[0], shader.inputs["Color"])
    scene = extracted()
    assert len(scene.images) == 1
    one, two = (material_of(scene, name).program for name in ("one", "two"))
    assert one is not None and two is not None and one.shape == two.shape and one.images == two.images


def test_a_missing_image_is_magenta() -> None:
    square = add_square()
    tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    image = bpy.data.images.new("lost", 4, 4)
    image.source = "FILE"
    image.filepath = "/nowhere/lost.png"
    tree.links.new(node(tree, "ShaderNodeTexImage", image=image).outputs[0], shader.inputs["Color"])
    scene = extracted()
    np.testing.assert_array_equal(channel_on(scene, "square", "base_color", [(0.1, 0.1)]), [(1.0, 0.0, 1.0)])
    assert 'The pixels of image "lost" are missing: drawn magenta, as in Cycles.' in scene.warnings


def test_a_packed_image(tmp_path: Any) -> None:
    path = tmp_path / "saved.png"
    made = smooth_image(float_buffer=False)
    made.filepath_raw = str(path)
    made.file_format = "PNG"
    made.save()
    packed = bpy.data.images.load(str(path))
    packed.pack()
    path.unlink()
    square = add_square()
    tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    tree.links.new(node(tree, "ShaderNodeTexImage", image=packed).outputs[0], shader.inputs["Color"])
    scene = extracted()
    encoded = np.rint((np.arange(8) + 0.5) / 8 * 255) / 255
    found = channel_on(scene, "square", "base_color", [(0.0, (row + 0.5) / 4.0 - 1.0) for row in range(8)])
    np.testing.assert_allclose(found[:, 1], ((encoded + 0.055) / 1.055) ** 2.4, atol=4e-3)
    assert not scene.warnings
