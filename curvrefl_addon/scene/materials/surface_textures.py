# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Image and checker textures on surfaces: pixels, and where on the surface they go."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Float32Array, Float64Array, ImageArrays
from ..meshes.meshes import GENERATED, OBJECT
from .images import MISSING_COLOR, ImageReader, magnified
from .mappings import mapped_from
from .node_color import Change, NodeColor, gray
from .node_colors import ColorReader
from .node_links import Source, find_input
from .pixels import averaged, stretched

COARSE = 1 << 20
"""Pixels that are enough for a mean of what nodes make of an image"""


@dataclass(frozen=True, slots=True)
class TextureSpace:
    """Texture coordinates: `scale` * (u, v) + `turn` * (v, u) + `offset`."""

    uv_map: str = ""
    """As `MeshNeeds.uv_map`"""
    scale: tuple[float, float] = (1.0, 1.0)
    turn: tuple[float, float] = (0.0, 0.0)
    offset: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class SurfaceTexture:
    """A `node_color.Texture`."""

    image: ImageArrays
    space: TextureSpace

    def colors(self) -> Float32Array:
        return self.image.pixels[..., :3]

    def changed(self, change: Change) -> SurfaceTexture:
        pixels = self.image.pixels.copy()
        pixels[..., :3] = change(pixels[..., :3])
        return replace(self, image=replace(self.image, pixels=pixels))

    def aligned(self, other: SurfaceTexture) -> Float32Array | None:
        if other.space != self.space or other.image.extension != self.image.extension:
            return None
        return stretched(other.colors(), *self.image.pixels.shape[:2])

    def coarse(self) -> SurfaceTexture:
        height, width = self.image.pixels.shape[:2]
        if height * width <= COARSE:
            return self
        part = (COARSE / (height * width)) ** 0.5
        pixels = averaged(self.image.pixels, max(int(height * part), 1), max(int(width * part), 1))
        return replace(self, image=replace(self.image, pixels=np.asarray(pixels, np.float32)))


def bordered(color: NodeColor | None) -> NodeColor | None:
    """Of an image that ends: the same with what is beyond as a border of pixels, which nodes change with the others."""
    if color is None or not isinstance(color.texture, SurfaceTexture) or color.texture.image.extension != "CLIP":
        return color
    image, space = color.texture.image, color.texture.space
    height, width = image.pixels.shape[:2]
    pixels = np.pad(image.pixels, ((1, 1), (1, 1), (0, 0)))
    shrink = np.array([width / (width + 2.0), height / (height + 2.0)])
    offset = shrink * space.offset + 1.0 / np.array([width + 2.0, height + 2.0])
    grown = replace(space, scale=_pair(shrink * space.scale), turn=_pair(shrink * space.turn), offset=_pair(offset))
    return replace(color, texture=SurfaceTexture(replace(image, pixels=pixels, extension="EXTEND"), grown))


