# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What shader nodes make: a surface whose base color and scalars may have textures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from ...arrays import MaterialArrays
from ..node_color import NodeColor, gray
from ..reliefs import Relief

BLACK = NodeColor((0.0, 0.0, 0.0))
WHITE = NodeColor()


@dataclass(frozen=True, slots=True)
class Notes:
    """Causes of remarks."""

    always: list[str] = field(default_factory=list)
    on_scenery: list[str] = field(default_factory=list)
    """Where it is shaded with constants: what is neither a mirror nor seen through"""
    on_paths: list[str] = field(default_factory=list)
    """Where it is one of these"""


@dataclass(frozen=True, slots=True)
class Surface:
    """A material's surface."""

    color: NodeColor
    rest: MaterialArrays
    """All but the base color, the images and the relief"""
    textures: Mapping[str, NodeColor] = field(default_factory=dict)
    """Of 'roughness', 'metallic', 'transmission' and 'alpha' those that are not the same everywhere, as grays; `rest`
    has their means"""
    relief: Relief | None = None
    tangents: str | None = None
    """UV map of the tangent, as `MeshNeeds.uv_map`; None where it needs none"""

    @property
    def is_clear(self) -> bool:
        """All light goes straight on, perhaps tinted."""
        return self.rest.alpha == 0.0 and "alpha" not in self.textures

    @property
    def is_opaque(self) -> bool:
        """No light goes straight on."""
        return self.rest.alpha == 1.0 and "alpha" not in self.textures

    @property
    def is_hidden(self) -> bool:
        """As if there was nothing."""
        return self.is_clear and self.rest.transparent_tint == (1.0, 1.0, 1.0)

    @property
    def only_emits(self) -> bool:
        """Nothing is reflected, and nothing goes through."""
        return self.is_opaque and self.is_matt and self.color == BLACK

    @property
    def is_matt(self) -> bool:
        """Neither glossy nor glass."""
        rest = self.rest
        is_plain = not rest.metallic and not rest.transmission and not rest.specular_level and not rest.coat_weight
        return is_plain and not rest.film_thickness and not self.textures.keys() - {"alpha"}

    def with_scalar(self, name: str, value: NodeColor) -> Surface:
        """With another roughness, metallic, transmission or alpha, from 0 to 1 after a texture's lookup."""
        textures = {key: texture for key, texture in self.textures.items() if key != name}
        if not value.is_constant:
            textures[name] = value
        changes: dict[str, Any] = {name: within(value.mean()[0], 0.0, 1.0)}
        return replace(self, rest=replace(self.rest, **changes), textures=textures)


def matt() -> MaterialArrays:
    """A surface without gloss."""
    return MaterialArrays("", roughness=1.0, specular_level=0.0)


def clear(tint: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> Surface:
    """What all light goes straight through."""
    return Surface(BLACK, replace(matt(), alpha=0.0, transparent_tint=tint))


NOTHING = clear()


def within(number: float, low: float, high: float) -> float:
    """The number between limits; what is not a number stays so."""
    return min(max(number, low), high)


def folded(color: NodeColor) -> NodeColor:
    """A gray without the texture where that is the same everywhere."""
    if color.texture is None:
        return color
    pixels = color.texture.colors()
    if pixels.min() != pixels.max():
        return color
    return gray(float(pixels.reshape(-1)[0]) * color.factor[0])
