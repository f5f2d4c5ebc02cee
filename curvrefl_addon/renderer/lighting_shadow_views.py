# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where shadow maps look from, and at what: pure numpy.

A map only has to hold what can cast, where something can receive. Faces on the hull of the scene (a floor under it,
a wall round it) can do only one of the two for any one light: lit from the side where the rest of the scene is they
cast on nothing; lit from behind they receive nothing. So a floor does not spread the map of a sun above it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..scene.arrays import Float64Array, Int32Array

HULL_PLANES = 16
"""How many of the largest planes are tested for lying on the hull"""
WIDEST_TANGENT = 2.5
"""A lamp whose receivers and casters lie within this slope of one axis gets one map instead of the six of a cube"""
LARGEST_TRIANGLES = 50_000
"""How many triangles, the largest ones, are searched for such planes"""
OUTLINE_DIRECTIONS = 128
OUTLINE_SLACK = 1.01
"""Grows an outline of many positions, which may lie inside of the true one by half the directions' spacing squared"""
MARGIN_TEXELS = 2.0
"""Free border of a fitted map"""


@dataclass(frozen=True, slots=True)
class ShadowView:
    """One depth map's projection, and what need not be drawn into it."""

    world_to_clip: Float64Array
    """(4, 4); w is 1 everywhere for parallel light"""
    is_perspective: bool
    texel_slope: float
    """Size of a texel over distance (perspective) or over the map's depth range (parallel)"""
    depth_terms: tuple[float, float] = (0.0, 0.0)
    """Perspective: depth in the window, 0..1, is the first plus the second over the distance along the axis"""
    idle_planes: frozenset[int] = frozenset()
    """Planes of `SceneExtent.hull` whose triangles cast on nothing"""


@dataclass(frozen=True, slots=True)
class HullPlane:
    """A plane with the whole scene on its positive side, and the triangles that lie in it."""

    normal: Float64Array
    offset: float
    triangles: Int32Array


