# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The world's background to arrays."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import bpy
import numpy as np

from .arrays import Float32Array, Float64Array, WorldArrays
from .color_spaces import rec709_to_scene
from .materials.images import ImageReader
from .materials.node_colors import Change, ColorReader, NodeColor
from .materials.node_links import Source, find_input, source_of, surface_source

SKY_COLORS = {
    "SINGLE_SCATTERING": (1.6, 2.0, 2.5),
    "MULTIPLE_SCATTERING": (2.1, 3.2, 5.0),
    "PREETHAM": (0.60, 0.64, 0.88),
    "HOSEK_WILKIE": (0.11, 0.15, 0.17),
}
"""Linear Rec.709, mean over all directions of the sky textures in Cycles: default settings, sun 0.8 rad up, no disc"""


@dataclass(frozen=True, slots=True)
class WorldImage:
    """A `node_colors.Texture` around the scene."""

    pixels: Float32Array
    """(h, w, 3) equirectangular, row 0 at the bottom"""
    rotation: Float64Array
    """(3, 3) from world to image directions, orthogonal"""

    def colors(self) -> Float32Array:
        return self.pixels

    def changed(self, change: Change) -> WorldImage:
        return replace(self, pixels=np.asarray(change(self.pixels), np.float32))


def read_world(world: bpy.types.World | None, images: ImageReader, warnings: list[str]) -> WorldArrays:
    """Background color or environment texture with its mapping; the nearest color and a warning for the rest."""
    if world is None:
        return WorldArrays()
    source = surface_source(world.node_tree)
    if source is None:
        # Without nodes Cycles shows the viewport's color; with an output that has nothing plugged in, black.
        has_output = world.node_tree is not None and world.node_tree.get_output_node("CYCLES") is not None
        return WorldArrays() if has_output else WorldArrays(_triple(world.color))
    notes: list[str] = []
    result = _WorldReader(images, notes).background(source)
    if notes:
        warnings.append(f'World "{world.name}" is drawn roughly: {"; ".join(dict.fromkeys(notes))}.')
    return result


class _WorldReader:
    """One world's nodes."""

    def __init__(self, images: ImageReader, notes: list[str]) -> None:
        self._images = images
        self._notes = notes
        self._colors = ColorReader(self._texture, notes)

    def background(self, source: Source) -> WorldArrays:
        """What a shader node of a world shines."""
        node = source.node
        if node is None or node.mute:
            return WorldArrays()
        if node.type in ("MIX_SHADER", "ADD_SHADER"):
            second = False
            if node.type == "MIX_SHADER":
                second = self._colors.number(source.input("Fac"), "mix factor") > 0.5
            self._notes.append("only one of its backgrounds is drawn")
            return self.background(source.input("Shader_001" if second else "Shader"))
        if node.type not in ("BACKGROUND", "EMISSION"):
            self._notes.append(f'shader "{node.name}" is drawn black')
            return WorldArrays()
        strength = self._colors.number(source.input("Strength"), "strength")
        color = self._colors.color(source.input("Color")).scaled((strength, strength, strength))
        if isinstance(color.texture, WorldImage):
            return WorldArrays(color.factor, np.ascontiguousarray(color.texture.pixels), color.texture.rotation)
        return WorldArrays(color.mean())

    def _texture(self, source: Source) -> NodeColor | None:
        node = source.node
        assert node is not None
        if node.type == "TEX_SKY":
            self._notes.append("its sky is drawn as an even color without a sun; an image of it would be drawn in full")
            sky = SKY_COLORS.get(node.sky_type, SKY_COLORS["MULTIPLE_SCATTERING"])
            return NodeColor(_triple(rec709_to_scene(np.array(sky, np.float32))))
        if node.type != "TEX_ENVIRONMENT":
            return None
        if node.image is None:
            return NodeColor((1.0, 0.0, 1.0))
        pixels = self._images.read(node.image)[..., :3]
        linear, shift = self._mapping(source)
        is_rotation = not shift.any() and bool(np.allclose(linear @ linear.T, np.eye(3), atol=1e-5))
        if node.projection == "MIRROR_BALL" or not is_rotation:
            pixels = _resampled(pixels, node.projection == "MIRROR_BALL", linear, shift)
            linear = np.eye(3)
        return NodeColor(texture=WorldImage(pixels, linear))

    def _mapping(self, source: Source) -> tuple[Float64Array, Float64Array]:
        """(3, 3) and (3,): image direction = matrix @ world direction + shift, up to its length."""
        linear, shift = np.eye(3), np.zeros(3)
        vector = source.input("Vector")
        while vector.node is not None and vector.node.type == "MAPPING":
            inner_linear, inner_shift = self._mapping_node(vector.node, vector.groups)
            linear, shift = linear @ inner_linear, linear @ inner_shift + shift
            vector = vector.input("Vector")
        node = vector.node
        known = node is None or (
            node.type == "TEX_COORD"
            and (vector.socket.name == "Generated" or (vector.socket.name == "Object" and node.object is None))
        )
        if not known:
            self._notes.append("the coordinates of its texture are taken for the plain direction")
        return linear, shift

    def _mapping_node(self, node: Any, groups: Any) -> tuple[Float64Array, Float64Array]:
        def vector(name: str, default: float) -> Float64Array:
            if name not in node.inputs:
                return np.full(3, default)
            found = source_of(find_input(node, name), groups)
            if found.node is None:
                return np.array(found.socket.default_value[:3], np.float64)
            color = self._colors.color(found)
            return np.array(color.mean(), np.float64)

        location, angles, scale = vector("Location", 0.0), vector("Rotation", 0.0), vector("Scale", 1.0)
        turn = _euler_matrix(angles)
        if node.vector_type == "TEXTURE":
            inverse = np.divide(1.0, scale, out=np.zeros(3), where=scale != 0.0)
            linear = inverse[:, None] * turn.T
            return linear, -linear @ location
        if node.vector_type == "NORMAL":
            inverse = np.divide(1.0, scale, out=np.zeros(3), where=scale != 0.0)
            return turn * inverse, np.zeros(3)
        return turn * scale, location if node.vector_type == "POINT" else np.zeros(3)