class SurfaceTextureReader:
    """Texture nodes of materials. Equal images are one `ImageArrays`."""

    def __init__(self, images: ImageReader) -> None:
        self._images = images
        self._arrays: dict[tuple[int, bool, str], tuple[Float32Array, ImageArrays]] = {}

    def forget(self) -> None:
        """Images changed."""
        self._arrays.clear()

    def read(self, source: Source, notes: list[str]) -> NodeColor | None:
        """The color of a texture node, None where it cannot be one. What is not drawn is added to `notes`."""
        node = source.node
        assert node is not None
        if node.type == "TEX_IMAGE":
            return self._image(source, notes)
        if node.type == "TEX_CHECKER":
            return self._checker(source, notes)
        return None

    def _image(self, source: Source, notes: list[str]) -> NodeColor:
        node = source.node
        assert node is not None
        is_alpha = source.socket.identifier == "Alpha"
        if node.image is None:
            notes.append("Image nodes {of} without an image are drawn magenta, as in Cycles.")
            return gray(1.0) if is_alpha else NodeColor(MISSING_COLOR[:3])
        # (Cycles looks at alpha by itself where anything uses it.)
        splits_alpha = any(not link.is_muted for link in node.outputs["Alpha"].links)
        pixels = self._images.read(node.image, node.image_user, splits_alpha)
        space = _texture_space(source, "", self._colors(notes), notes)
        if space is None or node.projection != "FLAT":
            notes.append("Images {of} without a UV map are drawn as one color.")
            part = pixels[..., 3:].repeat(3, axis=-1) if is_alpha else pixels[..., :3]
            mean = part.reshape(-1, 3).mean(axis=0, dtype=np.float64)
            return NodeColor((float(mean[0]), float(mean[1]), float(mean[2])))
        nearest = node.interpolation == "Closest"
        key = (id(pixels), nearest, node.extension)
        if key not in self._arrays:
            finer = pixels
            if not nearest and node.extension != "CLIP":
                finer = magnified(node.image, pixels, node.extension == "REPEAT")
            # (With the pixels, so that their id is not given to others.)
            self._arrays[key] = pixels, ImageArrays(node.image.name, finer, node.extension, nearest)
        texture = SurfaceTexture(self._arrays[key][1], space)
        if is_alpha:
            alpha = texture.image.pixels[..., 3:]
            return NodeColor(texture=texture.changed(lambda colors: np.broadcast_to(alpha, colors.shape)))
        return NodeColor(texture=texture)

    def _colors(self, notes: list[str]) -> ColorReader:
        return ColorReader(lambda inner: self.read(inner, notes), notes)

    def _checker(self, source: Source, notes: list[str]) -> NodeColor | None:
        """On a UV map (where z is 0) the pattern is exactly an image of 2 x 2 pixels, each as large as a square."""
        reader = self._colors(notes)
        space = _texture_space(source, GENERATED, reader, notes)
        if space is None or space.uv_map in (GENERATED, OBJECT):
            return None
        squares = reader.number(source.input("Scale"), "checker scale")
        # Black and white squares: the output "Factor" is 1 on squares of the first color.
        pair = np.array([(1.0, 1.0, 1.0), (0.0, 0.0, 0.0)], np.float32)
        if source.socket.name == "Color":
            ends = [reader.color(source.input(name)) for name in ("Color1", "Color2")]
            if not all(end.is_constant for end in ends):
                notes.append("Textures within a Checker Texture {of} are drawn as one color.")
            pair = np.array([end.mean() for end in ends], np.float32)
        first, second = pair[0], pair[1]
        pixels = np.ones((2, 2, 4), np.float32)
        pixels[0, 0, :3] = pixels[1, 1, :3] = second
        pixels[0, 1, :3] = pixels[1, 0, :3] = first
        half = 0.5 * squares

        def grown(pair: tuple[float, float]) -> tuple[float, float]:
            return pair[0] * half, pair[1] * half

        space = replace(space, scale=grown(space.scale), turn=grown(space.turn), offset=grown(space.offset))
        name = str(source.socket.node.name)
        return NodeColor(texture=SurfaceTexture(ImageArrays(name, pixels, nearest=True), space))


def _texture_space(source: Source, unlinked: str, colors: ColorReader, notes: list[str]) -> TextureSpace | None:
    """Coordinates at the input "Vector" of a texture node; `unlinked` is the map used without a link.

    None where they are neither a UV map nor a plane of the object.
    """
    linear, shift, vector = mapped_from(source, colors)
    own = source.socket.node.texture_mapping
    if any(own.translation) or any(own.rotation) or tuple(own.scale) != (1.0, 1.0, 1.0):
        notes.append("Mappings within texture nodes {of} are left out.")
    if vector.node is None and vector.socket != find_input(source.node, "Vector"):
        # Not the default coordinates: a place that is the same everywhere.
        shift, linear = linear @ np.array(vector.socket.default_value[:3]) + shift, np.zeros((3, 3))
    uv_map = _uv_map(vector, unlinked)
    if uv_map is None:
        return None
    if uv_map in (GENERATED, OBJECT) and np.abs(linear[:2, 2]).max() > 1e-6:
        notes.append("Images {of} that are turned out of the object's plane XY are drawn as if they were not.")
    (a, b), (c, d) = linear[:2, :2].tolist()
    # What is 1e-17 by a sine of half a turn is none.
    b, c = (0.0 if abs(x) < 1e-9 * max(abs(a), abs(d)) else x for x in (b, c))
    return TextureSpace(uv_map, (a, d), (b, c), (float(shift[0]), float(shift[1])))


def _uv_map(vector: Source, unlinked: str) -> str | None:
    node = vector.node
    if node is None:
        return unlinked
    if node.type == "TEX_COORD":
        if vector.socket.name == "Object" and node.object is not None:
            return None
        return {"UV": "", "Generated": GENERATED, "Object": OBJECT}.get(vector.socket.name)
    if node.type == "UVMAP":
        return str(node.uv_map)
    if node.type == "ATTRIBUTE" and node.attribute_type == "GEOMETRY" and vector.socket.name == "Vector":
        return str(node.attribute_name)
    return None


def _pair(values: Float64Array) -> tuple[float, float]:
    return float(values[0]), float(values[1])
