# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Images on what mirrors show: alpha, color spaces, files that are odd, UV maps, mappings, attributes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import awkward
from ..stage import (
    add_ball,
    add_sheet,
    bpy,
    find,
    matte,
    node,
    picture,
    principled_node,
    stage,
    stripes,
    textured,
)


def _wall(material: bpy.types.Material) -> Any:
    """A wall behind the camera that the mirror shows, and a ball that the eye sees; returns the wall."""
    add_ball("Sample", (-1.2, -1.9, 0.55), 0.55, material)
    return add_sheet("Wall", (0.0, -5.5, 2.0), (6.0, 4.0), material, (-np.pi / 2.0, 0.0, np.pi))


def _clear_stripes() -> np.ndarray:
    """Stripes of which every other is transparent, with color below."""
    pixels = stripes()
    pixels[:, (np.arange(64) * 4 // 64) % 2 == 1, 3] = 0.0
    return pixels


@awkward("an image, as usual")
def image_plain(folder: Path) -> None:
    stage()
    _wall(textured("Striped", picture("Stripes", stripes()))[0])


@awkward("an image with alpha that is not linked: Cycles shows black there")
def image_alpha_unlinked(folder: Path) -> None:
    stage()
    _wall(textured("Leaf", picture("Leaf", _clear_stripes(), alpha=True))[0])


@awkward("an image with alpha that is linked", words=("alpha", "transparen"))
def image_alpha_linked(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Leaf", picture("Leaf", _clear_stripes(), alpha=True))
    tree.links.new(texture.outputs["Alpha"], principled_node(material).inputs["Alpha"])
    _wall(material)


def _alpha_mode(mode: str) -> None:
    stage()
    image = picture("Leaf", _clear_stripes(), alpha=True)
    image.alpha_mode = mode
    _wall(textured("Leaf", image)[0])


@awkward("an image whose alpha is channel-packed")
def image_alpha_packed(folder: Path) -> None:
    _alpha_mode("CHANNEL_PACKED")


@awkward("an image whose alpha is ignored")
def image_alpha_none(folder: Path) -> None:
    _alpha_mode("NONE")


@awkward("an OpenEXR image with alpha, premultiplied")
def image_premultiplied_exr(folder: Path) -> None:
    file = folder / "leaf.exr"
    pixels = stripes((0.8, 0.6, 0.1), (0.0, 0.3, 0.1))
    pixels[:, :, 3] = np.linspace(0.2, 1.0, 64)[None]
    pixels[..., :3] *= pixels[..., 3:]
    image: Any = bpy.data.images.new("Leaf", 64, 64, alpha=True, float_buffer=True)
    image.alpha_mode = "PREMUL"
    image.pixels.foreach_set(pixels.ravel())
    image.filepath_raw, image.file_format = str(file), "OPEN_EXR"
    image.save()
    bpy.data.images.remove(image)
    stage()
    _wall(textured("Leaf", bpy.data.images.load(str(file)))[0])


def _written(folder: Path, name: str, pixels: np.ndarray, kind: str = "PNG") -> Path:
    """A file of an image."""
    image: Any = bpy.data.images.new("Written", pixels.shape[1], pixels.shape[0], alpha=True)
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    image.filepath_raw, image.file_format = str(folder / name), kind
    image.save()
    bpy.data.images.remove(image)
    return folder / name


@awkward("an image in a file beside the .blend, by a relative path")
def image_relative_path(folder: Path) -> None:
    stage()
    file = _written(folder, "stripes.png", stripes())
    image = bpy.data.images.load(str(file))
    image.filepath = "//stripes.png"
    _wall(textured("Striped", image)[0])


@awkward("a numbered sequence of images")
def image_sequence(folder: Path) -> None:
    stage()
    for number in range(1, 4):
        _written(folder, f"frame{number:04}.png", np.full((4, 4, 4), (0.2 * number, 0.9 - 0.2 * number, 0.1, 1.0)))
    image = bpy.data.images.load(str(folder / "frame0001.png"))
    image.source = "SEQUENCE"
    material, _, texture = textured("Film", image)
    texture.image_user.frame_duration, texture.image_user.use_auto_refresh = 3, True
    texture.image_user.frame_start = 1
    _wall(material)
    bpy.context.scene.frame_set(3)


@awkward("tiles of a UDIM", words=("tile", "UDIM"))
def image_udim(folder: Path) -> None:
    stage()
    _written(folder, "tile.1001.png", np.full((4, 4, 4), (0.9, 0.2, 0.1, 1.0)))
    _written(folder, "tile.1002.png", np.full((4, 4, 4), (0.1, 0.3, 0.9, 1.0)))
    image = bpy.data.images.load(str(folder / "tile.1001.png"))
    image.source = "TILED"
    image.filepath = str(folder / "tile.<UDIM>.png")
    image.tiles.new(tile_number=1002)
    thing = add_sheet("Wall", (0.0, -5.5, 2.0), (6.0, 4.0), textured("Tiled", image)[0], (-np.pi / 2.0, 0.0, np.pi))
    uv = np.empty(8, np.float32)
    thing.data.uv_layers[0].uv.foreach_get("vector", uv)
    uv[0::2] *= 2.0
    thing.data.uv_layers[0].uv.foreach_set("vector", uv)


@awkward("an image whose file is missing: Cycles shows magenta")
def image_missing(folder: Path) -> None:
    stage()
    image = bpy.data.images.new("gone", 4, 4)
    image.source, image.filepath = "FILE", str(folder / "gone.png")
    _wall(textured("Lost", image)[0])


@awkward("an image file that is damaged", words=("broken.png", "Torn", "cannot", "no pixels"))
def image_damaged(folder: Path) -> None:
    stage()
    file = _written(folder, "broken.png", stripes())
    file.write_bytes(file.read_bytes()[:60])
    _wall(textured("Torn", bpy.data.images.load(str(file)))[0])


@awkward("an Image Texture without an image: Cycles shows black")
def image_none(folder: Path) -> None:
    stage()
    material, _, texture = textured("Bare", picture("Stripes", stripes()))
    texture.image = None
    _wall(material)


@awkward("an image of one pixel")
def image_one_pixel(folder: Path) -> None:
    stage()
    _wall(textured("Dot", picture("Dot", np.full((1, 1, 4), (0.9, 0.4, 0.1, 1.0))))[0])


@awkward("an image that is non-color data but used as color")
def image_non_color(folder: Path) -> None:
    stage()
    image = picture("Data", stripes())
    image.colorspace_settings.name = "Non-Color"
    _wall(textured("Data", image)[0])


@awkward("a float image over 1")
def image_float(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Bright", picture("Bright", 3.0 * stripes(), is_float=True))
    shader = principled_node(material)
    tree.links.new(texture.outputs["Color"], shader.inputs["Emission Color"])
    shader.inputs["Emission Strength"].default_value = 0.2
    shader.inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    tree.links.remove(shader.inputs["Base Color"].links[0])
    _wall(material)


@awkward(
    "an image repeated, mirrored, clipped, and extended", words=("repeat", "clip", "extend", "extension", "mirror")
)
def image_extensions(folder: Path) -> None:
    stage()
    image = picture("Stripes", stripes())
    for number, extension in enumerate(("REPEAT", "EXTEND", "CLIP", "MIRROR")):
        material, tree, texture = textured(extension, image)
        texture.extension = extension
        mapping, coordinate = node(tree, "Mapping"), node(tree, "TexCoord")
        mapping.inputs["Scale"].default_value, mapping.inputs["Location"].default_value = (
            (2.5, 2.5, 1.0),
            (-0.7, -0.7, 0),
        )
        tree.links.new(coordinate.outputs["UV"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
        add_sheet(f"Card {number}", (-2.1 + 1.4 * number, -1.75, 0.7), (1.2, 1.2), material, (np.pi / 2.0, 0.0, 0.0))


@awkward("an image without smoothing")
def image_closest(folder: Path) -> None:
    stage()
    material, _, texture = textured("Pixels", picture("Pixels", stripes(size=4)))
    texture.interpolation = "Closest"
    _wall(material)


@awkward("an image by box projection", words=("box", "projection"))
def image_box(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Boxed", picture("Stripes", stripes()))
    texture.projection, texture.projection_blend = "BOX", 0.2
    coordinate = node(tree, "TexCoord")
    tree.links.new(coordinate.outputs["Object"], texture.inputs["Vector"])
    _wall(material)


@awkward("a rotated mapping")
def mapping_rotation(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Turned", picture("Stripes", stripes()))
    mapping, coordinate = node(tree, "Mapping"), node(tree, "TexCoord")
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, 0.8)
    tree.links.new(coordinate.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    _wall(material)


@awkward("a mapping as of a texture", words=("mapping",))
def mapping_texture_type(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Turned", picture("Stripes", stripes()))
    mapping, coordinate = node(tree, "Mapping"), node(tree, "TexCoord")
    mapping.vector_type = "TEXTURE"
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, 0.8)
    mapping.inputs["Scale"].default_value = (0.5, 2.0, 1.0)
    mapping.inputs["Location"].default_value = (0.3, 0.1, 0.0)
    tree.links.new(coordinate.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    _wall(material)


@awkward("a mapping turned about X", words=("mapping",))
def mapping_about_x(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Turned", picture("Stripes", stripes()))
    mapping, coordinate = node(tree, "Mapping"), node(tree, "TexCoord")
    mapping.inputs["Rotation"].default_value = (1.0, 0.0, 0.7)
    tree.links.new(coordinate.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    _wall(material)


def _by_coordinate(output: str) -> None:
    stage()
    material, tree, texture = textured("Placed", picture("Stripes", stripes()))
    coordinate = node(tree, "TexCoord")
    tree.links.new(coordinate.outputs[output], texture.inputs["Vector"])
    _wall(material)


@awkward("generated coordinates", words=("generated", "coordinate"))
def coordinates_generated(folder: Path) -> None:
    _by_coordinate("Generated")


@awkward("object coordinates", words=("object", "coordinate"))
def coordinates_object(folder: Path) -> None:
    _by_coordinate("Object")


@awkward("window coordinates", words=("window", "coordinate"))
def coordinates_window(folder: Path) -> None:
    _by_coordinate("Window")


@awkward("reflection coordinates", words=("reflection", "coordinate"))
def coordinates_reflection(folder: Path) -> None:
    _by_coordinate("Reflection")


@awkward("a named UV map that is not the active one")
def uv_named(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Named", picture("Stripes", stripes()))
    uv = node(tree, "UVMap")
    uv.uv_map = "Second"
    tree.links.new(uv.outputs[0], texture.inputs["Vector"])
    _wall(material)
    for name in ("Wall", "Sample"):
        layers = find(name).data.uv_layers
        values = np.empty(2 * len(layers[0].uv), np.float32)
        layers[0].uv.foreach_get("vector", values)
        second = layers.new(name="Second")
        second.uv.foreach_set("vector", np.ascontiguousarray(values.reshape(-1, 2)[:, ::-1].ravel() * 0.7))
        layers.active_index = 0


@awkward("a UV map that does not exist")
def uv_missing(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Named", picture("Stripes", stripes()))
    uv = node(tree, "UVMap")
    uv.uv_map = "Nowhere"
    tree.links.new(uv.outputs[0], texture.inputs["Vector"])
    _wall(material)


@awkward("a mesh without UVs under an image")
def uv_none(folder: Path) -> None:
    stage()
    _wall(textured("Striped", picture("Stripes", stripes()))[0])
    for name in ("Wall", "Sample"):
        layers = find(name).data.uv_layers
        layers.remove(layers[0])


@awkward("the render UV map is another than the active one")
def uv_active_render(folder: Path) -> None:
    stage()
    _wall(textured("Striped", picture("Stripes", stripes()))[0])
    layers = find("Wall").data.uv_layers
    second = layers.new(name="Second")
    values = np.empty(2 * len(layers[0].uv), np.float32)
    layers[0].uv.foreach_get("vector", values)
    second.uv.foreach_set("vector", np.ascontiguousarray(values.reshape(-1, 2)[:, ::-1].ravel()))
    layers["Second"].active_render = True
    layers.active_index = 0


def _attribute(kind: str, domain: str, values: Any, field: str) -> None:
    """Wall and ball whose color is an attribute of them of this kind and domain."""
    stage()
    material = matte("Attributed", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    attribute = node(tree, "Attribute")
    attribute.attribute_name = "Tint"
    tree.links.new(attribute.outputs["Color"], principled_node(material).inputs["Base Color"])
    _wall(material)
    for name in ("Wall", "Sample"):
        made = find(name).data.attributes.new("Tint", kind, domain)
        count = len(made.data)
        made.data.foreach_set(field, np.ascontiguousarray(np.resize(values, (count, *np.shape(values)[1:]))).ravel())


@awkward("a color attribute of vertices")
def attribute_color(folder: Path) -> None:
    _attribute("FLOAT_COLOR", "POINT", [(0.9, 0.2, 0.1, 1.0), (0.1, 0.3, 0.9, 1.0), (0.2, 0.8, 0.2, 1.0)], "color")


@awkward("a byte color attribute of corners")
def attribute_byte_color(folder: Path) -> None:
    _attribute("BYTE_COLOR", "CORNER", [(0.9, 0.2, 0.1, 1.0), (0.1, 0.3, 0.9, 1.0)], "color")


@awkward("a float attribute of vertices")
def attribute_float(folder: Path) -> None:
    _attribute("FLOAT", "POINT", [0.1, 0.9, 0.5], "value")


@awkward("a float attribute of faces")
def attribute_face(folder: Path) -> None:
    _attribute("FLOAT", "FACE", [0.1, 0.9], "value")


@awkward("a vector attribute of vertices")
def attribute_vector(folder: Path) -> None:
    _attribute("FLOAT_VECTOR", "POINT", [(0.9, 0.2, 0.1), (0.1, 0.3, 0.9)], "vector")


@awkward("an integer attribute of faces")
def attribute_int(folder: Path) -> None:
    _attribute("INT", "FACE", [0, 1], "value")


@awkward("a boolean attribute of faces")
def attribute_bool(folder: Path) -> None:
    _attribute("BOOLEAN", "FACE", [True, False, False], "value")


@awkward("an attribute that no mesh has")
def attribute_missing(folder: Path) -> None:
    stage()
    material = matte("Attributed", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    attribute = node(tree, "Attribute")
    attribute.attribute_name = "Nowhere"
    tree.links.new(attribute.outputs["Color"], principled_node(material).inputs["Base Color"])
    _wall(material)


@awkward("an attribute of the object")
def attribute_of_object(folder: Path) -> None:
    stage()
    material = matte("Attributed", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    attribute = node(tree, "Attribute")
    attribute.attribute_type, attribute.attribute_name = "OBJECT", "tint"
    tree.links.new(attribute.outputs["Color"], principled_node(material).inputs["Base Color"])
    _wall(material)
    find("Wall")["tint"], find("Sample")["tint"] = (0.9, 0.3, 0.1), (0.1, 0.3, 0.9)


@awkward("the Color Attribute node")
def vertex_color_node(folder: Path) -> None:
    stage()
    material = matte("Painted", (0.8, 0.8, 0.8))
    tree: Any = material.node_tree
    color = node(tree, "VertexColor")
    color.layer_name = "Paint"
    tree.links.new(color.outputs["Color"], principled_node(material).inputs["Base Color"])
    _wall(material)
    for name in ("Wall", "Sample"):
        paint = find(name).data.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
        colors = np.resize([(0.9, 0.2, 0.1, 1.0), (0.1, 0.3, 0.9, 1.0)], (len(paint.data), 4))
        paint.data.foreach_set("color", colors.ravel())
