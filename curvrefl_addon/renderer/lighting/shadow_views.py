# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where shadow maps look from, and at what: pure numpy.

A map only has to hold what can cast, where something can receive. Faces on the hull of the scene (a floor under it,
a wall round it) can do only one of the two for any one light: lit from the side where the rest of the scene is they
cast on nothing; lit from behind they receive nothing. So a floor does not spread the map of a sun above it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import EVERY_SET, Float64Array
from ..geometry.mesh_pieces import OUTLINE_SLACK, MeshPieces, outline

HULL_PLANES = 16
"""How many of the largest planes are tested for lying on the hull"""
SMALLEST_PLANE = 1e-3
"""Area of a plane's triangles over the scene's squared size"""
FLAT = 1e-4
"""Distance from a plane, over the scene's size, that counts as none"""
LOOSE = 0.02
"""Distance over the scene's size that the box of something that moves may reach through a plane of the hull"""
WIDEST_TANGENT = 2.5
"""A lamp whose receivers and casters lie within this slope of one axis gets one map instead of the six of a cube"""
FAR_AWAY = 0.5
"""Least over greatest distance from a lamp of what casts, above which its map begins there"""
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
    turn: tuple[int, int] = (0, 1)
    """Which of how many maps of one lamp, for what each holds by chance (see `shadow_alpha`)"""
    blocked_by: int = EVERY_SET
    """Bits of the shadow sets of what is drawn into it"""


@dataclass(frozen=True, slots=True)
class HullPlane:
    """A plane with the whole scene on its positive side."""

    normal: Float64Array
    offset: float
    pieces: tuple[tuple[int, int], ...]
    """(instance, piece of its mesh) for all that lies in the plane"""


