# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inputs of shader nodes: colors, numbers, and scalars that may have textures."""

from __future__ import annotations

from dataclasses import replace

from ..node_color import NodeColor, gray
from ..node_colors import ColorReader
from ..node_links import Source, find_input, source_of
from ..reliefs import Relief, read_relief
from ..surface_textures import SurfaceTextureReader, bordered
from .surface import Notes, folded, within


class Inputs:
    """Reads the inputs of one material's nodes. What is not drawn goes into the `notes`."""

    def __init__(self, textures: SurfaceTextureReader, notes: Notes, is_fine: bool) -> None:
        """`is_fine`: scalars in all pixels of their textures, else in few, for their means."""
        self.notes = notes
        always = notes.always
        self.colors = ColorReader(lambda source: textures.read(source, always), always)

        def bordered_texture(source: Source) -> NodeColor | None:
            return bordered(textures.read(source, always))

        self.fine = ColorReader(bordered_texture, always)
        """Of colors that may be scalars: textures have their values beyond the border, too"""
        self._scalars = self.fine if is_fine else ColorReader(bordered_texture, always, is_coarse=True)

    def color(self, source: Source, name: str) -> NodeColor:
        return self.colors.color(source.input(name))

    def constant(self, source: Source, name: str) -> tuple[float, float, float]:
        """A color or a vector; a texture's mean, with a note."""
        return self.colors.vector(source.input(name), name.lower()).factor

    def number(self, source: Source, name: str) -> float:
        """A texture's mean, with a note."""
        return self.colors.number(source.input(name), name.lower())

    def within(self, source: Source, name: str, low: float, high: float) -> float:
        """The same between limits."""
        return within(self.number(source, name), low, high)

    def scalar(self, source: Source, name: str) -> NodeColor:
        """A number that may have a texture, as a gray."""
        value = self.without_paint(self._scalars.value(source.input(name)), name.lower())
        value = folded(value)
        if not value.is_constant:
            self.notes.on_scenery.append(f"{name[:1].upper()}{name[1:].lower()} {{of}} is shown as its mean.")
            return value
        return gray(within(value.factor[0], 0.0, 1.0))

    def without_paint(self, value: NodeColor, what: str) -> NodeColor:
        """Without vertex colors, which are for base colors alone."""
        if value.vertex_colors is None:
            return value
        self.notes.always.append(f"Vertex colors in the {what} {{of}} are left out.")
        return replace(value, vertex_colors=None)

    def emission(self, source: Source, color_name: str, strength_name: str) -> tuple[float, float, float]:
        strength = self.colors.value(source.input(strength_name))
        if strength == gray(0.0):
            return 0.0, 0.0, 0.0
        color = self.colors.color(source.input(color_name))
        if strength.is_constant:
            return self.emitted(color.scaled(strength.factor))
        return self.emitted(self.colors.made(lambda c, s: c * s, color, strength))

    def emitted(self, color: NodeColor) -> tuple[float, float, float]:
        """The mean, with a note where that is not all."""
        if not color.is_constant and any(color.factor):
            self.notes.always.append("Emission {of} is shown as its mean.")
        return color.mean()

    def is_at(self, source: Source, name: str, value: float) -> bool:
        """Whether an input has this value everywhere."""
        found = self.colors.value(source.input(name))
        return found.is_constant and abs(found.factor[0] - value) < 1e-6

    def relief(self, source: Source) -> Relief | None:
        normal = source_of(find_input(source.node, "Normal"), source.groups)
        return read_relief(normal, self.colors, self.notes.always)
