# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits triangles that are large as seen from a reflector, so that their curved reflections may be drawn straight.

The papers tessellate their models when loading them. Here an edge is halved while it is longer than `angle` times
its smallest distance to the star center. That depends on the edge alone, so both its triangles agree and no crack
opens, and not on the eye, so that an orbit splits nothing anew.

A mirror that the eye comes closer to wants everything split anew whenever its size in pixels has doubled: all at once
that is a redraw several times as long as the others. What will be needed next is therefore found by and by in the
redraws before, and only looked up then (`SplitAhead`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...scene.arrays import Float32Array, InstanceArrays, Int32Array, MeshArrays

if TYPE_CHECKING:
    from .chunk import Placed
    from .placed_instances import Sight

MOST_ROUNDS = 14
"""Halvings of one edge: a floor 16,000 times wider than the distance to the mirror's center."""
SOON = 1.7
"""A mirror that has to grow by less than this until edges are split anew is about to want that"""
SLACK = 0.8
"""What has to be split again while it moves is split so much finer, so that it need not be at every move"""
TOO_FINE = 3.9
"""Split again where the angle asked for has grown by this factor (a factor of two each way is left alone)"""
SLICE = 0.125
"""Of all that is to be split, at most at once"""
MOST_TRIANGLES = 1 << 15
"""Of what is split ahead: with more it would take a redraw's time by itself, perhaps for nothing"""
_ROTATIONS = np.array([[0, 1, 2], [1, 2, 0], [2, 0, 1]])


def split_angle(radius_pixels: float, tolerance_pixels: float) -> float:
    """Edge length over distance that keeps the reflected chord within the tolerance.

    An edge that spans the angle a at the center of a mirror of radius R pixels is reflected as an arc of about a/2,
    whose chord is off by R (a/2)^2 / 8 and, as the reflected ray turns twice as fast as the normal, up to four times
    that towards the silhouette: a = sqrt(8 tolerance / R). R is rounded up to a power of two, so that a slow zoom
    rarely splits anew.
    """
    return float(np.clip(np.sqrt(8.0 * tolerance_pixels / _quantized(radius_pixels)), 0.02, 0.5))


def share_of_step(radius_pixels: float) -> float:
    """How near a mirror that grows is to where edges are split anew: from 0, at 1 / `SOON` of that size, to 1 there."""
    return float(np.clip(1.0 + np.log(radius_pixels / _quantized(radius_pixels)) / np.log(SOON), 0.0, 1.0))


def _quantized(radius_pixels: float) -> float:
    return float(2.0 ** np.ceil(np.log2(max(radius_pixels, 8.0))))


def longest_edge(mesh: MeshArrays) -> float:
    """Length of the mesh's longest edge, object space."""
    starts = range(0, len(mesh.triangles), _BLOCK)

    def longest_in(start: int) -> float:
        places = mesh.positions[mesh.corner_vertex[mesh.triangles[start : start + _BLOCK]]]
        edges = places[:, [1, 2, 0]] - places
        return float(np.einsum("ijk,ijk->ij", edges, edges).max())

    if len(starts) < 8:
        return float(np.sqrt(max(map(longest_in, starts), default=0.0)))
    # numpy lets go of the interpreter for such arrays.
    with ThreadPoolExecutor(4) as workers:
        return float(np.sqrt(max(workers.map(longest_in, starts))))


_SURELY = 1.0001
"""More than rounding takes"""
_BLOCK = 1 << 15
"""Triangles at a time: their places stay in the cache"""


def has_long_edges(mesh: MeshArrays, relative: Float32Array, angle: float) -> bool:
    """Whether `split_mesh` would split anything; `relative` as there."""
    return any(
        _long_edges(relative, mesh.corner_vertex, mesh.triangles[start : start + _BLOCK], angle).any()
        for start in range(0, len(mesh.triangles), _BLOCK)
    )


def split_mesh(
    mesh: MeshArrays, relative: Float32Array, angle: float, most_triangles: int = 4_000_000
) -> tuple[MeshArrays, Int32Array]:
    """The mesh with long edges halved, and (triangles,) for each of its triangles the mesh's that it is a part of.

    `relative` (vertices, 3): the mesh's vertices in world axes about the star center. Stops early before it would
    pass `most_triangles`.
    """
    corners, corner_vertex = mesh.triangles, mesh.corner_vertex
    parents = np.arange(len(corners), dtype=np.int32)
    vertex_layers = [relative, mesh.positions]
    corner_layers = [mesh.corner_normals]
    if mesh.corner_uv is not None:
        corner_layers.append(mesh.corner_uv)
    if mesh.corner_attributes is not None:
        corner_layers.append(mesh.corner_attributes.reshape(len(corner_vertex), -1))

    # Only triangles that were just made, or not yet looked at, can have long edges.
    settled: list[tuple[Int32Array, Int32Array]] = []
    count = len(corners)
    for _ in range(MOST_ROUNDS):
        long_edge = _long_edges(vertex_layers[0], corner_vertex, corners, angle)
        touched = long_edge.any(axis=1)
        settled.append((corners[~touched], parents[~touched]))
        corners, parents, long_edge = corners[touched], parents[touched], long_edge[touched]
        if len(corners) == 0 or count + 3 * len(corners) > most_triangles:
            break
        start = corners
        end = corners[:, [1, 2, 0]]
        middle, pairs = number_pairs(start[long_edge], end[long_edge], len(corner_vertex))
        first, second = corner_vertex[pairs[:, 0]], corner_vertex[pairs[:, 1]]
        vertex_middle, vertex_pairs = number_pairs(first, second, len(vertex_layers[0]))
        vertex_layers = [_with_middles(layer, vertex_pairs) for layer in vertex_layers]
        # Halves of interpolated attributes are kept as they are: normals not renormalized, so that the fragment's
        # interpolation is the unsplit triangle's.
        corner_layers = [_with_middles(layer, pairs) for layer in corner_layers]
        corner_vertex = np.concatenate([corner_vertex, vertex_middle])
        middles = np.full(corners.shape, -1, np.int32)
        middles[long_edge] = middle
        corners, rows = subdivide(corners, middles)
        parents = parents[rows]
        count = sum(len(part[0]) for part in settled) + len(corners)
    settled.append((corners, parents))
    if len(corner_vertex) == len(mesh.corner_vertex):
        return mesh, np.arange(len(mesh.triangles), dtype=np.int32)
    parents = np.concatenate([part[1] for part in settled])
    rest = iter(corner_layers[1:])
    result = replace(
        mesh,
        positions=vertex_layers[1],
        corner_vertex=corner_vertex,
        corner_normals=corner_layers[0],
        corner_uv=None if mesh.corner_uv is None else next(rest),
        corner_attributes=None
        if mesh.corner_attributes is None
        else next(rest).reshape(-1, *mesh.corner_attributes.shape[1:]),
        triangles=np.concatenate([part[0] for part in settled]),
        triangle_slot=mesh.triangle_slot[parents],
    )
    return result, parents


def _with_middles(layer: Float32Array, pairs: Int32Array) -> Float32Array:
    """The layer (n, k) with the means of the rows `pairs` (m, 2) added."""
    return np.concatenate([layer, np.float32(0.5) * (layer[pairs[:, 0]] + layer[pairs[:, 1]])])


def _long_edges(relative: Float32Array, corner_position: Int32Array, corners: Int32Array, angle: float) -> np.ndarray:
    """(triangles, 3): edge k runs from corner k to corner k + 1."""
    places = np.take(relative, np.take(corner_position, corners), axis=0)
    edges = places[:, [1, 2, 0]] - places
    # Lengths whose squares overflow compare as not long: they are left as they are.
    with np.errstate(over="ignore", invalid="ignore"):
        squared = np.einsum("ijk,ijk->ij", edges, edges)
        # No point of an edge is nearer than its start is, less its length: few edges need a closer look.
        reach = (1.0 + angle) / angle * _SURELY
        found = reach**2 * squared > np.einsum("ijk,ijk->ij", places, places)
        rows, columns = np.nonzero(found)
        start, edge, square = places[rows, columns], edges[rows, columns], squared[rows, columns]
        along = -np.einsum("ij,ij->i", start, edge) / np.maximum(square, 1e-30)
        closest = start + np.clip(along, 0.0, 1.0)[:, None] * edge
        found[rows, columns] = square > angle**2 * np.einsum("ij,ij->i", closest, closest)
        return found


def number_pairs(first: Int32Array, second: Int32Array, start: int) -> tuple[Int32Array, Int32Array]:
    """New index (n,) from `start` on for each unordered pair, one for equal pairs, and the pairs (m, 2) in order."""
    low, high = np.minimum(first, second).astype(np.int64), np.maximum(first, second).astype(np.int64)
    keys, inverse = np.unique(low << 32 | high, return_inverse=True)
    pairs = np.column_stack([keys >> 32, keys & 0xFFFFFFFF]).astype(np.int32)
    return (inverse + start).astype(np.int32), pairs


def subdivide(corners: Int32Array, middles: Int32Array) -> tuple[Int32Array, Int32Array]:
    """Triangles cut at the middles (-1: edge stays) into 2, 3 or 4, and the row each came from."""
    rows = np.arange(len(corners))
    cuts = (middles >= 0).sum(axis=1)
    pieces: list[Int32Array] = []
    parents: list[np.ndarray] = []

    def turned(chosen: np.ndarray, first_edge: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Corners and middles rotated so that `first_edge` comes first."""
        order = _ROTATIONS[first_edge]
        return corners[chosen[:, None], order], middles[chosen[:, None], order]

    def add(chosen: np.ndarray, *triangles: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
        for triangle in triangles:
            pieces.append(np.column_stack(triangle).astype(np.int32))
            parents.append(chosen)

    one = rows[cuts == 1]
    c, m = turned(one, (middles[one] >= 0).argmax(axis=1))
    add(one, (c[:, 0], m[:, 0], c[:, 2]), (m[:, 0], c[:, 1], c[:, 2]))
    # Two cuts: rotated so that the whole edge is the last, the corner between the cuts is corner 1.
    two = rows[cuts == 2]
    c, m = turned(two, ((middles[two] < 0).argmax(axis=1) + 1) % 3)
    add(two, (m[:, 0], c[:, 1], m[:, 1]), (c[:, 0], m[:, 0], m[:, 1]), (c[:, 0], m[:, 1], c[:, 2]))
    three = rows[cuts == 3]
    c, m = corners[three], middles[three]
    add(
        three,
        (c[:, 0], m[:, 0], m[:, 2]),
        (m[:, 0], c[:, 1], m[:, 1]),
        (m[:, 2], m[:, 1], c[:, 2]),
        (m[:, 0], m[:, 1], m[:, 2]),
    )
    return np.concatenate(pieces), np.concatenate(parents)


@dataclass(frozen=True, slots=True)
class _Split:
    """What splitting an instance came to."""

    item: Placed
    """As it was"""
    sights: tuple[Sight, ...]
    drawn: MeshArrays
    parents: Int32Array


class SplitAhead:
    """What instances of a scene will be split into."""

    def __init__(self) -> None:
        self._wanted: list[tuple[float, int]] = []
        """Angle and mirror of the sights that it is for: where the mirrors are may change"""
        self._left: list[tuple[int, tuple[Sight, ...]]] = []
        self._total = 0
        self._found: dict[int, _Split] = {}
        """By instance"""

    def is_new(self, sights: Sequence[Sight]) -> bool:
        """Whether these are others than those that it is at."""
        return self._wanted != _wanted(sights)

    def begin(self, sights: Sequence[Sight], needed: Mapping[int, Sequence[Sight]]) -> None:
        """Be for these; `needed`: instances that may have to be split, and the mirrors that they have to be for."""
        self._wanted = _wanted(sights)
        self._left = [(index, tuple(some)) for index, some in needed.items()]
        self._total = len(self._left)
        self._found = {}

    @property
    def done(self) -> int:
        """How many have been looked at."""
        return self._total - len(self._left)

    def go_on(self, placed: Sequence[Placed], share: float) -> None:
        """Look at more of them until this share of all is done, but at no more than a SLICE."""
        due = int(np.ceil(share * self._total)) - self.done
        for _ in range(min(due, int(np.ceil(SLICE * self._total)))):
            index, sights = self._left.pop()
            item = placed[index]
            is_small = len(item.drawn.triangles) <= MOST_TRIANGLES
            if is_small and any(is_coarse_for(item.drawn, item.instance, sight) for sight in sights):
                self._found[index] = _Split(item, sights, *split_for(item, sights, slack_of(item)))

    def split(
        self, index: int, item: Placed, angle: float, sights: Sequence[Sight], finest: float
    ) -> tuple[MeshArrays, Int32Array] | None:
        """As `split_for`, where an instance that was split with `angle` is too coarse for a mirror or, for the `finest`
        that any needs, far too fine; None where it is fine as it is."""
        if angle * TOO_FINE >= finest and not any(is_coarse_for(item.drawn, item.instance, one) for one in sights):
            return None
        return self.taken(index, item, sights) or split_for(item, sights, slack_of(item))

    def taken(self, index: int, item: Placed, sights: Sequence[Sight]) -> tuple[MeshArrays, Int32Array] | None:
        """What `split_for` would come to, or is as fine; None where that is not known."""
        found = self._found.pop(index, None)
        if found is None or found.item.mesh is not item.mesh:
            return None
        is_same = found.item.instance is item.instance and found.item.drawn is item.drawn
        if is_same and found.sights == tuple(sights):
            return found.drawn, found.parents
        if any(is_coarse_for(found.drawn, item.instance, sight) for sight in sights):
            return None
        return found.drawn, found.parents


def _wanted(sights: Sequence[Sight]) -> list[tuple[float, int]]:
    return [(sight.angle, sight.own) for sight in sights]


def relative_positions(mesh: MeshArrays, instance: InstanceArrays, sight: Sight) -> Float32Array:
    """(vertices, 3) in world axes about the star center."""
    shift = instance.matrix[:3, 3] - np.array(sight.center)
    return mesh.positions @ instance.matrix[:3, :3].T.astype(np.float32) + shift.astype(np.float32)


def is_coarse_for(mesh: MeshArrays, instance: InstanceArrays, sight: Sight) -> bool:
    """Whether a mesh, where an instance puts it, has edges that are too long for a mirror."""
    return has_long_edges(mesh, relative_positions(mesh, instance, sight), sight.angle)


def slack_of(item: Placed) -> float:
    """How much finer than needed an instance is split."""
    return 1.0 if item.drawn is item.mesh else SLACK


def split_for(item: Placed, sights: Sequence[Sight], slack: float) -> tuple[MeshArrays, Int32Array]:
    """The mesh of an instance with the edges halved that are long for some mirrors, `slack` times as finely as they
    need, and the triangle that each of its triangles is a part of."""
    drawn, parents = item.mesh, np.arange(len(item.mesh.triangles), dtype=np.int32)
    for sight in sights:
        drawn, rows = split_mesh(drawn, relative_positions(drawn, item.instance, sight), slack * sight.angle)
        parents = parents[rows]
    return drawn, parents
