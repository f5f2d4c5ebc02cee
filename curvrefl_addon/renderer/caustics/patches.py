# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches of what throws light: triangles cut into like pieces, as many as their light is worth. Pure numpy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float64Array, LightArrays
from .casters import Casters, Int64Array

MOST_TIMES = 4
"""So many times the patches that are asked for are made of finer meshes at most; of those that are finer still each map
takes a part, and so it does of all that are finer where patches share no corners"""
ENOUGH = 1.42
"""What wants more patches than this is cut"""
SHIFT = 0.06
"""Of cuts from the middle of sides, in shares of these"""
type LampPoint = tuple[LightArrays, Float64Array]
"""A lamp and the place (4,) on it that shines: homogeneous, w = 0 in the direction of a sun"""


@dataclass(frozen=True, slots=True)
class Points:
    """Corners of patches: those that meet there share them."""

    triangles: Int64Array
    """(m,) among the casters, on one of which each lies"""
    weights: Float64Array
    """(m, 3) of that triangle's corners"""
    lamps: Int64Array
    """(m,) that light them"""

    @property
    def count(self) -> int:
        return len(self.lamps)

    def of(self, chosen: Int64Array | slice) -> Points:
        """Some of them."""
        return Points(self.triangles[chosen], self.weights[chosen], self.lamps[chosen])


@dataclass(frozen=True, slots=True)
class Patches:
    """Pieces of triangles, each lit by one lamp."""

    points: Points
    corners: Int64Array
    """(n, 3) of each patch, among the points"""
    weights: Float64Array
    """(n, 3, 3) of its triangle's corners at each of them"""
    triangles: Int64Array
    """(n,) among the casters"""
    areas: Float64Array
    """(n,) of the patch, times the number of patches that it stands for"""

    @property
    def count(self) -> int:
        return len(self.areas)

    @property
    def lamps(self) -> Int64Array:
        """(n,)"""
        return self.points.lamps[self.corners[:, 0]]

    def quartered(self, chosen: NDArray[np.bool_]) -> Patches:
        """Some of them, each cut through the middles of its sides."""
        weights, triangles, areas = self.weights[chosen], self.triangles[chosen], self.areas[chosen]
        middles = 0.5 * (weights + np.roll(weights, -1, axis=1))
        six = np.concatenate([weights, middles], axis=1)
        points = Points(np.repeat(triangles, 6), six.reshape(-1, 3), np.repeat(self.lamps[chosen], 6))
        # (a, b, c and the middles of ab, bc, ca)
        four = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [4, 5, 3]])
        corners = 6 * np.arange(len(areas))[:, None, None] + four
        parts = six[:, four].reshape(-1, 3, 3)
        return Patches(points, corners.reshape(-1, 3), parts, np.repeat(triangles, 4), np.repeat(0.25 * areas, 4))

    def parted(self) -> Patches:
        """With corners of their own, the first of all patches first."""
        weights = self.weights.transpose(1, 0, 2).reshape(-1, 3)
        points = Points(np.tile(self.triangles, 3), weights, np.tile(self.lamps, 3))
        corners = np.arange(3 * self.count).reshape(3, -1).T
        return Patches(points, corners, self.weights, self.triangles, self.areas)


def patches_of(
    casters: Casters, lamps: Sequence[LampPoint], wanted: int, turn: int, share_corners: bool = True
) -> Patches:
    """About so many, in shares by the light that triangles get; `turn`: number of the map, each of which is cut
    otherwise."""
    most = (MOST_TIMES if share_corners else 1) * wanted
    found = []
    every = np.arange(casters.count)
    shares = [_light_on(casters, every, casters.corners, casters.areas, lamp) for lamp in lamps]
    totals = np.array([share.sum() for share in shares])
    # (A weak lamp's caustic is seen where no other is.)
    worth = np.sqrt(totals)
    for number, share in enumerate(shares):
        if totals[number] <= 0.0:
            continue
        mine = wanted * worth[number] / worth.sum()
        found.append(_cut(casters, lamps[number], number, mine, share, turn, most))
    return joined(found)


def joined(parts: Sequence[Patches]) -> Patches:
    """All, of one or more."""
    if not parts:
        none = np.empty(0, np.int64)
        corners = np.empty((0, 3), np.int64)
        return Patches(Points(none, np.empty((0, 3)), none), corners, np.empty((0, 3, 3)), none, np.empty(0))
    ends = np.cumsum([0, *(part.points.count for part in parts)])
    points = Points(
        np.concatenate([part.points.triangles for part in parts]),
        np.concatenate([part.points.weights for part in parts]),
        np.concatenate([part.points.lamps for part in parts]),
    )
    return Patches(
        points,
        np.concatenate([part.corners + end for part, end in zip(parts, ends[:-1], strict=True)]),
        np.concatenate([part.weights for part in parts]),
        np.concatenate([part.triangles for part in parts]),
        np.concatenate([part.areas for part in parts]),
    )


