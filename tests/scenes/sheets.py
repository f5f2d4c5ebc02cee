# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""What cases of hidden surfaces are made of, and what their pixels must show.

Each has one mirror about the origin (a unit sphere, or one with a lobe), a few flat sheets that shine in one
color, a black world unless said otherwise, and a camera that looks along +Y.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

type Float64Array = NDArray[np.float64]
type Color = tuple[float, float, float]

RED: Color = (1.0, 0.0, 0.0)
GREEN: Color = (0.0, 1.0, 0.0)
BLUE: Color = (0.0, 0.0, 1.0)
YELLOW: Color = (1.0, 1.0, 0.0)
CYAN: Color = (0.0, 1.0, 1.0)
MAGENTA: Color = (1.0, 0.0, 1.0)
WHITE: Color = (1.0, 1.0, 1.0)
BLACK: Color = (0.0, 0.0, 0.0)
SKY: Color = (0.1, 0.2, 0.3)

SIZE = 128
"""Pictures are SIZE x SIZE pixels"""
LENS = 90.0
"""Millimeters on a 36 mm picture"""
MIRROR = "Mirror"


@dataclass(frozen=True, slots=True)
class Sheet:
    """A flat polygon."""

    name: str
    corners: Float64Array
    """(3 or 4, 3)"""
    color: Color
    """Radiance; of a diffuse sheet the reflectance"""
    diffuse: bool = False
    visible_camera: bool = True
    visible_glossy: bool = True
    holdout: bool = False


@dataclass(frozen=True, slots=True)
class Pixel:
    """What a pixel must show. Rows count from the BOTTOM."""

    column: int
    row: int
    color: Color
    shows: str
    """Name of the sheet, directly or in the mirror; '' is the world"""
    in_mirror: bool
    why: str


@dataclass(frozen=True, slots=True)
class Lobe:
    """A bump of the unit sphere around `axis`, `height` high and `width` radians wide; the rest stays a sphere."""

    axis: tuple[float, float, float]
    height: float
    width: float


@dataclass(frozen=True, slots=True)
class Case:
    """One scene and what it must show."""

    name: str
    sheets: tuple[Sheet, ...]
    pixels: tuple[Pixel, ...]
    eye: tuple[float, float, float] = (0.0, -6.0, 0.0)
    orthographic_width: float | None = None
    lobe: Lobe | None = None
    world: Color = BLACK
    sun_toward: tuple[float, float, float] | None = None
    sun_strength: float = 0.0
    """W/m2"""

    def radius(self, directions: Float64Array) -> Float64Array:
        """Distance (n,) of the mirror from the origin in unit directions (n, 3)."""
        if self.lobe is None:
            return np.ones(len(directions))
        axis = np.asarray(self.lobe.axis) / np.linalg.norm(self.lobe.axis)
        angle = np.arccos(np.clip(directions @ axis, -1.0, 1.0))
        return 1.0 + self.lobe.height * np.clip(1.0 - (angle / self.lobe.width) ** 2, 0.0, None) ** 3


def across(origin: Float64Array, direction: Float64Array, distance: float, half: float) -> Float64Array:
    """(4, 3) corners of a square sheet of half width `half`, at right angles across a ray at `distance`."""
    helper = np.array([0.0, 0.0, 1.0]) if abs(direction[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
    first = np.cross(direction, helper)
    first /= np.linalg.norm(first)
    second = np.cross(direction, first)
    center = origin + distance * direction
    return np.array([center + half * (i * first + j * second) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def level(x: tuple[float, float], y: tuple[float, float], z: float) -> Float64Array:
    """(4, 3) corners of a level rectangle, facing up."""
    return np.array([(x[0], y[0], z), (x[1], y[0], z), (x[1], y[1], z), (x[0], y[1], z)], float)
