# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The eye: one perspective or orthographic view onto the scene."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Float64Array
from .lens import Lens

DEEPEST = 1.01e5
"""Depths in a projection, farthest over nearest, that are compared as they come: Blender's viewport has 1e5"""
SHALLOW = 1e4
"""Of a projection made to fit what is there: at its far end depths differ by 6e-4 of the distance"""

FITTED_SHARE = 1e3
"""An orthographic view's depths are evenly spaced: it is fitted where it reaches so many times farther than needed"""


def with_depths(view_to_clip: Float64Array, near: float, far: float) -> Float64Array:
    """A projection (4, 4) whose depths go from `near` to `far`, which may be endless if it is a perspective one."""
    result = view_to_clip.copy()
    if view_to_clip[3, 3] != 0.0:
        result[2, 2:] = -2.0 / (far - near), -(far + near) / (far - near)
    elif np.isfinite(far):
        result[2, 2:] = -(1.0 + near / far) / (1.0 - near / far), -2.0 * near / (1.0 - near / far)
    else:
        result[2, 2:] = -1.0, -2.0 * near
    return result


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
    stands_for: int = 1
    """Times as many pixels along a side has the picture that takes its place once nothing moves: what is kept from
    picture to picture, split meshes and maps, is as fine as that one needs"""
    clip: tuple[float, float] | None = None
    """Distances along the line of sight between which things are seen, where the projection is not exact about them"""
    linear_depth: float = 0.0
    """Where it is not 0, surfaces are compared by distance over this one: no projection has room for `clip_range`"""

    @property
    def is_orthographic(self) -> bool:
        return bool(self.view_to_clip[3, 3] != 0.0)

    @cached_property
    def is_mirrored(self) -> bool:
        """Whether left and right are swapped, as by a camera with a negative scale."""
        return bool(np.linalg.det(self.world_to_view[:3, :3]) < 0.0)

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

    @cached_property
    def start(self) -> Float64Array:
        """(4,) homogeneous, the point straight ahead where the lines of sight of a perspective view begin."""
        ahead = -self.world_to_view[2, :3]
        return np.append(self.place + self.clip_range[0] * ahead / np.linalg.norm(ahead), 1.0)

    def about(self, origin: Float64Array) -> View:
        """The same view of a world whose origin is at the point (3,) of this one."""
        if not origin.any():
            return self
        world_to_view = self.world_to_view.copy()
        world_to_view[:3, 3] += world_to_view[:3, :3] @ origin
        return replace(self, world_to_view=world_to_view)

    @cached_property
    def clip_range(self) -> tuple[float, float]:
        """Distances along the line of sight between which things are seen; the second may be endless."""
        if self.clip is not None:
            return self.clip
        slope, offset = float(self.view_to_clip[2, 2]), float(self.view_to_clip[2, 3])
        if self.is_orthographic:
            return (offset + 1.0) / slope, (offset - 1.0) / slope
        return offset / (slope - 1.0), offset / (slope + 1.0) if slope < -1.0 else np.inf

    def fitted(self, nearest: float, farthest: float) -> View:
        """For a picture of things at these distances, or between them, from the eye: seen as this view, and in front of
        each other as far as single precision can tell. Itself where its own projection serves."""
        near, far = self.clip_range
        first, last = max(near, nearest), min(far, farthest)
        if self.is_orthographic:
            if not far - near > FITTED_SHARE * (last - first) > 0.0:
                return self
            return replace(self, view_to_clip=with_depths(self.view_to_clip, first, last), clip=(near, far))
        if far <= DEEPEST * near:
            return self
        last = max(last, 2.0 * first)
        if last <= SHALLOW * first:
            return replace(self, view_to_clip=with_depths(self.view_to_clip, first, last), clip=(near, far))
        # (What is nearer than the projection's near end is drawn all the same, only by itself not told apart.)
        projection = with_depths(self.view_to_clip, max(first, last / SHALLOW), last)
        return replace(self, view_to_clip=projection, clip=(near, far), linear_depth=last)

    @cached_property
    def world_to_volume(self) -> Float64Array:
        """(4, 4) as `world_to_clip`, for telling what is outside of the view for sure."""
        if not self.linear_depth:
            return self.world_to_clip
        projection = self.view_to_clip.copy()
        projection[2] = (0.0, 0.0, 0.0, -self.clip_range[0])
        return projection @ self.world_to_view

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

    def line_of_sight(self, x: float, y: float) -> tuple[Float64Array, Float64Array]:
        """That of `lines_of_sight` through one place: origin (3,) and unit direction (3,)."""
        origins, directions = self.lines_of_sight(np.array([[x, y]]))
        return origins[0], directions[0]

    def lines_of_sight(self, places: Float64Array) -> tuple[Float64Array, Float64Array]:
        """Where lines through places (n, 2) in the picture begin, on the near end (n, 3), and their unit directions
        (n, 3).

        In pixels from the bottom left, also beyond the picture: centers of pixels are at halves.
        """
        clip = np.ones((len(places), 4))
        clip[:, :2], clip[:, 2] = 2.0 * places / (self.width, self.height) - 1.0, -1.0
        near = clip @ np.linalg.inv(self.view_to_clip).T
        near = near[:, :3] / near[:, 3:]
        # (In the view's own space: far from the world's origin a direction is no difference of two places.)
        ways = np.broadcast_to([0.0, 0.0, -1.0], near.shape) if self.is_orthographic else near
        to_world = np.linalg.inv(self.world_to_view)
        ways = ways @ to_world[:3, :3].T
        return near @ to_world[:3, :3].T + to_world[:3, 3], ways / np.linalg.norm(ways, axis=1, keepdims=True)

    @property
    def pixel_centers(self) -> Float64Array:
        """(height * width, 2) places in the picture, row by row from the bottom."""
        y, x = np.mgrid[0 : self.height, 0 : self.width]
        return np.column_stack([x.ravel(), y.ravel()]) + 0.5

    def project(self, points: Float64Array) -> Float64Array:
        """Pixel coordinates (n, 2), origin bottom left, of world points (n, 3)."""
        # Row by row: as one product with so small a matrix it takes ten times as long for a million points.
        x, y, w = (row[:3] @ points.T + row[3] for row in self.world_to_clip[[0, 1, 3]])
        return np.column_stack([(0.5 * x / w + 0.5) * self.width, (0.5 * y / w + 0.5) * self.height])
