# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The world's background to arrays."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import bpy
import numpy as np

from .arrays import Float32Array, Float64Array, WorldArrays
from .finite import usable_world
from .materials.images import MAGNIFIED, MISSING_COLOR, ImageReader, magnified
from .materials.mappings import mapped_from
from .materials.node_color import Change, NodeColor, gray
from .materials.node_colors import ColorReader
from .materials.node_links import Source, find_input, output_source
from .materials.pixels import bilinear, stretched
from .programs.emitters import world_program
from .programs.images import ProgramImages
from .remarks import Remark

FEWEST_ROWS = 32
"""Of an environment image"""


@dataclass(frozen=True, slots=True)
class WorldImage:
    """A `node_color.Texture` around the scene."""

    pixels: Float32Array
    """(h, w, 3) equirectangular, row 0 at the bottom"""
    rotation: Float64Array
    """(3, 3) from world to image directions, orthogonal"""

    def colors(self) -> Float32Array:
        return self.pixels

    def changed(self, change: Change) -> WorldImage:
        return replace(self, pixels=np.asarray(change(self.pixels), np.float32))

    def aligned(self, other: WorldImage) -> Float32Array | None:
        if not np.allclose(other.rotation, self.rotation, atol=1e-6):
            return None
        return stretched(other.pixels, *self.pixels.shape[:2])


def read_world(
    world: bpy.types.World | None, images: ImageReader, warnings: list[Remark], programs: ProgramImages | None = None
) -> WorldArrays:
    """Background color or environment texture with its mapping, or a program for what is neither.

    `programs`: lists the images that a program looks up.
    """
    if world is None:
        return WorldArrays()
    found = _background(world, images, warnings, programs or ProgramImages())
    # Cycles is an add-on, and may be off.
    rays = getattr(world, "cycles_visibility", None)
    if rays is None:
        return found
    return replace(found, visible_camera=rays.camera, visible_diffuse=rays.diffuse, visible_glossy=rays.glossy)


def _background(
    world: bpy.types.World, images: ImageReader, warnings: list[Remark], programs: ProgramImages
) -> WorldArrays:
    notes: list[str] = []
    if output_source(world.node_tree, "Volume") is not None:
        notes.append("The volume {of} is not shown.")
    source = output_source(world.node_tree, "Surface")
    if source is not None:
        plain: list[str] = []
        result = _WorldReader(images, plain).background(source)
        if plain:
            # More than a color or one image.
            result = world_program(source, programs, notes)
            warnings += programs.remarks
    else:
        # Nodes that end nowhere are black; a world without any, as of old files, is the viewport's color.
        result = WorldArrays() if world.node_tree is not None else WorldArrays(_triple(world.color))
    result = usable_world(result, notes)
    warnings += [Remark(cause, "world", world.name) for cause in dict.fromkeys(notes)]
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
        if node is None:
            return WorldArrays()
        if source.socket.type != "SHADER":
            # Cycles takes a color for a background of it.
            return _world_of(self._colors.color(source))
        if node.type not in ("BACKGROUND", "EMISSION"):
            self._notes.append(f"{node.bl_label} {{of}} is drawn black.")
            return WorldArrays()
        strength = self._colors.value(source.input("Strength"))
        color = self._colors.color(source.input("Color"))
        if strength.is_constant:
            return _world_of(color.scaled(strength.factor))
        return _world_of(self._colors.made(lambda c, s: c * s, color, strength))

    def _texture(self, source: Source) -> NodeColor | None:
        node = source.node
        assert node is not None
        if node.type != "TEX_ENVIRONMENT":
            return None
        is_alpha = source.socket.identifier == "Alpha"
        if node.image is None:
            return gray(1.0) if is_alpha else NodeColor(MISSING_COLOR[:3])
        splits_alpha = "Alpha" in node.outputs and any(not link.is_muted for link in node.outputs["Alpha"].links)
        image = self._images.read(node.image, node.image_user, splits_alpha)
        if node.interpolation == "Closest":
            times = max(MAGNIFIED // max(image.shape[:2]), 1)
            image = image.repeat(times, axis=0).repeat(times, axis=1)
        else:
            image = magnified(node.image, image, True)
        pixels = image[..., 3:].repeat(3, axis=-1) if is_alpha else image[..., :3]
        linear, shift = self._mapping(source)
        is_rotation = not shift.any() and bool(np.allclose(linear @ linear.T, np.eye(3), atol=1e-5))
        if pixels.shape[:2] == (1, 1):
            return NodeColor(_triple(pixels[0, 0]))
        pixels = _enlarged(pixels)
        if node.projection == "MIRROR_BALL" or not is_rotation:
            pixels = _resampled(pixels, node.projection == "MIRROR_BALL", linear, shift)
            linear = np.eye(3)
        return NodeColor(texture=WorldImage(pixels, linear))

    def _mapping(self, source: Source) -> tuple[Float64Array, Float64Array]:
        """(3, 3) and (3,): image direction = matrix @ world direction + shift, up to its length."""
        linear, shift, vector = mapped_from(source, self._colors)
        node = vector.node
        known = node is None or (
            node.type == "TEX_COORD"
            and (vector.socket.name == "Generated" or (vector.socket.name == "Object" and node.object is None))
        )
        if not known or (node is None and vector.socket != find_input(source.node, "Vector")):
            self._notes.append("Coordinates of the texture {of} are taken for the plain direction.")
        return linear, shift


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
    # (Towards its rim a ball holds much of the sky in few pixels.)
    ball_height = max(height, min(8 * height, 1024))
    out_width, out_height = (2 * ball_height, ball_height) if is_mirror_ball else (width, height)
    directions = equirectangular_directions(out_width, out_height) @ linear.T + shift
    lengths = np.linalg.norm(directions, axis=-1, keepdims=True)
    x, y, z = np.moveaxis(directions / np.where(lengths > 0.0, lengths, 1.0), -1, 0)
    if is_mirror_ball:
        # The ball is seen along Y: the picture of direction d is where the ball's normal is halfway to the viewer.
        radius = np.sqrt(np.maximum(2.0 * (1.0 - y), 1e-12))
        u, v = 0.5 * (x / radius + 1.0), 0.5 * (z / radius + 1.0)
    else:
        u, v = 0.5 - np.arctan2(y, x) / (2.0 * np.pi), np.arcsin(np.clip(z, -1.0, 1.0)) / np.pi + 0.5
    return bilinear(pixels, u * width - 0.5, v * height - 0.5)


def _world_of(color: NodeColor) -> WorldArrays:
    if isinstance(color.texture, WorldImage):
        return WorldArrays(color.factor, np.ascontiguousarray(color.texture.pixels), color.texture.rotation)
    return WorldArrays(color.mean())


def _enlarged(pixels: Float32Array) -> Float32Array:
    """An image of few pixels as interpolation shows it: light takes pixels for small parts of the sky."""
    height, width = pixels.shape[:2]
    return stretched(pixels, -(-FEWEST_ROWS // height) * height, -(-2 * FEWEST_ROWS // width) * width)


def _triple(color: Any) -> tuple[float, float, float]:
    r, g, b = (float(value) for value in color[:3])
    return r, g, b
