# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits triangles that are large as seen from a reflector, so that their curved reflections may be drawn straight.

The papers tessellate their models when loading them. Here an edge is halved while it is longer than `angle` times
its smallest distance to the star centre. That depends on the edge alone, so both its triangles agree and no crack
opens, and not on the eye, so that an orbit splits nothing anew.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..scene.arrays import Float32Array, Float64Array, Int32Array
from .geometry import WorldGeometry

MOST_ROUNDS = 14
"""Halvings of one edge: a floor 16,000 times wider than the distance to the mirror's centre."""
_ROTATIONS = np.array([[0, 1, 2], [1, 2, 0], [2, 0, 1]])


def split_angle(radius_pixels: float, tolerance_pixels: float) -> float:
    """Edge length over distance that keeps the reflected chord within the tolerance.

    An edge that spans the angle a at the centre of a mirror of radius R pixels is reflected as an arc of about a/2,
    whose chord is off by R (a/2)^2 / 8 and, as the reflected ray turns twice as fast as the normal, up to four times
    that towards the silhouette: a = sqrt(8 tolerance / R). R is rounded up to a power of two, so that a slow zoom
    rarely splits anew.
    """
    quantised = 2.0 ** np.ceil(np.log2(max(radius_pixels, 8.0)))
    return float(np.clip(np.sqrt(8.0 * tolerance_pixels / quantised), 0.02, 0.5))


def split_for_reflection(
    geometry: WorldGeometry, center: Float64Array, angle: float, most_triangles: int = 4_000_000
) -> WorldGeometry:
    """The geometry with long edges halved; `center` (3,) is the star centre in world space.

    Stops early before it would pass `most_triangles`.
    """
    relative = geometry.positions - center.astype(np.float32)
    corners = geometry.triangles
    material = geometry.triangle_material
    corner_position = geometry.corner_position
    attributes = [geometry.corner_normals, geometry.corner_uv]
    if geometry.corner_color is not None:
        attributes.append(geometry.corner_color)
    owner = geometry.position_object
    mirror = geometry.corner_mirror

    # Only triangles that were just made, or not yet looked at, can have long edges.
    settled: list[tuple[Int32Array, Int32Array]] = []
    count = len(corners)
    for _ in range(MOST_ROUNDS):
        long_edge = _long_edges(relative, corner_position, corners, angle)
        touched = long_edge.any(axis=1)
        settled.append((corners[~touched], material[~touched]))
        corners, material, long_edge = corners[touched], material[touched], long_edge[touched]
        if len(corners) == 0 or count + 3 * len(corners) > most_triangles:
            break
        start = corners
        end = corners[:, [1, 2, 0]]
        middle, pairs = _number_pairs(start[long_edge], end[long_edge], len(corner_position))
        first, second = corner_position[pairs[:, 0]], corner_position[pairs[:, 1]]
        position_middle, position_pairs = _number_pairs(first, second, len(relative))
        relative = np.concatenate([relative, 0.5 * (relative[position_pairs[:, 0]] + relative[position_pairs[:, 1]])])
        owner = np.concatenate([owner, owner[position_pairs[:, 0]]])
        # Halves of interpolated attributes are kept as they are: normals not renormalised, so that the fragment's
        # interpolation is the unsplit triangle's.
        attributes = [np.concatenate([a, 0.5 * (a[pairs[:, 0]] + a[pairs[:, 1]])]) for a in attributes]
        if mirror is not None:
            mirror = np.concatenate([mirror, mirror[pairs[:, 0]]])
        corner_position = np.concatenate([corner_position, position_middle])
        middles = np.full(corners.shape, -1, np.int32)
        middles[long_edge] = middle
        corners, parents = _subdivide(corners, middles)
        material = material[parents]
        count = sum(len(part[0]) for part in settled) + len(corners)
    settled.append((corners, material))
    if len(corner_position) == len(geometry.corner_position):
        return geometry
    return replace(
        geometry,
        positions=(relative + center.astype(np.float32)).astype(np.float32),
        position_object=owner,
        corner_position=corner_position,
        corner_normals=attributes[0],
        corner_uv=attributes[1],
        corner_color=attributes[2] if geometry.corner_color is not None else None,
        corner_mirror=mirror,
        triangles=np.concatenate([part[0] for part in settled]),
        triangle_material=np.concatenate([part[1] for part in settled]),
    )


def _long_edges(relative: Float32Array, corner_position: Int32Array, corners: Int32Array, angle: float) -> np.ndarray:
    """(triangles, 3): edge k runs from corner k to corner k + 1."""
    places = relative[corner_position[corners]]
    edges = np.roll(places, -1, axis=1) - places
    squared = np.einsum("ijk,ijk->ij", edges, edges)
    along = -np.einsum("ijk,ijk->ij", places, edges) / np.maximum(squared, 1e-30)
    closest = places + np.clip(along, 0.0, 1.0)[..., None] * edges
    return squared > angle**2 * np.einsum("ijk,ijk->ij", closest, closest)


def _number_pairs(first: Int32Array, second: Int32Array, start: int) -> tuple[Int32Array, Int32Array]:
    """New index (n,) from `start` on for each unordered pair, one for equal pairs, and the pairs (m, 2) in order."""
    low, high = np.minimum(first, second).astype(np.int64), np.maximum(first, second).astype(np.int64)
    keys, inverse = np.unique(low << 32 | high, return_inverse=True)
    pairs = np.column_stack([keys >> 32, keys & 0xFFFFFFFF]).astype(np.int32)
    return (inverse + start).astype(np.int32), pairs


def _subdivide(corners: Int32Array, middles: Int32Array) -> tuple[Int32Array, Int32Array]:
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