class SceneExtent:
    """What casts and what receives, seen from any light."""

    def __init__(self, placed: Sequence[tuple[MeshPieces, Float64Array, bool]]) -> None:
        """Per instance the pieces of its mesh, its matrix (4, 4), and whether it casts shadows."""
        points, owner, piece = _placed_outlines(placed)
        self.size = float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0
        self.hull = _hull_planes(placed, points, owner, piece, self.size)
        casts = np.array([item[2] for item in placed], bool)[owner] if len(points) else np.zeros(0, bool)
        # 0: in no plane of the hull, k: in plane k - 1
        group = np.zeros(len(points), np.int64)
        for number, plane in enumerate(self.hull, 1):
            for instance, part in plane.pieces:
                start, stop = np.searchsorted(owner, (instance, instance + 1))
                group[start:stop][piece[start:stop] == part] = number
        # outlines of what casts and of everything: first of what lies in no plane of the hull, then per plane
        groups = [group == number for number in range(len(self.hull) + 1)]
        self._outlines = []
        for chosen in groups:
            whole = outline(points[chosen])
            some = chosen & casts
            self._outlines.append((whole if (some == chosen).all() else outline(points[some]), whole))
        self._caster_balls = _balls(points[casts], group[casts], owner[casts])

    def spares(self, moved: Sequence[int], corners: Float64Array) -> bool:
        """Whether the hull stays what it is when these instances move into boxes with the `corners` (n, 3)."""
        in_hull = {instance for plane in self.hull for instance, _ in plane.pieces}
        if not in_hull.isdisjoint(moved):
            return False
        return all(bool((corners @ plane.normal - plane.offset >= -LOOSE * self.size).all()) for plane in self.hull)

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

    def pieces_in_planes(self, planes: Iterable[int]) -> set[tuple[int, int]]:
        """(instance, piece of its mesh) for all that lies in one of these planes of the hull."""
        return {pair for index in planes for pair in self.hull[index].pieces}

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
            depths = -(cast @ axes[2])
            nearest, deepest = float(depths.min()), float(depths.max())
            if nearest > FAR_AWAY * far:
                # The map's depths are all for what is there: of so far a lamp the others' rounding is meters.
                slack = 0.05 * (deepest - nearest) + 1e-4 * self.size
                near, far = nearest - slack, deepest + slack
            return (_perspective(place, axes, low, high, near, far, resolution, idle),)
        low, high = _widened(np.array([-1.0, -1.0]), np.array([1.0, 1.0]), resolution, 0.0)
        centers, radii, groups = self._caster_balls
        casting = ~np.isin(groups, [index + 1 for index in idle])
        met = meets_faces(place, centers[casting], radii[casting])
        return tuple(
            _perspective(place, axes, low, high, near, far, resolution, idle) if here else None
            for axes, here in zip(CUBE_AXES, met, strict=True)
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


def meets_faces(place: Float64Array, centers: Float64Array, radii: Float64Array) -> list[bool]:
    """Whether any of the balls (n, 3), (n,) may be in each of the six faces of a cube map about `place`."""
    return [_meet_pyramid(centers - place, radii, axes) for axes in CUBE_AXES]


def _meet_pyramid(centers: Float64Array, radii: Float64Array, axes: Float64Array) -> bool:
    """Whether any of the balls, about centers (n, 3) relative to the apex, may meet the 90 degree pyramid along
    -axes[2]."""
    points = centers @ axes.T
    outside = np.zeros(len(centers), bool)
    for side in (points[:, 0], -points[:, 0], points[:, 1], -points[:, 1]):
        outside |= side + points[:, 2] > np.sqrt(2.0) * radii
    return bool(np.any(~outside))


def _placed_outlines(
    placed: Sequence[tuple[MeshPieces, Float64Array, bool]],
) -> tuple[Float64Array, NDArray[np.int64], NDArray[np.int64]]:
    """World points (n, 3) of all outlines in the order of the instances, and the instance and the piece of each."""
    if not placed:
        return np.zeros((0, 3)), np.zeros(0, np.int64), np.zeros(0, np.int64)
    meshes = {id(pieces): pieces for pieces, _, _ in placed}
    number = {key: index for index, key in enumerate(meshes)}
    local = [np.concatenate(pieces.outlines) for pieces in meshes.values()]
    local_piece = [
        np.repeat(np.arange(len(pieces.outlines)), [len(part) for part in pieces.outlines])
        for pieces in meshes.values()
    ]
    sizes = np.array([len(part) for part in local])
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    mesh_of = np.array([number[id(pieces)] for pieces, _, _ in placed])
    counts = sizes[mesh_of]
    owner = np.repeat(np.arange(len(placed)), counts)
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    rows = np.arange(counts.sum()) - first[owner] + starts[mesh_of][owner]
    matrices = np.array([matrix for _, matrix, _ in placed])[owner]
    points = np.concatenate(local)[rows]
    world = np.einsum("nij,nj->ni", matrices[:, :3, :3], points) + matrices[:, :3, 3]
    return world, owner, np.concatenate(local_piece)[rows]


def _hull_planes(
    placed: Sequence[tuple[MeshPieces, Float64Array, bool]],
    points: Float64Array,
    owner: NDArray[np.int64],
    piece: NDArray[np.int64],
    size: float,
) -> tuple[HullPlane, ...]:
    """The largest planes of the instances' meshes that have the whole scene on one side."""
    with_planes = [index for index, (pieces, _, _) in enumerate(placed) if len(pieces.areas)]
    if not with_planes or size == 0.0:
        return ()
    counts = [len(placed[index][0].areas) for index in with_planes]
    instance = np.repeat(with_planes, counts)
    part = np.concatenate([np.arange(1, count + 1) for count in counts])
    normals = np.concatenate([placed[index][0].normals for index in with_planes])
    areas = np.concatenate([placed[index][0].areas for index in with_planes])
    linear = np.array([placed[index][1][:3, :3] for index in with_planes])
    # A plane's normal goes by the inverse transpose, its area by that and the determinant.
    turned = np.repeat(np.linalg.inv(linear).transpose(0, 2, 1), counts, axis=0)
    normals = np.einsum("nij,nj->ni", turned, normals)
    lengths = np.linalg.norm(normals, axis=1)
    areas = areas * lengths * np.abs(np.repeat(np.linalg.det(linear), counts))
    normals /= lengths[:, None]
    key = owner * 256 + piece
    order = np.searchsorted(key, instance * 256 + part)
    through = points[order]
    planes: list[HullPlane] = []
    free = np.ones(len(areas), bool)
    for _ in range(HULL_PLANES):
        if not free.any():
            break
        largest = int(np.argmax(np.where(free, areas, -1.0)))
        normal, offset = normals[largest], float(normals[largest] @ through[largest])
        alike = free & (np.abs(normals @ normal) > 1.0 - FLAT**2) & (np.abs(through @ normal - offset) <= FLAT * size)
        free &= ~alike
        free[largest] = False
        if areas[alike].sum() < SMALLEST_PLANE * size * size:
            if areas[largest] < 1e-2 * SMALLEST_PLANE * size * size:
                break
            continue
        heights = points @ normal - offset
        if heights.min() >= -FLAT * size:
            sign = 1.0
        elif heights.max() <= FLAT * size:
            sign = -1.0
        else:
            continue
        members = tuple(zip(instance[alike].tolist(), part[alike].tolist(), strict=True))
        planes.append(HullPlane(sign * normal, sign * offset, members))
    return tuple(planes)


def _balls(
    points: Float64Array, group: NDArray[np.int64], owner: NDArray[np.int64]
) -> tuple[Float64Array, Float64Array, NDArray[np.int64]]:
    """Balls (centers (n, 3), radii (n,), groups (n,)) around the points of each instance in each group."""
    if len(points) == 0:
        return np.zeros((0, 3)), np.zeros(0), np.zeros(0, np.int64)
    order = np.lexsort((group, owner))
    points, group, owner = points[order], group[order], owner[order]
    starts = np.flatnonzero(np.r_[True, (np.diff(owner) != 0) | (np.diff(group) != 0)])
    low, high = np.minimum.reduceat(points, starts), np.maximum.reduceat(points, starts)
    return 0.5 * (low + high), 0.5 * np.linalg.norm(high - low, axis=1) * OUTLINE_SLACK, group[starts]
