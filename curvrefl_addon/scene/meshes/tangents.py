# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2011-2022 Blender Foundation, Morten S. Mikkelsen (Apache-2.0, zlib)
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tangents of a UV map as mikktspace makes them of triangles, which normal maps are baked for. Pure numpy."""

from __future__ import annotations

import numpy as np

from ..arrays import Float32Array, Float64Array, Int32Array

TINY = 1e-20
"""Areas and lengths under which a triangle has no tangent of its own (squares of single precision's smallest)"""


def corner_tangents(
    triangles: Int32Array, positions: Float32Array, normals: Float32Array, uv: Float32Array
) -> Float32Array:
    """(corners, 4): unit tangent and the sign of the bitangent, sign * cross(normal, tangent).

    `triangles` (n, 3) index corners; the rest are of corners, (corners, 3) and (corners, 2). Triangles that meet in a
    corner of one place, normal and coordinates, and turn the same way round on the map, share a tangent: the mean of
    theirs, by their angles there. A corner without any has (1, 0, 0).
    """
    place, normal, at = (layer[triangles].astype(np.float64) for layer in (positions, normals, uv))
    along, is_turned, is_good = _of_triangles(place, at)
    # What corners that are shared have in common: bit by bit, as one of either sign of 0.
    used = np.unique(triangles)
    layers = np.column_stack([positions[used], normals[used], uv[used]]) + np.float32(0.0)
    _, shared = np.unique(np.ascontiguousarray(layers).view(f"V{4 * layers.shape[1]}").reshape(-1), return_inverse=True)
    number = np.zeros(len(positions), np.int64)
    number[used] = shared.reshape(-1)
    # (Of either way round: a triangle without area on the map goes with what there is.)
    group = 2 * number[triangles] + is_turned[:, None]
    total = np.zeros((2 * (int(number.max(initial=0)) + 1), 3))
    for k in range(3):
        weighted = _weighted(place, normal[:, k], along, k) * is_good[:, None]
        for axis in range(3):
            total[:, axis] += np.bincount(group[:, k], weighted[:, axis], len(total))
    has_any = (total != 0.0).any(axis=1)
    own = np.where(has_any[group] | is_good[:, None], group, group ^ 1)
    tangent = _unit(total)
    tangent[~has_any] = (1.0, 0.0, 0.0)
    result = np.tile(np.array([1.0, 0.0, 0.0, 1.0], np.float32), (len(positions), 1))
    result[triangles, :3] = tangent[own]
    result[triangles, 3] = np.where(own & 1, -1.0, 1.0)
    return result


def _of_triangles(place: Float64Array, at: Float64Array) -> tuple[Float64Array, np.ndarray, np.ndarray]:
    """Unit direction of growing u (n, 3), whether the map turns a triangle over, and whether it gives it an area."""
    d1, d2 = place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]
    t21, t31 = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]
    area = t21[:, 0] * t31[:, 1] - t21[:, 1] * t31[:, 0]
    along = t31[:, 1:] * d1 - t21[:, 1:] * d2
    along *= np.where(area > 0.0, 1.0, -1.0)[:, None]
    is_good = (np.abs(area) > TINY) & (np.einsum("ij,ij->i", along, along) > TINY * TINY)
    return _unit(along), (area <= 0.0).astype(np.int64), is_good


def _weighted(place: Float64Array, normal: Float64Array, along: Float64Array, k: int) -> Float64Array:
    """(n, 3) the triangles' tangents in the planes of their k-th corners' normals, times the angles there."""
    here = place[:, k]
    before = _unit(_in_plane(place[:, (k + 2) % 3] - here, normal))
    after = _unit(_in_plane(place[:, (k + 1) % 3] - here, normal))
    angle = np.arccos(np.clip(np.einsum("ij,ij->i", before, after), -1.0, 1.0))
    return angle[:, None] * _unit(_in_plane(along, normal))


def _in_plane(vectors: Float64Array, normal: Float64Array) -> Float64Array:
    return vectors - normal * np.einsum("ij,ij->i", normal, vectors)[:, None]


def _unit(vectors: Float64Array) -> Float64Array:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0.0)
