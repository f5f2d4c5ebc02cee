# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What shaders need to ask for light that comes from other surfaces (`renderer/indirect`, `renderer/caustics`)."""

from __future__ import annotations

from enum import IntEnum
from typing import Any, Protocol

from ..device.shaders import Piece, named

WALLS = 4
"""Planes about each patch that may end what it stands for"""
SIDE = 32
"""Cells along the side of each of the nested cubes"""
CELLS = Piece(
    samplers=named("FLOAT_2D", "cell_table", "patch_walls"),
    constants={"cell_grid": "VEC4", "cell_levels": "FLOAT"},
    defines={"CELL_SIDE": SIDE, "PATCH_WALLS": WALLS},
)
"""What `cells.glsl` needs"""


PIECE_RECORDS = 5
"""Of a piece of a caustic"""
THROWN = Piece(samplers=named("FLOAT_2D", "thrown"), defines={"PIECE_RECORDS": PIECE_RECORDS})
"""What `caustics/thrown.glsl` needs"""


class At(IntEnum):
    """Which light at patches is asked for."""

    HITS = 0
    """At surfaces that rays meet after one bounce, all but that of lamps"""
    ENDS = 1
    """What other surfaces send to what is seen"""
    ENDS_UNDER_SKY = 2
    """And what the world does"""


class SurfaceLight(Protocol):
    """Light at patches of surfaces."""

    def bind(self, shader: Any, at: At) -> None:
        """Set what `CELLS` names on a bound shader, and `patch_light`."""


class ThrownLight(Protocol):
    """What lamps throw over mirrors and through glass onto surfaces."""

    def bind(self, shader: Any, sub_frame: int) -> None:
        """Set what `THROWN` names on a bound shader."""
