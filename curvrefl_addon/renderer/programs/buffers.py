# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs make of surfaces beside base color and normal, in buffers of which a scene has those that it needs."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..device.shaders import Piece, flags
from ..device.textures import empty_texture

SCALARS, SHINE, LAYERS = "PROGRAM_SCALARS", "PROGRAM_SHINE", "PROGRAM_LAYERS"
"""Buffers, and the defines of shaders that know them (`material_at.glsl`)"""
type Buffers = frozenset[str]
_OF_BUFFERS = {
    SCALARS: ("roughness", "metallic", "transmission", "alpha"),
    SHINE: ("emission", "specular_level"),
    LAYERS: (
        *("coat_weight", "coat_roughness", "coat_tint", "sheen_weight", "sheen_roughness", "sheen_tint"),
        *("specular_tint", "diffuse_roughness", "kind", "translucency", "ior", "anisotropy", "anisotropic_rotation"),
    ),
}
"""Channels in each"""
VARIES_SCALARS, VARIES_SHINE, VARIES_LAYERS = 1, 2, 4
"""Of a material's record: which of them its program fills"""
_VARIES = {SCALARS: VARIES_SCALARS, SHINE: VARIES_SHINE, LAYERS: VARIES_LAYERS}
_FORMATS = {SCALARS: "RGBA16F", SHINE: "RGBA16F", LAYERS: "RGBA32UI"}
_OUTPUTS = {SCALARS: ("scalars_out", "VEC4"), SHINE: ("shine_out", "VEC4"), LAYERS: ("layers_out", "UVEC4")}
_SAMPLERS = {
    SCALARS: ("surface_scalars", "FLOAT_2D"),
    SHINE: ("surface_shine", "FLOAT_2D"),
    LAYERS: ("surface_layers", "UINT_2D"),
}
STORED = frozenset({"base_color", "normal", *(channel for channels in _OF_BUFFERS.values() for channel in channels)})
"""Channels that a program may set; all others are one for a whole material"""
NONE: Buffers = frozenset()


def buffers_for(channels: Iterable[str]) -> Buffers:
    """Those that a program with these channels fills."""
    wanted = set(channels)
    return frozenset(name for name, held in _OF_BUFFERS.items() if not wanted.isdisjoint(held))


def varies_bits(buffers: Buffers) -> int:
    """As one number."""
    return sum(_VARIES[name] for name in buffers)


def fills(buffers: Buffers) -> Piece:
    """For shaders that fill them; its outputs follow those of the surface buffer."""
    outputs = dict(_OUTPUTS[name] for name in _OF_BUFFERS if name in buffers)
    return Piece(outputs=outputs, defines=flags("FILLS_BUFFERS", *sorted(buffers)))


def reads(buffers: Buffers) -> Piece:
    """For shaders that look them up: `MaterialBuffers.bind`."""
    return Piece(
        samplers=dict(_SAMPLERS[name] for name in _OF_BUFFERS if name in buffers), defines=flags(*sorted(buffers))
    )


class MaterialBuffers:
    """Textures of the size of a picture, made when first asked for."""

    def __init__(self, width: int, height: int) -> None:
        self._size = (width, height)
        self._textures: dict[str, Any] = {}

    def textures(self, buffers: Buffers) -> list[Any]:
        """In the order of the outputs of `fills`."""
        return [self._texture(name) for name in _OF_BUFFERS if name in buffers]

    def bind(self, shader: Any, buffers: Buffers) -> None:
        """Set what `reads` names on a bound shader."""
        for name in buffers:
            shader.uniform_sampler(_SAMPLERS[name][0], self._texture(name))

    def _texture(self, name: str) -> Any:
        if name not in self._textures:
            self._textures[name] = empty_texture(*self._size, _FORMATS[name])
        return self._textures[name]
