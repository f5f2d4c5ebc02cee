# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes of a material: those that the renderer can draw, the nearest one and a note for the rest."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import MaterialArrays
from .node_color import NodeColor, gray
from .node_colors import ColorReader
from .node_links import Source, find_input, source_of
from .reliefs import Relief, read_relief
from .surface_textures import SurfaceTextureReader

BLACK = NodeColor((0.0, 0.0, 0.0))

# Inputs of the Principled BSDF that are not drawn unless they are at this value.
_IGNORED = {
    "Subsurface Weight": 0.0,
    "Anisotropic": 0.0,
    "Transmission Weight": 0.0,
    "Coat Weight": 0.0,
    "Sheen Weight": 0.0,
    "Thin Film Thickness": 0.0,
    "Diffuse Roughness": 0.0,
}


@dataclass(frozen=True, slots=True)
class Surface:
    """A material whose base color may still have textures."""

    color: NodeColor
    rest: MaterialArrays
    """All but the base color and the relief"""
    relief: Relief | None = None
    is_hidden: bool = False
    """Light goes through as if there was nothing"""


NOTHING = Surface(BLACK, MaterialArrays("", roughness=1.0, specular_level=0.0), is_hidden=True)
"""What all light goes through"""


class ShaderReader:
    """One material's shader nodes."""

    def __init__(self, textures: SurfaceTextureReader, notes: list[str]) -> None:
        self._notes = notes
        self._colors = ColorReader(lambda source: textures.read(source, notes), notes)

    def surface(self, source: Source) -> Surface:
        """The surface of a shader node; black where there is none. What is not drawn goes into the notes."""
        node = source.node
        if node is None:
            return Surface(BLACK, _matt())
        if source.socket.type != "SHADER":
            # Cycles takes a color for an emission of it.
            color = self._colors.color(source)
            return Surface(BLACK, replace(_matt(), emission=self._emitted(color)))
        kind = node.type
        if kind == "BSDF_PRINCIPLED":
            return self._principled(source)
        if kind == "BSDF_DIFFUSE":
            if self._number(source, "Roughness") > 0.0:
                self._notes.append("Diffuse roughness {of} is left out.")
            return Surface(self._color(source, "Color"), _matt(), self._relief(source))
        if kind == "BSDF_GLOSSY":
            if self._number(source, "Anisotropy") != 0.0:
                self._notes.append("Anisotropy {of} is left out.")
            rest = MaterialArrays("", metallic=1.0, roughness=self._number(source, "Roughness"), glossy_only=True)
            return Surface(self._color(source, "Color"), rest, self._relief(source))
        if kind == "BSDF_METALLIC":
            return self._metallic(source)
        if kind == "EMISSION":
            emission = self._emission(source, "Color", "Strength")
            return Surface(BLACK, replace(_matt(), emission=emission))
        if kind == "BSDF_TRANSPARENT":
            return self._transparent(source)
        if kind == "HOLDOUT":
            self._notes.append("Holdout shaders {of} are drawn black.")
            return Surface(BLACK, _matt())
        if kind == "MIX_SHADER":
            return self._mix(source)
        if kind == "ADD_SHADER":
            return self._add(source)
        return self._unsupported(source)

    def _principled(self, source: Source) -> Surface:
        if self._is_at(source, "Alpha", 0.0):
            return NOTHING
        if not self._is_at(source, "Alpha", 1.0):
            self._notes.append("Transparency by alpha {of} is not shown.")
        for name, neutral in _IGNORED.items():
            if not self._is_at(source, name, neutral):
                self._notes.append(f"{name} {{of}} is not shown.")
        if self._colors.color(source.input("Specular Tint")) != NodeColor():
            self._notes.append("Specular Tint {of} is not shown.")
        rest = MaterialArrays(
            "",
            metallic=min(max(self._number(source, "Metallic"), 0.0), 1.0),
            roughness=min(max(self._number(source, "Roughness"), 0.0), 1.0),
            ior=max(self._number(source, "IOR"), 1e-5),
            specular_level=max(self._number(source, "Specular IOR Level"), 0.0),
            emission=self._emission(source, "Emission Color", "Emission Strength"),
        )
        return Surface(self._color(source, "Base Color"), rest, self._relief(source))

    def _metallic(self, source: Source) -> Surface:
        node = source.node
        assert node is not None
        color = self._color(source, "Base Color")
        if node.fresnel_type == "PHYSICAL_CONDUCTOR":
            ior, extinction = (np.array(self._colors.vector(source.input(n), n).mean()) for n in ("IOR", "Extinction"))
            squared = extinction**2
            r, g, b = (((ior - 1.0) ** 2 + squared) / ((ior + 1.0) ** 2 + squared)).tolist()
            color = NodeColor((r, g, b))
        elif self._colors.color(source.input("Edge Tint")) != NodeColor():
            self._notes.append("Edge Tint {of} is not shown.")
        rest = MaterialArrays("", metallic=1.0, roughness=self._number(source, "Roughness"))
        return Surface(color, rest, self._relief(source))

    def _transparent(self, source: Source) -> Surface:
        color = self._colors.color(source.input("Color"))
        if color == NodeColor():
            return NOTHING
        if color != BLACK:
            self._notes.append("Tinted transparency {of} is drawn as none or as black.")
        return NOTHING if max(color.mean()) > 0.5 else Surface(BLACK, _matt())

    def _mix(self, source: Source) -> Surface:
        factor = min(max(self._colors.number(source.input("Fac"), "mix factor"), 0.0), 1.0)
        first, second = source.input("Shader"), source.input("Shader_001")
        if 0.0 < factor < 1.0 or source.input("Fac").node is not None:
            self._notes.append("Of mixed shaders {of} only the stronger one is drawn.")
        return self.surface(second if factor > 0.5 else first)

    def _add(self, source: Source) -> Surface:
        surfaces = [self.surface(source.input(name)) for name in ("Shader", "Shader_001")]
        first, second = surfaces
        if _only_emits(first):
            first, second = second, first
        if not _only_emits(second):
            self._notes.append("Of added shaders {of} only the first one is drawn.")
            return first
        if first.is_hidden and any(second.rest.emission):
            self._notes.append("Light {of} that is added to transparency hides what is behind.")
            first = Surface(BLACK, _matt())
        r, g, b = np.add(first.rest.emission, second.rest.emission).tolist()
        return replace(first, rest=replace(first.rest, emission=(r, g, b)))

    def _unsupported(self, source: Source) -> Surface:
        node = source.node
        assert node is not None
        self._notes.append(f"{node.bl_label} {{of}} is drawn as the nearest plain surface.")
        inputs = {socket.identifier for socket in node.inputs}
        color = self._color(source, "Color") if "Color" in inputs else BLACK
        if node.type in ("BSDF_GLASS", "BSDF_REFRACTION"):
            # Nothing of its light comes from a diffuse layer.
            color = BLACK
        if node.type == "BSDF_GLASS":
            rest = MaterialArrays("", roughness=self._number(source, "Roughness"), ior=self._number(source, "IOR"))
            return Surface(color, rest)
        return Surface(color, _matt())

    def _color(self, source: Source, name: str) -> NodeColor:
        return self._colors.color(source.input(name))

    def _number(self, source: Source, name: str) -> float:
        return self._colors.number(source.input(name), name.lower())

    def _emission(self, source: Source, color_name: str, strength_name: str) -> tuple[float, float, float]:
        strength = self._colors.value(source.input(strength_name))
        if strength == gray(0.0):
            return 0.0, 0.0, 0.0
        color = self._colors.color(source.input(color_name))
        if strength.is_constant:
            return self._emitted(color.scaled(strength.factor))
        return self._emitted(self._colors.made(lambda c, s: c * s, color, strength))

    def _emitted(self, color: NodeColor) -> tuple[float, float, float]:
        if not color.is_constant and any(color.factor):
            self._notes.append("Emission {of} is shown as its mean.")
        return color.mean()

    def _is_at(self, source: Source, name: str, value: float) -> bool:
        found = self._colors.value(source.input(name))
        return found.is_constant and abs(found.factor[0] - value) < 1e-6

    def _relief(self, source: Source) -> Relief | None:
        node = source.node
        assert node is not None
        normal = source_of(find_input(node, "Normal"), source.groups)
        return read_relief(normal, self._colors, self._notes)


def _matt() -> MaterialArrays:
    """A surface without gloss."""
    return MaterialArrays("", roughness=1.0, specular_level=0.0)


def _only_emits(surface: Surface) -> bool:
    return surface.color == BLACK and surface.rest.specular_level == 0.0 and not surface.is_hidden
