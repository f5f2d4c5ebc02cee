# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Image and checker textures on surfaces: pixels, and where on the surface they go."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..arrays import Float32Array, ImageArrays
from ..meshes.meshes import GENERATED, OBJECT
from .images import ImageReader
from .node_colors import Change, ColorReader, NodeColor
from .node_links import Source, find_input, source_of


@dataclass(frozen=True, slots=True)
class TextureSpace:
    """Texture coordinates: `scale` * uv + `offset`."""

    uv_map: str = ""
    """As `MeshNeeds.uv_map`"""
    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class SurfaceTexture:
    """A `node_colors.Texture`."""

    image: ImageArrays
    space: TextureSpace

    def colors(self) -> Float32Array:
        return self.image.pixels[..., :3]

    def changed(self, change: Change) -> SurfaceTexture:
        pixels = self.image.pixels.copy()
        pixels[..., :3] = change(pixels[..., :3])
        return replace(self, image=replace(self.image, pixels=pixels))


class SurfaceTextureReader:
    """Texture nodes of materials. Equal images are one `ImageArrays`."""

    def __init__(self, images: ImageReader) -> None:
        self._images = images
        self._arrays: dict[tuple[int, bool, bool], ImageArrays] = {}

    def forget(self) -> None:
        """Images changed."""
        self._arrays.clear()

    def read(self, source: Source, notes: list[str]) -> NodeColor | None:
        """The color of a texture node, None where it cannot be one. Approximations are added to `notes`."""
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
        if node.image is None:
            # Cycles shows an unset image black in surfaces.
            return NodeColor((0.0, 0.0, 0.0))
        space = _texture_space(source, "", notes)
        if space is None or node.projection != "FLAT":
            notes.append(f'image texture "{node.name}" is drawn as one color, for want of a UV map')
            mean = self._images.read(node.image)[..., :3].reshape(-1, 3).mean(axis=0, dtype=np.float64)
            return NodeColor((float(mean[0]), float(mean[1]), float(mean[2])))
        if node.extension in ("CLIP", "MIRROR"):
            done = "clipped" if node.extension == "CLIP" else "mirrored"
            notes.append(f'image texture "{node.name}" is not {done} beyond its border')
        nearest, repeat = node.interpolation == "Closest", node.extension in ("REPEAT", "MIRROR")
        key = (node.image.as_pointer(), nearest, repeat)
        if key not in self._arrays:
            self._arrays[key] = ImageArrays(node.image.name, self._images.read(node.image), repeat, nearest)
        texture = SurfaceTexture(self._arrays[key], space)
        if source.socket.name == "Alpha":
            alpha = texture.image.pixels[..., 3:]
            return NodeColor(texture=texture.changed(lambda colors: np.broadcast_to(alpha, colors.shape)))
        return NodeColor(texture=texture)

    def _checker(self, source: Source, notes: list[str]) -> NodeColor | None:
        """On a UV map (where z is 0) the pattern is exactly an image of 2 x 2 pixels, each as large as a square."""
        node = source.node
        assert node is not None
        space = _texture_space(source, GENERATED, notes)
        if space is None or space.uv_map in (GENERATED, OBJECT):
            return None
        reader = ColorReader(lambda inner: self.read(inner, notes), notes)
        squares = reader.number(source.input("Scale"), "checker scale")
        # Black and white squares: the output "Factor" is 1 on squares of the first color.
        pair = np.array([(1.0, 1.0, 1.0), (0.0, 0.0, 0.0)], np.float32)
        if source.socket.name == "Color":
            ends = [reader.color(source.input(name)) for name in ("Color1", "Color2")]
            if not all(end.is_constant for end in ends):
                notes.append(f'the textures within node "{node.name}" are drawn as one color')
            pair = np.array([end.mean() for end in ends], np.float32)
        first, second = pair[0], pair[1]
        pixels = np.ones((2, 2, 4), np.float32)
        pixels[0, 0, :3] = pixels[1, 1, :3] = second
        pixels[0, 1, :3] = pixels[1, 0, :3] = first
        half = 0.5 * squares
        space = replace(
            space,
            scale=(space.scale[0] * half, space.scale[1] * half),
            offset=(space.offset[0] * half, space.offset[1] * half),
        )
        return NodeColor(texture=SurfaceTexture(ImageArrays(node.name, pixels, repeat=True, nearest=True), space))


def _texture_space(source: Source, unlinked: str, notes: list[str]) -> TextureSpace | None:
    """Coordinates at the input "Vector" of a texture node; `unlinked` is the map used without a link.

    None where they are neither a UV map nor a plane of the object.
    """
    mappings: list[tuple[Any, Any]] = []
    vector = source.input("Vector")
    while vector.node is not None and vector.node.type == "MAPPING":
        mappings.append((vector.node, vector.groups))
        vector = vector.input("Vector")
    uv_map = _uv_map(vector, unlinked, notes)
    if uv_map is None:
        return None
    scale, offset = np.ones(2), np.zeros(2)
    for node, groups in reversed(mappings):
        linear, shift = _mapping(node, groups, notes)
        scale, offset = linear * scale, linear * offset + shift
    return TextureSpace(uv_map, (float(scale[0]), float(scale[1])), (float(offset[0]), float(offset[1])))


def _uv_map(vector: Source, unlinked: str, notes: list[str]) -> str | None:
    node = vector.node
    if node is None:
        return unlinked
    if node.type == "TEX_COORD":
        if vector.socket.name == "Object" and node.object is not None:
            return None
        known = {"UV": "", "Generated": GENERATED, "Object": OBJECT}.get(vector.socket.name)
        if known in (GENERATED, OBJECT):
            notes.append("its texture is drawn as seen along the object's Z axis")
        return known
    if node.type == "UVMAP":
        return str(node.uv_map)
    if node.type == "ATTRIBUTE" and node.attribute_type == "GEOMETRY" and vector.socket.name == "Vector":
        return str(node.attribute_name)
    return None


def _mapping(node: Any, groups: Any, notes: list[str]) -> tuple[np.ndarray, np.ndarray]:
    """(2,) factors and (2,) shift of a Mapping node in the plane; half turns about Z are the only rotation."""

    def vector(name: str, default: float) -> np.ndarray:
        if name not in node.inputs:
            return np.full(3, default)
        value = source_of(find_input(node, name), groups)
        if value.node is not None:
            notes.append(f'the {name.lower()} of node "{node.name}" varies and is left out')
            return np.full(3, default)
        return np.array(value.socket.default_value[:3], np.float64)

    location, rotation, scale = vector("Location", 0.0), vector("Rotation", 0.0), vector("Scale", 1.0)
    if node.vector_type == "NORMAL":
        notes.append(f'node "{node.name}" maps normals and is left out')
        return np.ones(2), np.zeros(2)
    half_turns = rotation[2] / math.pi
    if max(abs(rotation[0]), abs(rotation[1]), abs(half_turns - round(half_turns))) > 1e-5:
        notes.append(f'the rotation of node "{node.name}" is left out')
        half_turns = 0.0
    sign = -1.0 if round(half_turns) % 2 else 1.0
    factors = sign * scale[:2]
    if node.vector_type == "TEXTURE":
        factors = np.divide(sign, scale[:2], out=np.zeros(2), where=scale[:2] != 0.0)
        return factors, -location[:2] * factors
    shift = location[:2] if node.vector_type == "POINT" else np.zeros(2)
    return factors, shift
