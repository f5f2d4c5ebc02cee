# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that make colors, and an image for them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np

type Tree = bpy.types.NodeTree
type BuildColor = Callable[[Tree], Any]
"""Makes nodes; returns the output with the color"""


def node(tree: Tree, kind: str, inputs: dict[str | int, Any] | None = None, **properties: Any) -> Any:
    """A node with values set and links made."""
    made: Any = tree.nodes.new(kind)
    for name, value in properties.items():
        setattr(made, name, value)
    for name, value in (inputs or {}).items():
        socket = next((s for s in made.inputs if s.identifier == name), None) if isinstance(name, str) else None
        socket = socket or made.inputs[name]
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = value
    return made


COLOR = (0.6, 0.3, 0.1, 1.0)
OTHER = (0.2, 0.5, 0.9, 1.0)


def mix(blend: str, factor: float, **properties: Any) -> BuildColor:
    """Of COLOR and OTHER."""
    return lambda tree: node(
        tree,
        "ShaderNodeMix",
        {"Factor_Float": factor, "A_Color": COLOR, "B_Color": OTHER},
        data_type="RGBA",
        blend_type=blend,
        **properties,
    ).outputs[2]


def smooth_image(name: str = "smooth", float_buffer: bool = True) -> bpy.types.Image:
    """16 x 8 pixels without symmetry."""
    height, width = 8, 16
    y, x = np.mgrid[0:height, 0:width]
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., 0] = 0.5 + 0.4 * np.sin(2.0 * np.pi * x / width)
    pixels[..., 1] = (y + 0.5) / height
    pixels[..., 2] = 0.5 + 0.4 * np.cos(2.0 * np.pi * (x / width + y / height))
    image = bpy.data.images.new(name, width, height, float_buffer=float_buffer)
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    return image
