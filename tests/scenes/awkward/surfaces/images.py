# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Images on what mirrors show: alpha, color spaces, files that are odd."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..registry import awkward
from ..stage import (
    add_sheet,
    bpy,
    node,
    picture,
    principled_node,
    stage,
    stripes,
    textured,
    wall_of,
)


def _clear_stripes() -> np.ndarray:
    """Stripes of which every other is transparent, with color below."""
    pixels = stripes()
    pixels[:, (np.arange(64) * 4 // 64) % 2 == 1, 3] = 0.0
    return pixels


@awkward("an image, as usual")
def image_plain(folder: Path) -> None:
    stage()
    wall_of(textured("Striped", picture("Stripes", stripes()))[0])


@awkward("an image with alpha that is not linked: Cycles shows black there")
def image_alpha_unlinked(folder: Path) -> None:
    stage()
    wall_of(textured("Leaf", picture("Leaf", _clear_stripes(), alpha=True))[0])


@awkward("an image with alpha that is linked", words=("alpha", "transparen"))
def image_alpha_linked(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Leaf", picture("Leaf", _clear_stripes(), alpha=True))
    tree.links.new(texture.outputs["Alpha"], principled_node(material).inputs["Alpha"])
    wall_of(material)


def _alpha_mode(mode: str) -> None:
    stage()
    image = picture("Leaf", _clear_stripes(), alpha=True)
    image.alpha_mode = mode
    wall_of(textured("Leaf", image)[0])


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
    wall_of(textured("Leaf", bpy.data.images.load(str(file)))[0])


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
    wall_of(textured("Striped", image)[0])


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
    wall_of(material)
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
    wall_of(textured("Lost", image)[0])


@awkward("an image file that is damaged", words=("broken.png", "Torn", "cannot", "no pixels"))
def image_damaged(folder: Path) -> None:
    stage()
    file = _written(folder, "broken.png", stripes())
    file.write_bytes(file.read_bytes()[:60])
    wall_of(textured("Torn", bpy.data.images.load(str(file)))[0])


@awkward("an Image Texture without an image: Cycles shows black")
def image_none(folder: Path) -> None:
    stage()
    material, _, texture = textured("Bare", picture("Stripes", stripes()))
    texture.image = None
    wall_of(material)


@awkward("an image of one pixel")
def image_one_pixel(folder: Path) -> None:
    stage()
    wall_of(textured("Dot", picture("Dot", np.full((1, 1, 4), (0.9, 0.4, 0.1, 1.0))))[0])


@awkward("an image that is non-color data but used as color")
def image_non_color(folder: Path) -> None:
    stage()
    image = picture("Data", stripes())
    image.colorspace_settings.name = "Non-Color"
    wall_of(textured("Data", image)[0])


@awkward("a float image over 1", words=("emission",))
def image_float(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Bright", picture("Bright", 3.0 * stripes(), is_float=True))
    shader = principled_node(material)
    tree.links.new(texture.outputs["Color"], shader.inputs["Emission Color"])
    shader.inputs["Emission Strength"].default_value = 0.2
    shader.inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    tree.links.remove(shader.inputs["Base Color"].links[0])
    wall_of(material)


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
    wall_of(material)


@awkward("an image by box projection", words=("box", "projection"))
def image_box(folder: Path) -> None:
    stage()
    material, tree, texture = textured("Boxed", picture("Stripes", stripes()))
    texture.projection, texture.projection_blend = "BOX", 0.2
    coordinate = node(tree, "TexCoord")
    tree.links.new(coordinate.outputs["Object"], texture.inputs["Vector"])
    wall_of(material)
