# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The eye: one perspective or orthographic view onto the scene."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .arrays import Float64Array
from .lens import Lens


@dataclass(frozen=True)
class View:
    """Matrices of a picture of `width` x `height` pixels (OpenGL clip space, z from -1 to 1)."""

    world_to_view: Float64Array
    """(4, 4)"""
    view_to_clip: Float64Array
    """(4, 4) projection"""
    width: int
    height: int
    lens: Lens | None = None
    """Sub-frames look through places on it; None is a pinhole"""

    @property
    def is_orthographic(self) -> bool:
        return bool(self.view_to_clip[3, 3] != 0.0)

    @cached_property
    def eye(self) -> Float64Array:
        """(4,) homogeneous eye: a point with w = 1, or the unit direction towards an infinite eye with w = 0."""
        view_to_world = np.linalg.inv(self.world_to_view)
        if self.is_orthographic:
            axis = view_to_world[:3, 2]
            return np.array([*(axis / np.linalg.norm(axis)), 0.0])
        return np.array([*view_to_world[:3, 3], 1.0])

    @cached_property
    def world_to_clip(self) -> Float64Array:
        """(4, 4)"""
        return self.view_to_clip @ self.world_to_view

    @cached_property
    def clip_to_world(self) -> Float64Array:
        """(4, 4)"""
        return np.linalg.inv(self.world_to_clip)

    @property
    def focal_pixels(self) -> float:
        """Pixels per radian at the picture's center; orthographic: pixels per meter."""
        return 0.5 * self.height * float(self.view_to_clip[1, 1])

    def jittered(self, dx: float, dy: float) -> View:
        """The same view with the picture plane moved by (dx, dy) pixels."""
        shift = np.eye(4)
        shift[0, 3] = 2.0 * dx / self.width
        shift[1, 3] = 2.0 * dy / self.height
        return replace(self, view_to_clip=shift @ self.view_to_clip)

    def through(self, x: float, y: float) -> View:
        """The pinhole at this place on the lens, meters: what is in focus stays where it is in the picture."""
        assert self.lens is not None
        shift, lean = np.eye(4), np.eye(4)
        shift[:2, 3] = (-x, -y)
        lean[:2, 2] = (-x / self.lens.focus, -y / self.lens.focus)
        if self.is_orthographic:
            # All rays lean the same way: the eye is in another direction.
            return replace(self, world_to_view=shift @ lean @ self.world_to_view, lens=None)
        return replace(self, world_to_view=shift @ self.world_to_view, view_to_clip=self.view_to_clip @ lean, lens=None)

    def project(self, points: Float64Array) -> Float64Array:
        """Pixel coordinates (n, 2), origin bottom left, of world points (n, 3)."""
        # Row by row: as one product with so small a matrix it takes ten times as long for a million points.
        x, y, w = (row[:3] @ points.T + row[3] for row in self.world_to_clip[[0, 1, 3]])
        return np.column_stack([(0.5 * x / w + 0.5) * self.width, (0.5 * y / w + 0.5) * self.height])