def to_lamp(points: Float64Array, place: Float64Array) -> tuple[Float64Array, Float64Array]:
    """Unit directions (..., 3) from points to a lamp's place (4,), and how far away it is (...): 1 of a sun."""
    if place[3] == 0.0:
        way = np.broadcast_to(place[:3] / np.linalg.norm(place[:3]), points.shape)
        return way, np.ones(points.shape[:-1])
    way = place[:3] - points
    distance = np.linalg.norm(way, axis=-1)
    return way / np.maximum(distance, 1e-300)[..., None], distance


def _light_on(
    casters: Casters, chosen: Int64Array, corners: Float64Array, areas: Float64Array, lamp: LampPoint
) -> Float64Array:
    """(n,) what parts of the `chosen` triangles (n,), with these corners (n, 3, 3) and areas, may get of a lamp, about;
    0 where they surely get nothing."""
    light, place = lamp
    strength = float(np.abs(light.color).sum())
    way, distance = to_lamp(corners, place)
    cosine = np.einsum("nkc,nc->nk", way, casters.facing[chosen])
    cosine = np.where(casters.is_closed[chosen, None], cosine, np.abs(cosine)).max(axis=1)
    share = strength * areas * np.maximum(cosine, 0.0)
    if light.kind == "SUN":
        return share
    nearest = np.maximum(distance.min(axis=1), 1e-6)
    share /= nearest**2
    shines = -light.matrix[:3, 2]
    ahead = -np.einsum("nkc,c->nk", way, shines / np.linalg.norm(shines))
    if light.kind == "AREA":
        return np.where((ahead > 0.0).any(axis=1), share, 0.0)
    if light.kind == "SPOT":
        middles = corners.mean(axis=1)
        to_middle, away = to_lamp(middles, place)
        reach = np.linalg.norm(corners - middles[:, None], axis=2).max(axis=1)
        off = np.arccos(np.clip(-to_middle @ (shines / np.linalg.norm(shines)), -1.0, 1.0))
        spread = np.arcsin(np.clip((reach + light.radius) / np.maximum(away, 1e-300), 0.0, 1.0))
        share = np.where((off - spread < 0.5 * light.spot_angle) | (reach + light.radius > away), share, 0.0)
    return share


def _cut(
    casters: Casters, point: LampPoint, lamp: int, wanted: float, share: Float64Array, turn: int, most: int
) -> Patches:
    """Triangles into about the `wanted` pieces of as much light of lamp number `lamp` each, by bisection of the longest
    sides, which leaves few long and thin (Rosenberg and Stenger, "A lower bound on the angles of triangles constructed
    by bisecting the longest side", 1975). `share` (n,): light of whole triangles; none of those that get 0."""
    lit = np.flatnonzero(share > 0.0)
    stride = -(-len(lit) // most)
    # (Golden steps: each map takes others.)
    lit = lit[int(turn * 0.618 * stride) % stride :: stride]
    numbers, first, corners = np.unique(casters.numbers[lit], return_index=True, return_inverse=True)
    corners = corners.reshape(-1, 3)
    owners, places = [lit[first // 3]], [np.eye(3)[first % 3]]
    count = len(numbers)
    weights = np.tile(np.eye(3), (len(lit), 1, 1))
    triangles, left, areas = lit, wanted / share.sum() * share[lit], casters.areas[lit]
    # Cut elsewhere in each map, so that their mean has no facets.
    where = 0.5 + SHIFT * (turn % 3 - 1) if turn else 0.5
    scale = wanted / share.sum()
    while (cut := left > ENOUGH).any() and len(left) < max(2 * wanted, len(lit) + 1):
        ends = np.einsum("nkw,nwc->nkc", weights[cut], casters.corners[triangles[cut]])
        longest = np.linalg.norm(np.roll(ends, -1, axis=1) - ends, axis=2).argmax(axis=1)
        # (The longest side first.)
        order = (longest[:, None] + np.arange(3)) % 3
        rows = np.arange(len(order))[:, None]
        a, b, c = np.moveaxis(weights[cut][rows, order], 1, 0)
        p, q, r = corners[cut][rows, order].T
        middle = (1.0 - where) * a + where * b
        number = count + np.arange(len(order))
        count += len(order)
        owners.append(triangles[cut])
        places.append(middle)
        # Replaced by one part, and the other appended.
        weights[cut], corners[cut] = np.stack([a, middle, c], axis=1), np.stack([p, number, r], axis=1)
        weights = np.concatenate([weights, np.stack([middle, b, c], axis=1)])
        corners = np.concatenate([corners, np.stack([number, q, r], axis=1)])
        triangles = np.concatenate([triangles, triangles[cut]])
        areas = np.concatenate([areas, (1.0 - where) * areas[cut]])
        areas[: len(cut)][cut] *= where
        # (A lamp may shine on some of them alone: of a large triangle its light is known once that is cut.)
        made = np.concatenate([np.flatnonzero(cut), np.arange(len(cut), len(areas))])
        ends = np.einsum("nkw,nwc->nkc", weights[made], casters.corners[triangles[made]])
        left = np.concatenate([left, np.zeros(len(areas) - len(left))])
        left[made] = scale * _light_on(casters, triangles[made], ends, areas[made], point)
    points = Points(np.concatenate(owners), np.concatenate(places), np.full(count, lamp))
    kept = left > 0.0
    return Patches(points, corners[kept], weights[kept], triangles[kept], stride * areas[kept])
