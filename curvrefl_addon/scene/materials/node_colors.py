# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluates the colors that nodes make: what they do is done to constants and to the pixels of textures alike."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ..meshes.attributes import VertexColors
from .color_spaces import luminance_weights
from .node_color import Change, NodeColor, gray, plain, spread, triple
from .node_handlers import HANDLERS
from .node_links import NUMBERS, Source


class ColorReader:
    """Evaluates color inputs of one node tree's nodes."""

    def __init__(
        self, read_texture: Callable[[Source], NodeColor | None], notes: list[str], is_coarse: bool = False
    ) -> None:
        """`read_texture` gives the color of texture nodes (None: cannot). `notes` gets what was not understood,
        as causes of remarks. With `is_coarse` textures have few pixels: for their means.
        """
        self.read_texture = read_texture
        self._notes = notes
        self._is_coarse = is_coarse

    def color(self, source: Source) -> NodeColor:
        """The color at the end of the links `source`; of a number or a vector its three parts."""
        node = source.node
        if node is None:
            return plain(getattr(source.socket, "default_value", 0.0))
        if node.type in ("RGB", "VALUE"):
            return plain(source.socket.default_value)
        if node.type in ("VERTEX_COLOR", "ATTRIBUTE"):
            return self._attribute(source)
        if node.type.startswith("TEX_"):
            texture = self.read_texture(source)
            if texture is not None:
                if self._is_coarse and texture.texture is not None:
                    texture = replace(texture, texture=texture.texture.coarse())
                return texture
        handler = HANDLERS.get(node.type)
        found = None if handler is None else handler(self, source)
        return self.guess(source) if found is None else found

    def value(self, source: Source) -> NodeColor:
        """The same where one number is asked for: a gray, the luminance of a color, the mean of a vector."""
        return self._gray(self.color(source), source)

    def number(self, source: Source, what: str) -> float:
        """The value at the end of the links; a texture's mean, with a note about `what`."""
        coarse = self if self._is_coarse else ColorReader(self.read_texture, self._notes, is_coarse=True)
        color = coarse.value(source)
        if color.vertex_colors is not None:
            self.note(f"Vertex colors in the {what} {{of}} are left out.")
        elif not color.is_constant:
            self.note(f"{what[:1].upper()}{what[1:]} {{of}} is shown as its mean.")
        return color.mean()[0]

    def vector(self, source: Source, what: str) -> NodeColor:
        """Three parts, constant: their means, with a note about `what`."""
        coarse = self if self._is_coarse else ColorReader(self.read_texture, self._notes, is_coarse=True)
        color = coarse.color(source)
        if not color.is_constant:
            self.note(f"{what[:1].upper()}{what[1:]} {{of}} is shown as its mean.")
        return NodeColor(color.mean())

    def note(self, cause: str) -> None:
        """Something is not drawn as it is: the `cause` of a remark."""
        self._notes.append(cause)

    def _gray(self, color: NodeColor, source: Source) -> NodeColor:
        if source.socket.type in NUMBERS or (color.is_constant and len(set(color.factor)) == 1):
            return color
        weights = luminance_weights() if source.socket.type == "RGBA" else np.full(3, 1.0 / 3.0)
        if color.vertex_colors is not None:
            color = self._without_paint(color)
        return self.made(lambda c: spread(c @ weights.astype(c.dtype)), color)

    def _attribute(self, source: Source) -> NodeColor:
        node: Any = source.node
        output = source.socket.identifier
        if node.type == "VERTEX_COLOR":
            return NodeColor(vertex_colors=VertexColors(node.layer_name, output, is_painted=True))
        if node.attribute_type != "GEOMETRY":
            self.note(f"Attributes of the {node.attribute_type.lower().replace('_', ' ')} {{of}} are drawn as gray.")
            return gray(0.5)
        if not node.attribute_name:
            return gray(1.0 if output == "Alpha" else 0.0)
        return NodeColor(vertex_colors=VertexColors(node.attribute_name, "Color" if output == "Vector" else output))

    def made(self, change: Change, *colors: NodeColor) -> NodeColor:
        """What nodes make of colors, part by part and pixel by pixel."""
        colors = tuple(color if color.vertex_colors is None else self._without_paint(color) for color in colors)
        textures = [color.texture for color in colors if color.texture is not None]
        if not textures:
            return NodeColor(triple(change(*(np.array(color.factor) for color in colors))))
        grid = max(textures, key=lambda texture: texture.colors().size)
        parts = []
        for color in colors:
            factor = np.array(color.factor, np.float32)
            if color.texture is not None:
                pixels = grid.aligned(color.texture)
                if pixels is None:
                    self.note("Of the textures {of} that one node joins, one is drawn as its mean.")
                    factor = np.array(color.mean(), np.float32)
                else:
                    factor = pixels if color.factor == (1.0, 1.0, 1.0) else factor * pixels
            parts.append(factor)
        return NodeColor(texture=grid.changed(lambda pixels: np.broadcast_to(change(*parts), pixels.shape)))

    def _without_paint(self, color: NodeColor) -> NodeColor:
        self.note("Vertex colors {of} that a node changes are left out.")
        return replace(color, vertex_colors=None)

    def changed(self, source: Source, change: Change, *inputs: str) -> NodeColor:
        """By colors and numbers at the node's inputs, the first of which is the color."""
        first = self.color(source.input(inputs[0]))
        return self.made(change, first, *(self.value(source.input(name)) for name in inputs[1:]))

    def guess(self, source: Source) -> NodeColor:
        """The nearest constant of a node that is not understood."""
        node: Any = source.node
        if node.type == "TEX_CHECKER":
            ends = [self.color(source.input(name)).mean() for name in ("Color1", "Color2")]
            constant = NodeColor(triple(np.mean(ends, axis=0)))
        else:
            through = next((socket for socket in node.inputs if socket.type == "RGBA"), None)
            constant = gray(0.5) if through is None else NodeColor(self.color(source.input(through.identifier)).mean())
        self.note(f"{node.bl_label} nodes {{of}} are drawn as one color.")
        return constant
