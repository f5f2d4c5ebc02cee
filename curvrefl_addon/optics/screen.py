# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths at the reflector in pixels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .fermat import towards_eye
from .surfaces.radial_surfaces import Float64Array


@dataclass(frozen=True)
class Screen:
    """What turns lengths at the reflector into pixels: `focal` pixels per radian, or per meter for w = 0 eyes."""

    eye: Float64Array
    """(4,) homogeneous, relative to the star center"""
    focal: float

    def pixels(self, points: Float64Array, offsets: Float64Array) -> Float64Array:
        """Offsets (n, 3) at points (n, 3) as seen from the eye: perpendicular part in pixels, (n, 3)."""
        direction = towards_eye(self.eye, points)
        across = offsets - np.einsum("ij,ij->i", offsets, direction)[:, None] * direction
        return across * self.pixels_per_length(points)[:, None]

    def pixels_per_length(self, points: Float64Array) -> Float64Array:
        """(n,) pixels of a unit length at points (n, 3) across the line of sight."""
        distance = np.linalg.norm(self.eye[:3] - points, axis=1) if self.eye[3] else np.ones(len(points))
        return self.focal / np.maximum(distance, 1e-30)