class SceneExtent:
    """What casts and what receives, seen from any light."""

    def __init__(self, positions: np.ndarray, triangles: Int32Array, casts: np.ndarray) -> None:
        """`positions` (n, 3), `triangles` (t, 3) into them, `casts` (t,) bool."""
        self.positions = np.asarray(positions, np.float64)
        self.triangles = triangles
        self.casts = casts
        self.size = float(np.linalg.norm(np.ptp(self.positions, axis=0))) if len(positions) else 0.0
        self.hull = _hull_planes(self.positions, triangles, self.size)
        free = ~self.in_planes(frozenset(range(len(self.hull))))
        groups: list[np.ndarray] = [np.flatnonzero(free), *(plane.triangles for plane in self.hull)]
        # outlines of what casts and of everything: first of what lies in no plane of the hull, then per plane
        self._outlines = [(self._outline(group[casts[group]]), self._outline(group)) for group in groups]

    def split_by(self, light: Float64Array) -> tuple[frozenset[int], Float64Array, Float64Array]:
        """For a light (homogeneous place, w = 0: direction to it) the planes that cast on nothing, and outlines
        (n, 3) of the triangles that may cast and of those that may receive."""
        idle = frozenset(
            index
            for index, plane in enumerate(self.hull)
            if float(plane.normal @ light[:3]) - plane.offset * float(light[3]) > 0.0
        )
        casters, receivers = [self._outlines[0][0]], [self._outlines[0][1]]
        for index in range(len(self.hull)):
            if index in idle:
                receivers.append(self._outlines[1 + index][1])
            else:
                casters.append(self._outlines[1 + index][0])
        return idle, np.concatenate(casters), np.concatenate(receivers)

    def _outline(self, chosen: np.ndarray) -> Float64Array:
        """(n, 3) positions of the chosen triangles; of many those farthest out in OUTLINE_DIRECTIONS directions."""
        used = np.zeros(len(self.positions), bool)
        used[self.triangles[chosen].ravel()] = True
        points = self.positions[used]
        if len(points) <= 4 * OUTLINE_DIRECTIONS:
            return points
        index = np.arange(OUTLINE_DIRECTIONS) + 0.5
        height = 1.0 - 2.0 * index / OUTLINE_DIRECTIONS
        turn = np.pi * (1.0 + np.sqrt(5.0)) * index
        flat = np.sqrt(1.0 - height**2)
        directions = np.column_stack([flat * np.cos(turn), flat * np.sin(turn), height]).astype(np.float32)
        small = points.astype(np.float32)
        farthest = {int(np.argmax(small @ direction)) for direction in directions}
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        return middle + (points[sorted(farthest)] - middle) * OUTLINE_SLACK

    def in_planes(self, planes: frozenset[int]) -> np.ndarray:
        """(triangles,) bool: lies in one of these planes of the hull."""
        mask = np.zeros(len(self.triangles), bool)
        for index in planes:
            mask[self.hull[index].triangles] = True
        return mask

    def parallel_view(self, to_light: Float64Array, resolution: int) -> ShadowView | None:
        """Map of parallel light from the unit direction `to_light`; None where nothing can be in shadow."""
        idle, casters, receivers = self.split_by(np.append(to_light, 0.0))
        if len(casters) == 0 or len(receivers) == 0:
            return None
        axes = _axes(to_light)
        cast, receive = casters @ axes.T, receivers @ axes.T
        low = np.maximum(cast[:, :2].min(axis=0), receive[:, :2].min(axis=0))
        high = np.minimum(cast[:, :2].max(axis=0), receive[:, :2].max(axis=0))
        if np.any(high < low):
            return None
        low, high = _widened(low, high, resolution, 1e-4 * self.size)
        near, far = float(cast[:, 2].max()), float(min(cast[:, 2].min(), receive[:, 2].min()))
        depth = max(near - far, 1e-4 * self.size)
        near, far = near + 0.01 * depth, far - 0.01 * depth
        matrix = np.eye(4)
        matrix[0, :3] = 2.0 * axes[0] / (high[0] - low[0])
        matrix[0, 3] = -(high[0] + low[0]) / (high[0] - low[0])
        matrix[1, :3] = 2.0 * axes[1] / (high[1] - low[1])
        matrix[1, 3] = -(high[1] + low[1]) / (high[1] - low[1])
        matrix[2, :3] = -2.0 * axes[2] / (near - far)
        matrix[2, 3] = (near + far) / (near - far)
        texel = float(np.max(high - low)) / resolution
        return ShadowView(matrix, False, texel / (near - far), idle_planes=idle)

    def point_views(self, place: Float64Array, resolution: int) -> tuple[ShadowView | None, ...]:
        """One fitted map, or the six of a cube (+X, -X, +Y, -Y, +Z, -Z; None for empty faces); () without shadows."""
        idle, casters, receivers = self.split_by(np.append(place, 1.0))
        if len(casters) == 0 or len(receivers) == 0:
            return ()
        cast, receive = casters - place, receivers - place
        far = 1.05 * float(np.sqrt((cast**2).sum(axis=1).max()))
        near = 1e-3 * far
        axis = 0.5 * (cast.min(axis=0) + cast.max(axis=0))
        length = np.linalg.norm(axis)
        cast_slopes = _slopes(cast @ _axes(-axis / length).T) if length > 0.0 else None
        if cast_slopes is not None and np.all(np.abs(cast_slopes) < WIDEST_TANGENT):
            axes = _axes(-axis / length)
            low, high = cast_slopes
            receive_slopes = _slopes(receive @ axes.T)
            if receive_slopes is not None:
                low, high = np.maximum(low, receive_slopes[0]), np.minimum(high, receive_slopes[1])
                if np.any(high < low):
                    return ()
            low, high = _widened(low, high, resolution, 1e-3)
            return (_perspective(place, axes, low, high, near, far, resolution, idle),)
        low, high = _widened(np.array([-1.0, -1.0]), np.array([1.0, 1.0]), resolution, 0.0)
        casting = self.casts & ~self.in_planes(idle)
        cast_triangles = self.positions[self.triangles[casting]] - place
        return tuple(
            _perspective(place, axes, low, high, near, far, resolution, idle)
            if _meets_pyramid(cast_triangles, axes)
            else None
            for axes in CUBE_AXES
        )


