# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of a program, as GLSL."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

type Kind = Literal["float", "vector", "color", "vec4"]
"""What a value is: "vector" and "color" are vec3 in GLSL and differ in how they become one number"""


@dataclass(frozen=True, slots=True)
class Expression:
    """A value."""

    text: str
    """GLSL: a name, or a parameter"""
    kind: Kind
    constant: tuple[float, ...] | None = None
    """Where it is the same everywhere and known"""
    low: float = -math.inf
    """No part of it is ever lower"""
    high: float = math.inf

    @property
    def is_constant(self) -> bool:
        return self.constant is not None


def glsl_type(kind: Kind) -> str:
    """Its type in GLSL."""
    return {"float": "float", "vector": "vec3", "color": "vec3", "vec4": "vec4"}[kind]
