# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures as read, against what Cycles shows of them."""

from __future__ import annotations

import math
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from extraction import add_square, cycles_picture, empty_scene, extracted, look_down, material_of, mesh_of, new_material
from scene.color_nodes import COLOR, OTHER, BuildColor, Tree, node, smooth_image


@pytest.fixture(autouse=True)
def _scene() -> None:
    empty_scene()


def texture_color(scene: SceneArrays, name: str, uv: np.ndarray) -> np.ndarray:
    """What the renderer's shader does (surface_color.glsl), for (h, w, 2) coordinates."""
    material = material_of(scene, name)
    image = scene.images[material.image]
    place = uv * np.array(material.uv_scale) + uv[..., ::-1] * np.array(material.uv_turn) + np.array(material.uv_offset)
    height, width = image.pixels.shape[:2]
    place = place * (width, height)
    if image.nearest:
        column, row = np.floor(place[..., 0]).astype(int), np.floor(place[..., 1]).astype(int)
        found = _texel(image.pixels, column, row, image.extension)
    else:
        place = place - 0.5
        low = np.floor(place).astype(int)
        part = place - low
        found = sum(
            (part[..., 0:1] if dx else 1 - part[..., 0:1])
            * (part[..., 1:2] if dy else 1 - part[..., 1:2])
            * _texel(image.pixels, low[..., 0] + dx, low[..., 1] + dy, image.extension)
            for dx in (0, 1)
            for dy in (0, 1)
        )
    return found[..., :3] * np.array(material.base_color)


def _texel(pixels: np.ndarray, column: np.ndarray, row: np.ndarray, extension: str) -> np.ndarray:
    height, width = pixels.shape[:2]
    if extension == "REPEAT":
        return pixels[row % height, column % width]
    if extension == "MIRROR":
        row, column = (
            np.minimum(place % (2 * size), 2 * size - 1 - place % (2 * size))
            for place, size in ((row, height), (column, width))
        )
    outside = (row < 0) | (row >= height) | (column < 0) | (column >= width)
    if extension == "CLIP":
        return np.where(outside[..., None], 0.0, pixels[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)])
    return pixels[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)]


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
    centers = (np.arange(pixels) + 0.5) / pixels
    local = np.stack(np.meshgrid(centers, centers), axis=-1)
    for index, name in enumerate(TEXTURES):
        uv = _interpolated_uv(scene, name, local)
        ours = texture_color(scene, name, uv)
        theirs = picture[:, index * pixels : (index + 1) * pixels]
        # The pixel filter blurs sharp edges, and the neighbor comes in at the border.
        error = np.abs(ours - theirs)[2:-2, 2:-2].max(axis=-1)
        quantile = 0.4 if name in ("closest", "checker", "turned checker") else 0.9
        # Between the texels of byte images Cycles interpolates before it decodes.
        limit = 0.035 if name in ("byte sRGB", "turned as TEXTURE", "clipped", "mirrored") else 0.02
        assert np.quantile(error, quantile) < limit, (name, np.quantile(error, [0.4, 0.9, 1.0]))


def _interpolated_uv(scene: SceneArrays, name: str, local: np.ndarray) -> np.ndarray:
    """(h, w, 2) of the mesh's own coordinates, which are affine on a square of two triangles."""
    mesh = mesh_of(scene, name)
    assert mesh.corner_uv is not None
    places = mesh.positions[mesh.corner_vertex][:, :2] + 0.5
    affine, *_ = np.linalg.lstsq(np.column_stack([places, np.ones(len(places))]), mesh.corner_uv, rcond=None)
    return local @ affine[:2] + affine[2]


def test_vertex_colors_times_a_texture() -> None:
    square = add_square()
    square.data.color_attributes.new("paint", "FLOAT_COLOR", "POINT")
    tree, (shader,) = new_material(square, "ShaderNodeBsdfPrincipled")
    texture = node(tree, "ShaderNodeTexImage", image=smooth_image()).outputs["Color"]
    paint = node(tree, "ShaderNodeAttribute", attribute_name="paint").outputs["Color"]
    inputs = {"Factor_Float": 1.0, "A_Color": texture, "B_Color": paint}
    product = node(tree, "ShaderNodeMix", inputs, data_type="RGBA", blend_type="MULTIPLY").outputs[2]
    tree.links.new(product, shader.inputs["Base Color"])
    scene = extracted()
    material = material_of(scene, "square")
    assert material.uses_vertex_color and material.image == 0
    assert material.base_color == (1.0, 1.0, 1.0)
    assert mesh_of(scene, "square").corner_color is not None and not scene.warnings


def test_one_image_in_many_materials_is_read_once() -> None:
    image = smooth_image()
    for name in ("one", "two"):
        square = add_square(name)
        tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
        tree.links.new(node(tree, "ShaderNodeTexImage", image=image).outputs[0], shader.inputs["Color"])
    scene = extracted()
    assert len(scene.images) == 1
    assert material_of(scene, "one").image == material_of(scene, "two").image == 0


def test_a_missing_image_is_magenta() -> None:
    square = add_square()
    tree, (shader,) = new_material(square, "ShaderNodeBsdfDiffuse")
    image = bpy.data.images.new("lost", 4, 4)
    image.source = "FILE"
    image.filepath = "/nowhere/lost.png"
    tree.links.new(node(tree, "ShaderNodeTexImage", image=image).outputs[0], shader.inputs["Color"])
    scene = extracted()
    np.testing.assert_array_equal(scene.images[0].pixels, [[(1.0, 0.0, 1.0, 1.0)]])
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
    # Magnified, as what is between the pixels is not linear: every seventh is one of the image.
    assert scene.images[0].pixels.shape == (56, 112, 4)
    rows = np.arange(8) + 0.5
    encoded = np.rint(rows / 8 * 255) / 255
    np.testing.assert_allclose(scene.images[0].pixels[3::7, 3, 1], ((encoded + 0.055) / 1.055) ** 2.4, atol=4e-3)
    assert not scene.warnings
