# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What shader nodes make: the channels of a material, each a constant or a value of a program."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from ..bits import KIND_GLASS, KIND_GLOSSY_ONLY, KIND_REFRACTION, KIND_THIN_WALL
from ..builder import Builder
from ..expression import Expression
from .arithmetic import constant, is_at, product

GLOSSY_ONLY, THIN_WALL = float(KIND_GLOSSY_ONLY), float(KIND_THIN_WALL)
GLASS, REFRACTION = float(KIND_GLASS), float(KIND_REFRACTION)
"""Bits of the channel "kind", as in `programs/material.glsl`"""

PLAIN_NORMAL = Expression("s.normal", "vector")
BLACK, WHITE = constant(0.0, 0.0, 0.0), constant(1.0, 1.0, 1.0)
NONE, ALL = constant(0.0), constant(1.0)

DEFAULTS: Mapping[str, Expression] = {
    "base_color": BLACK,
    "metallic": NONE,
    "roughness": ALL,
    "ior": constant(1.5),
    "specular_level": NONE,
    "specular_tint": WHITE,
    "emission": BLACK,
    "normal": PLAIN_NORMAL,
    "transmission": NONE,
    "alpha": ALL,
    "transparent_tint": WHITE,
    "coat_weight": NONE,
    "coat_roughness": constant(0.03),
    "coat_ior": constant(1.5),
    "coat_tint": WHITE,
    "sheen_weight": NONE,
    "sheen_roughness": constant(0.5),
    "sheen_tint": WHITE,
    "film_thickness": NONE,
    "film_ior": constant(1.33),
    "anisotropy": NONE,
    "anisotropic_rotation": NONE,
    "diffuse_roughness": NONE,
    "subsurface": NONE,
    "translucency": NONE,
    "kind": NONE,
}
"""All channels, and what they are where they do not matter"""
LAYERS = ("metallic", "transmission", "specular_level", "coat_weight", "sheen_weight", "film_thickness")
"""Channels that are 0 where there is nothing but a diffuse part and emission"""


@dataclass(frozen=True, slots=True)
class Closure:
    """A surface."""

    channels: Mapping[str, Expression]
    """Those that are not here do not matter"""
    is_scalable: bool = False
    """A brighter one is one with brighter colors"""

    def get(self, name: str) -> Expression:
        """A channel, its default where it does not matter."""
        return self.channels.get(name, DEFAULTS[name])

    def has(self, name: str) -> bool:
        return name in self.channels

    def with_(self, is_scalable: bool | None = None, **channels: Expression) -> Closure:
        """With other channels."""
        scalable = self.is_scalable if is_scalable is None else is_scalable
        return replace(self, channels={**self.channels, **channels}, is_scalable=scalable)

    def scaled(self, b: Builder, factor: float) -> Closure:
        """So many times as bright; only of what is scalable."""
        colors = ("base_color", "emission", "transparent_tint", "sheen_tint")
        # (What goes straight on has a tint that need not be among the channels.)
        names = [name for name in colors if name in self.channels]
        if not self.is_opaque and "transparent_tint" not in names:
            names.append("transparent_tint")
        bright = {name: product(b, self.get(name), constant(factor)) for name in names}
        return replace(self, channels={**self.channels, **bright})

    @property
    def is_clear(self) -> bool:
        """All light goes straight on, perhaps tinted."""
        return is_at(self.get("alpha"), 0.0)

    @property
    def is_opaque(self) -> bool:
        """No light goes straight on."""
        return is_at(self.get("alpha"), 1.0)

    @property
    def is_hidden(self) -> bool:
        """As if there was nothing."""
        return self.is_clear and is_at(self.get("transparent_tint"), 1.0)

    @property
    def is_matt(self) -> bool:
        """Neither glossy nor glass: a diffuse part and emission."""
        return all(is_at(self.get(name), 0.0) for name in LAYERS)

    @property
    def is_bare(self) -> bool:
        """Nothing lies over its emission."""
        return all(is_at(self.get(name), 0.0) for name in ("coat_weight", "sheen_weight"))

    @property
    def only_emits(self) -> bool:
        """Nothing is reflected, and nothing goes through."""
        return self.is_opaque and self.is_matt and is_at(self.get("base_color"), 0.0)


def matt(color: Expression, **channels: Expression) -> Closure:
    """A surface without gloss."""
    layers = dict.fromkeys(LAYERS, NONE)
    rest = {"alpha": ALL, "emission": BLACK, "kind": NONE}
    return Closure({"base_color": color, **layers, **rest, **channels}, is_scalable=True)


def shining(emission: Expression) -> Closure:
    """What gives light and does nothing else."""
    return matt(BLACK, emission=emission)


def clear(tint: Expression = WHITE) -> Closure:
    """What all light goes straight through."""
    return Closure({"alpha": NONE, "transparent_tint": tint}, is_scalable=True)
