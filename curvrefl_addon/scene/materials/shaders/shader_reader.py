# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes of a material: those that the renderer can draw, the nearest one and a note for the rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..node_color import triple
from ..node_links import Source
from ..surface_textures import SurfaceTextureReader
from .bsdfs import BSDFS
from .coverage import Coverage, mixed_with_clear, read_coverage
from .inputs import Inputs
from .surface import BLACK, Notes, Surface, matt


class ShaderReader:
    """One material's shader nodes."""

    def __init__(self, textures: SurfaceTextureReader, notes: Notes, is_fine: bool) -> None:
        """`is_fine`: scalars are wanted in all pixels of their textures. What is not drawn goes into the `notes`."""
        self._notes = notes.always
        self._inputs = Inputs(textures, notes, is_fine)

    @property
    def inputs(self) -> Inputs:
        return self._inputs

    def surface(self, source: Source) -> Surface:
        """The surface of a shader node; black where there is none."""
        node = source.node
        if node is None:
            return Surface(BLACK, matt())
        if source.socket.type != "SHADER":
            # Cycles takes a color for an emission of it.
            color = self._inputs.colors.color(source)
            return Surface(BLACK, replace(matt(), emission=self._inputs.emitted(color)))
        if node.type in BSDFS:
            return BSDFS[node.type](source, self._inputs)
        if node.type == "MIX_SHADER":
            return self._mix(source)
        if node.type == "ADD_SHADER":
            return self._add(source)
        self._notes.append(f"{node.bl_label} {{of}} is drawn as the nearest plain surface.")
        has_color = any(socket.identifier == "Color" for socket in node.inputs)
        return Surface(self._inputs.color(source, "Color") if has_color else BLACK, matt())

    def _mix(self, source: Source) -> Surface:
        factor = read_coverage(source.input("Fac"), self._inputs)
        if factor.is_nothing or factor.is_all:
            return self.surface(source.input("Shader_001" if factor.is_all else "Shader"))
        first, second = (self.surface(source.input(name)) for name in ("Shader", "Shader_001"))
        mixed = mixed_with_clear(first, second, factor, self._inputs)
        if mixed is None:
            mixed = self._mixed_matt(first, second, factor)
        if mixed is not None:
            return mixed
        self._notes.append("Of mixed shaders {of} only the stronger one is drawn.")
        return second if factor.share.mean()[0] > 0.5 else first

    def _mixed_matt(self, first: Surface, second: Surface, factor: Coverage) -> Surface | None:
        """Two diffuse or shining surfaces as one; None where they are not that."""
        both = (first, second)
        if not all(one.is_matt and one.is_opaque for one in both) or first.relief != second.relief:
            return None
        shines = first.rest.emission != second.rest.emission
        if factor.threshold is not None or (shines and not factor.is_constant):
            return None
        colors = self._inputs.colors
        color = colors.made(lambda a, b, f: a + f * (b - a), first.color, second.color, factor.share)
        share = factor.share.factor[0] if factor.is_constant else 0.0
        emission = triple((1.0 - share) * np.array(first.rest.emission) + share * np.array(second.rest.emission))
        return replace(first, color=color, rest=replace(first.rest, emission=emission))

    def _add(self, source: Source) -> Surface:
        first, second = (self.surface(source.input(name)) for name in ("Shader", "Shader_001"))
        if first.only_emits:
            first, second = second, first
        if not second.only_emits:
            self._notes.append("Of added shaders {of} only the first one is drawn.")
            return first
        added = np.array(second.rest.emission)
        if added.any() and first.is_clear:
            self._notes.append("Light {of} that is added to transparency hides what is behind.")
            first = Surface(BLACK, matt())
        elif added.any() and not first.is_opaque:
            # What shines by itself does so where nothing else is, too.
            if "alpha" in first.textures:
                self._notes.append("Light {of} that is added to transparency shines by its mean.")
            added = added / first.rest.alpha
        emission = triple(first.rest.emission + added)
        return replace(first, rest=replace(first.rest, emission=emission))
