# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs of worlds and lamps, as the renderer gets them: no bpy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from .program import Program

if TYPE_CHECKING:
    from ..arrays import ImageSource

EMISSION = "emission"
"""The channel that these programs set"""
QUADRATIC, LINEAR, CONSTANT = 0, 1, 2
"""How light falls off: powers of the distance that it is multiplied by"""


@dataclass(frozen=True, slots=True)
class SunDisc:
    """Where a world's program draws a sun, which is small and bright."""

    direction: tuple[float, float, float]
    """Unit, towards its middle"""
    angle: float
    """Its diameter, radians"""


@dataclass(frozen=True, slots=True, eq=False)
class Emitter:
    """What a world's or a lamp's nodes say."""

    program: Program | None
    """Of a world by the direction, which is the `ShadingPoint`'s position; None: the same everywhere"""
    images: tuple[ImageSource, ...] = ()
    """That the program looks up: its own list"""
    discs: tuple[SunDisc, ...] = ()
    """Of a world"""
    falloff: int = QUADRATIC
    """Of a lamp"""
    smoothness: float = 0.0
    """Of a lamp: the squared distance within which its light grows no more"""
