# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The world's background to arrays."""

from __future__ import annotations

import bpy
import numpy as np

from .arrays import WorldArrays
from .materials import read_image


def read_world(world: bpy.types.World | None, warnings: list[str]) -> WorldArrays:
    """Colour, or environment texture with its mapping; what else a world may be gets its plain colour and a warning."""
    if world is None:
        return WorldArrays()
    output = world.node_tree.get_output_node("CYCLES") if world.node_tree else None
    if output is None:
        return WorldArrays(_rgb(world.color))
    if not output.inputs["Surface"].is_linked:
        return WorldArrays()
    background = output.inputs["Surface"].links[0].from_node
    if background.type != "BACKGROUND":
        warnings.append(f'World "{world.name}": the node {background.bl_label} is not supported, its colour is used.')
        return WorldArrays(_rgb(world.color))
    strength = background.inputs["Strength"].default_value
    socket = background.inputs["Color"]
    if not socket.is_linked:
        return WorldArrays(_rgb(np.array(socket.default_value[:3]) * strength))
    texture = socket.links[0].from_node
    if texture.type == "RGB":
        return WorldArrays(_rgb(np.array(texture.outputs[0].default_value[:3]) * strength))
    if texture.type != "TEX_ENVIRONMENT" or texture.projection != "EQUIRECTANGULAR" or texture.image is None:
        warnings.append(
            f'World "{world.name}": only a colour or an equirectangular environment texture is supported; '
            "its viewport colour is used."
        )
        return WorldArrays(_rgb(np.array(world.color) * strength))
    pixels = read_image(texture.image)
    if pixels is None:
        warnings.append(f'World "{world.name}": the image "{texture.image.name}" has no pixels, is its file missing?')
        return WorldArrays(_rgb(np.array(world.color) * strength))
    rotation = _rotation(world, texture, warnings)
    return WorldArrays((strength, strength, strength), np.ascontiguousarray(pixels[..., :3]), rotation)


def _rotation(world: bpy.types.World, texture: bpy.types.Node, warnings: list[str]) -> np.ndarray:
    """(3, 3) from world to image directions."""
    links = texture.inputs["Vector"].links
    if not links:
        return np.eye(3)
    node = links[0].from_node
    if node.type == "TEX_COORD" and links[0].from_socket.name == "Generated":
        return np.eye(3)
    if node.type != "MAPPING" or node.inputs["Rotation"].is_linked:
        warnings.append(f'World "{world.name}": the coordinates of its texture are not supported and left out.')
        return np.eye(3)
    turn = np.array(node.inputs["Rotation"].default_value.to_matrix())
    scale = np.diag(np.array(node.inputs["Scale"].default_value))
    if node.vector_type == "TEXTURE":
        return np.linalg.inv(turn @ scale)
    if any(node.inputs["Location"].default_value) and node.vector_type == "POINT":
        warnings.append(f'World "{world.name}": a mapping that moves the directions is not supported and left out.')
    return turn @ scale


def _rgb(color: object) -> tuple[float, float, float]:
    r, g, b = np.asarray(color, float)[:3]
    return (float(r), float(g), float(b))
