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

from ....gpu_shaders.loader import load

_SAMPLERS = {
    "environment_cube": "FLOAT_CUBE",
    "environment_cube_vertex": "FLOAT_2D",
    "environment_sphere": "FLOAT_2D",
    "environment_parallax": "FLOAT_CUBE",
}
"""Kind of the sampler `environment` by the lookup"""
_CONSTANTS = {
    "environment_sphere": (("environment_right", "VEC3"), ("environment_up", "VEC3"), ("environment_axis", "VEC3")),
    "environment_parallax": (("environment_ball", "VEC4"),),
}
"""Push constants of lookups that have some"""


@dataclass(frozen=True, slots=True)
class Environment:
    """What stands for the surroundings of one mirror, in one view."""

    lookup: str
    """Name of its shader: a method of the catalogue"""
    radiance: Any
    """Texture of scene-linear radiance"""
    positions: Callable[[], Any]
    """Makes or finds the texture of (world position, object_id; 0 for the background) that is looked up alike"""
    constants: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    """Values of the lookup's push constants"""
    mirror: int = 1
    """Number of the mirror"""

    def bind(self, shader: Any, texture: Any) -> None:
        """Set what `declare` has declared, with one of the two textures, on a bound shader."""
        shader.uniform_sampler("environment", texture)
        for name, value in self.constants.items():
            shader.uniform_float(name, value)


def declare(info: Any, lookup: str, slot: int) -> str:
    """Add a lookup's define ENVIRONMENT, sampler and push constants to a GPUShaderCreateInfo; returns its source."""
    info.define("ENVIRONMENT")
    info.sampler(slot, _SAMPLERS[lookup], "environment")
    for name, kind in _CONSTANTS.get(lookup, ()):
        info.push_constant(kind, name)
    return load(f"environments/{lookup}.glsl")
