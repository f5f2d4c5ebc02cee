# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What shaders need to ask for light that comes from other surfaces (`renderer/indirect`)."""

from __future__ import annotations

from typing import Any, Protocol

from ..device.shaders import Piece

SIDE = 32
"""Cells along the side of each of the nested cubes"""
CELLS = Piece(
    samplers={"cell_table": "FLOAT_2D"},
    constants={"cell_grid": "VEC4", "cell_levels": "FLOAT"},
    defines={"CELL_SIDE": SIDE},
)
"""What `cells.glsl` needs"""


class SurfaceLight(Protocol):
    """Light at patches of surfaces."""

    def bind(self, shader: Any, of_hits: bool) -> None:
        """Set what `CELLS` names on a bound shader, and `patch_light`: `of_hits`: all light at surfaces that rays meet
        after one bounce, else what arrives from other surfaces at what is seen."""
