# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A map that stands for what one mirror reflects, with the lookup that goes with it.

A lookup is one shader file, `gpu_shaders/<method>.glsl`. Its `vec4 environment_at(vec3 point, vec3 ray)` is what the
map has for the unit reflected ray from a point of the mirror, both in world space; its `vec3 environment_direction` of
the same two is the direction from the map's center, of any length, in which that lies.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ..device.shaders import Piece, flags, named

_SAMPLERS = {
    "environment_cube_vertex": "FLOAT_2D",
    "environment_sphere": "FLOAT_2D",
}
"""Kind of the sampler `environment` by the lookup, where it is no cube"""
_CONSTANTS = {
    "environment_sphere": named("VEC3", "environment_right", "environment_up", "environment_axis"),
    "environment_parallax": {"environment_ball": "VEC4"},
}
"""Push constants of lookups that have some"""


@dataclass(frozen=True, slots=True)
class Environment:
    """What stands for the surroundings of one mirror, in one view."""

    lookup: str
    """Name of its shader: a method of the catalog"""
    radiance: Any
    """Texture of scene-linear radiance"""
    positions: Callable[[], Any]
    """Makes or finds the texture of (world position, object_id; 0 for the background) that is looked up alike"""
    constants: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    """Values of the lookup's push constants"""
    mirror: int = 1
    """Number of the mirror"""

    def bind(self, shader: Any, texture: Any) -> None:
        """Set what `lookup_piece` names, with one of the two textures, on a bound shader."""
        shader.uniform_sampler("environment", texture)
        for name, value in self.constants.items():
            shader.uniform_float(name, value)


def lookup_piece(lookup: str) -> Piece:
    """A lookup's define ENVIRONMENT, sampler, push constants and GLSL."""
    return Piece(
        samplers={"environment": _SAMPLERS.get(lookup, "FLOAT_CUBE")},
        constants=_CONSTANTS.get(lookup, {}),
        defines=flags("ENVIRONMENT"),
        fragment=f"environments/{lookup}.glsl",
    )
