# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The eye: one perspective or orthographic view onto the scene."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .arrays import Float64Array


@dataclass(frozen=True)
class View:
    """Matrices of a picture of `width` x `height` pixels (OpenGL clip space, z from -1 to 1)."""

    world_to_view: Float64Array
    """(4, 4)"""
    view_to_clip: Float64Array
    """(4, 4) projection"""
    width: int
    height: int

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
    def place(self) -> Float64Array:
        """(3,) where the view's own origin is in the world."""
        return np.asarray(np.linalg.inv(self.world_to_view)[:3, 3], np.float64)

    def about(self, origin: Float64Array) -> View:
        """The same view of a world whose origin is at the point (3,) of this one."""
        if not origin.any():
            return self
        world_to_view = self.world_to_view.copy()
        world_to_view[:3, 3] += world_to_view[:3, :3] @ origin
        return replace(self, world_to_view=world_to_view)

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

    def project(self, points: Float64Array) -> Float64Array:
        """Pixel coordinates (n, 2), origin bottom left, of world points (n, 3)."""
        # Row by row: as one product with so small a matrix it takes ten times as long for a million points.
        x, y, w = (row[:3] @ points.T + row[3] for row in self.world_to_clip[[0, 1, 3]])
        return np.column_stack([(0.5 * x / w + 0.5) * self.width, (0.5 * y / w + 0.5) * self.height])