def _euler_matrix(angles: Float64Array) -> Float64Array:
    """(3, 3) of Blender's Euler angles XYZ: about X first."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(angles), np.sin(angles)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def equirectangular_directions(width: int, height: int) -> Float64Array:
    """(h, w, 3) directions of pixel centers in Blender's mapping: u = 0.5 - atan2(y, x) / 2 pi, v rises with z."""
    azimuth = -2.0 * np.pi * ((np.arange(width) + 0.5) / width - 0.5)
    elevation = np.pi * ((np.arange(height) + 0.5) / height - 0.5)
    flat = np.cos(elevation)[:, None]
    z = np.broadcast_to(np.sin(elevation)[:, None], (height, width))
    return np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), z], axis=-1)


def _resampled(pixels: Float32Array, is_mirror_ball: bool, linear: Float64Array, shift: Float64Array) -> Float32Array:
    """An equirectangular image about the world's axes of an image that is not, or not a plain rotation away."""
    height, width = pixels.shape[:2]
    out_width, out_height = (2 * height, height) if is_mirror_ball else (width, height)
    directions = equirectangular_directions(out_width, out_height) @ linear.T + shift
    lengths = np.linalg.norm(directions, axis=-1, keepdims=True)
    x, y, z = np.moveaxis(directions / np.where(lengths > 0.0, lengths, 1.0), -1, 0)
    if is_mirror_ball:
        # The ball is seen along Y: the picture of direction d is where the ball's normal is halfway to the viewer.
        radius = np.sqrt(np.maximum(2.0 * (1.0 - y), 1e-12))
        u, v = 0.5 * (x / radius + 1.0), 0.5 * (z / radius + 1.0)
    else:
        u, v = 0.5 - np.arctan2(y, x) / (2.0 * np.pi), np.arcsin(np.clip(z, -1.0, 1.0)) / np.pi + 0.5
    return _bilinear(pixels, u * width - 0.5, np.clip(v * height - 0.5, 0.0, height - 1.0))


def _bilinear(pixels: Float32Array, column: Float64Array, row: Float64Array) -> Float32Array:
    """Columns wrap around, rows are within the image."""
    height, width = pixels.shape[:2]
    left, low = np.floor(column).astype(np.int64), np.floor(row).astype(np.int64)
    across, up = (column - left)[..., None], (row - low)[..., None]
    high = np.minimum(low + 1, height - 1)
    left, right = left % width, (left + 1) % width
    below = pixels[low, left] * (1.0 - across) + pixels[low, right] * across
    above = pixels[high, left] * (1.0 - across) + pixels[high, right] * across
    return (below * (1.0 - up) + above * up).astype(np.float32)


def _triple(color: Any) -> tuple[float, float, float]:
    r, g, b = (float(value) for value in color[:3])
    return r, g, b
