# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of the demo: matte ones of a color or an image, lacquer, glass, and what shines."""

from __future__ import annotations

from typing import Any

import bpy

from ..scene.arrays import Float32Array
from .data_blocks import Color, packed_image, principled


def matte(
    name: str,
    color: Color = (0.8, 0.8, 0.8),
    roughness: float = 0.8,
    pixels: Float32Array | None = None,
) -> bpy.types.Material:
    """Scatters, with next to no gloss: only mirrors reflect objects, so all else is better without reflections.
    `pixels` (height, width, 4), sRGB, take the place of `color`."""
    image = None if pixels is None else packed_image(name, pixels)
    return principled(name, color, roughness=roughness, image=image, sockets={"Specular IOR Level": 0.15})


def lacquer(name: str, color: Color) -> bpy.types.Material:
    """A clear coat over a matte color."""
    sockets = {"Specular IOR Level": 0.15, "Coat Weight": 1.0, "Coat Roughness": 0.02}
    return principled(name, color, roughness=0.6, sockets=sockets)


def glass(name: str, color: Color = (0.97, 0.99, 0.98)) -> bpy.types.Material:
    """Clear solid glass."""
    return principled(name, color, roughness=0.0, sockets={"Transmission Weight": 1.0, "IOR": 1.46})


def glowing(name: str, color: Color, strength: float) -> bpy.types.Material:
    """Matte and white, and shines by itself with the radiance `color` times `strength`."""
    material = principled(name, (0.8, 0.8, 0.8), roughness=0.8, emission=color, sockets={"Specular IOR Level": 0.15})
    tree = material.node_tree
    assert tree is not None
    body: Any = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    body.inputs["Emission Strength"].default_value = strength
    return material
