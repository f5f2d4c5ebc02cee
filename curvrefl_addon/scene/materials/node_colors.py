# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluates the colors that nodes make: what they do is done to constants and to the pixels of textures alike."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .color_spaces import luminance_weights
from .node_color import Change, NodeColor, gray, plain, spread, triple
from .node_handlers import HANDLERS
from .node_links import NUMBERS, Source


class ColorReader:
    """Evaluates color inputs of one node tree's nodes."""

    def __init__(self, read_texture: Callable[[Source], NodeColor | None], notes: list[str]) -> None:
        """`read_texture` gives the color of texture nodes (None: cannot). `notes` gets what was not understood: what
        is given then stands for nothing.
        """
        self.read_texture = read_texture
        self._notes = notes

    def color(self, source: Source) -> NodeColor:
        """The color at the end of the links `source`; of a number or a vector its three parts."""
        node = source.node
        if node is None:
            return plain(getattr(source.socket, "default_value", 0.0))
        if node.type in ("RGB", "VALUE"):
            return plain(source.socket.default_value)
        if node.type.startswith("TEX_"):
            texture = self.read_texture(source)
            if texture is not None:
                return texture
        handler = HANDLERS.get(node.type)
        found = None if handler is None else handler(self, source)
        if found is None:
            self.note(f"{node.bl_label} nodes {{of}} are more than a color or an image.")
            return gray(0.5)
        return found

    def value(self, source: Source) -> NodeColor:
        """The same where one number is asked for: a gray, the luminance of a color, the mean of a vector."""
        return self._gray(self.color(source), source)

    def vector(self, source: Source, what: str) -> NodeColor:
        """Three parts, constant, else with a note about `what`."""
        color = self.color(source)
        if not color.is_constant:
            self.note(f"{what[:1].upper()}{what[1:]} {{of}} is no constant.")
        return color

    def note(self, cause: str) -> None:
        """Something is not drawn as it is: the `cause` of a remark."""
        self._notes.append(cause)

    def _gray(self, color: NodeColor, source: Source) -> NodeColor:
        if source.socket.type in NUMBERS or (color.is_constant and len(set(color.factor)) == 1):
            return color
        weights = luminance_weights() if source.socket.type == "RGBA" else np.full(3, 1.0 / 3.0)
        return self.made(lambda c: spread(c @ weights.astype(c.dtype)), color)

    def made(self, change: Change, *colors: NodeColor) -> NodeColor:
        """What nodes make of colors, part by part and pixel by pixel."""
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
                    self.note("Textures {of} that one node joins do not lie on each other.")
                    factor = np.array(color.mean(), np.float32)
                else:
                    factor = pixels if color.factor == (1.0, 1.0, 1.0) else factor * pixels
            parts.append(factor)
        return NodeColor(texture=grid.changed(lambda pixels: np.broadcast_to(change(*parts), pixels.shape)))

    def changed(self, source: Source, change: Change, *inputs: str) -> NodeColor:
        """By colors and numbers at the node's inputs, the first of which is the color."""
        first = self.color(source.input(inputs[0]))
        return self.made(change, first, *(self.value(source.input(name)) for name in inputs[1:]))
