# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Normal Map and Bump nodes at a shader's input "Normal"."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import ImageArrays
from ..meshes.meshes import GENERATED, OBJECT
from .node_color import NodeColor
from .node_colors import ColorReader
from .node_links import Source
from .surface_textures import SurfaceTexture, TextureSpace


@dataclass(frozen=True, slots=True)
class Relief:
    """As `arrays.ReliefArrays`, with the image itself and the texture space it is in."""

    texture: SurfaceTexture
    is_bump: bool
    strength: float
    distance: float = 1.0
    tangents: str = ""
    """UV map whose axes the normals are in, as `MeshNeeds.uv_map`"""


def read_relief(source: Source, colors: ColorReader, notes: list[str]) -> Relief | None:
    """Of the end of the links at an input "Normal"; None where it is plain. What is left out goes into the notes."""
    node: Any = source.node
    if node is None:
        return None
    if node.type == "NORMAL_MAP":
        return _normal_map(source, colors, notes)
    if node.type == "BUMP":
        return _bump(source, colors, notes)
    if node.type != "NEW_GEOMETRY":
        notes.append("Normals {of} that nodes change are drawn unchanged.")
    return None


def _normal_map(source: Source, colors: ColorReader, notes: list[str]) -> Relief | None:
    node: Any = source.node
    if node.space != "TANGENT":
        notes.append("Normal maps {of} that are not in tangent space are left out.")
        return None
    if "Base" in node.inputs and source.input("Base").node is not None:
        notes.append("What is plugged into the base of a normal map {of} is left out.")
    strength = max(colors.number(source.input("Strength"), "normal map strength"), 0.0)
    color = colors.color(source.input("Color"))
    if color.vertex_colors is not None:
        notes.append("Normals {of} out of vertex colors are left out.")
        return None
    tangents = str(node.uv_map)
    texture = color.texture
    if isinstance(texture, SurfaceTexture):
        own = texture.space.uv_map
        if own in (GENERATED, OBJECT) or (own and tangents and own != tangents):
            notes.append("Normal maps {of} are left out: their image is on another UV map than their tangents.")
            return None
        texture = _scaled(texture, color)
    else:
        texture = _constant(node, color)
    return Relief(texture, is_bump=False, strength=strength, tangents=tangents)


def _bump(source: Source, colors: ColorReader, notes: list[str]) -> Relief | None:
    node: Any = source.node
    if source.input("Normal").node is not None:
        notes.append("What is plugged into the normal of a Bump node {of} is left out.")
    height = colors.value(source.input("Height"))
    texture = height.texture
    if not isinstance(texture, SurfaceTexture) or texture.space.uv_map in (GENERATED, OBJECT):
        if source.input("Height").node is not None:
            notes.append("Bumps {of} are left out: their height is no image on a UV map.")
        return None
    texture = _scaled(texture, height)
    strength = max(colors.number(source.input("Strength"), "bump strength"), 0.0)
    distance = colors.number(source.input("Distance"), "bump distance")
    return Relief(texture, True, strength, -distance if node.invert else distance, texture.space.uv_map)


def _scaled(texture: SurfaceTexture, color: NodeColor) -> SurfaceTexture:
    """With the constant that the pixels are multiplied with."""
    if color.factor == (1.0, 1.0, 1.0):
        return texture
    return texture.changed(lambda pixels: pixels * np.array(color.factor, np.float32))


def _constant(node: Any, color: NodeColor) -> SurfaceTexture:
    """The same normal everywhere: an image of one pixel."""
    pixels = np.array([[[*color.factor, 1.0]]], np.float32)
    return SurfaceTexture(ImageArrays(node.name, pixels), TextureSpace(str(node.uv_map)))