CUBE_AXES = tuple(
    np.array(rows, np.float64)
    for rows in (
        [[0, 1, 0], [0, 0, 1], [-1, 0, 0]],
        [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
        [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
        [[1, 0, 0], [0, 0, 1], [0, 1, 0]],
        [[1, 0, 0], [0, 1, 0], [0, 0, -1]],
        [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
    )
)
"""Rows right, up and backwards of the six faces; some are left-handed, which a depth map does not mind"""


def _axes(backwards: Float64Array) -> Float64Array:
    """(3, 3) rows right, up, backwards of a view along -`backwards`."""
    helper = np.eye(3)[int(np.argmin(np.abs(backwards)))]
    right = np.cross(helper, backwards)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(backwards, right), backwards])


def _slopes(points: Float64Array) -> tuple[Float64Array, Float64Array] | None:
    """Lowest and highest (x, y) / depth of view-space points; None when some lie beside or behind the eye."""
    depth = -points[:, 2]
    if np.any(depth <= 0.05 * np.sqrt((points**2).sum(axis=1))):
        return None
    slopes = points[:, :2] / depth[:, None]
    return slopes.min(axis=0), slopes.max(axis=0)


def _widened(low: Float64Array, high: Float64Array, resolution: int, least: float) -> tuple[Float64Array, Float64Array]:
    """The rectangle with a border of MARGIN_TEXELS, at least `least` wide."""
    middle, half = 0.5 * (low + high), np.maximum(0.5 * (high - low), 0.5 * least)
    half = half * resolution / (resolution - 2.0 * MARGIN_TEXELS)
    return middle - half, middle + half


def _perspective(
    place: Float64Array,
    axes: Float64Array,
    low: Float64Array,
    high: Float64Array,
    near: float,
    far: float,
    resolution: int,
    idle: frozenset[int],
) -> ShadowView:
    """View from `place` with slopes `low` to `high`."""
    clip = np.zeros((4, 4))
    clip[0, 0] = 2.0 / (high[0] - low[0])
    clip[0, 2] = (high[0] + low[0]) / (high[0] - low[0])
    clip[1, 1] = 2.0 / (high[1] - low[1])
    clip[1, 2] = (high[1] + low[1]) / (high[1] - low[1])
    clip[2, 2] = -(far + near) / (far - near)
    clip[2, 3] = -2.0 * far * near / (far - near)
    clip[3, 2] = -1.0
    view = np.eye(4)
    view[:3, :3] = axes
    view[:3, 3] = -axes @ place
    terms = (0.5 * (1.0 + (far + near) / (far - near)), -far * near / (far - near))
    return ShadowView(clip @ view, True, float(np.max(high - low)) / resolution, terms, idle)


def _meets_pyramid(triangles: Float64Array, axes: Float64Array) -> bool:
    """Whether any of the (t, 3, 3) triangles, relative to the apex, may lie in the 90 degree pyramid along -axes[2]."""
    points = triangles @ axes.T
    depth = -points[..., 2] * 1.02
    outside = np.zeros(len(triangles), bool)
    for side in (points[..., 0], -points[..., 0], points[..., 1], -points[..., 1]):
        outside |= np.all(side > depth, axis=1)
    return bool(np.any(~outside))


def _hull_planes(positions: Float64Array, triangles: Int32Array, size: float) -> tuple[HullPlane, ...]:
    """The largest planes that have the whole scene on one side."""
    if len(triangles) == 0 or size == 0.0:
        return ()
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    doubled_area = np.linalg.norm(normals, axis=1)
    if len(triangles) > LARGEST_TRIANGLES:
        largest = np.argpartition(doubled_area, -LARGEST_TRIANGLES)[-LARGEST_TRIANGLES:]
        a, normals, doubled_area = a[largest], normals[largest], doubled_area[largest]
    normals /= np.maximum(doubled_area, 1e-300)[:, None]
    # both sides of a triangle are one plane
    lead = np.argmax(np.abs(normals) > 0.5, axis=1)
    normals *= np.where(normals[np.arange(len(normals)), lead] < 0.0, -1.0, 1.0)[:, None]
    offsets = (normals * a).sum(axis=1) / size
    steps = np.rint(np.column_stack([normals, offsets]) * 4096.0).astype(np.int64) + 8192
    keys = ((steps[:, 0] * 16384 + steps[:, 1]) * 16384 + steps[:, 2]) * 16384 + steps[:, 3] % 16384
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    areas = np.bincount(inverse, doubled_area)
    tolerance = 1e-4 * size
    planes = []
    for group in np.argsort(areas)[::-1][:HULL_PLANES]:
        if areas[group] < 1e-3 * size * size:
            break
        normal = normals[first[group]]
        heights = positions @ normal
        offset = float(normal @ a[first[group]])
        sides = (heights.min() >= offset - tolerance, heights.max() <= offset + tolerance)
        if not any(sides):
            continue
        inside = np.all(np.abs(heights[triangles] - offset) <= tolerance, axis=1)
        members = np.flatnonzero(inside).astype(np.int32)
        sign = 1.0 if sides[0] else -1.0
        planes.append(HullPlane(sign * normal, sign * offset, members))
    return tuple(planes)
