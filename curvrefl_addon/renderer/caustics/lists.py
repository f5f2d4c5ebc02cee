# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists of the pieces of light about each place, as records for `caustics/thrown.glsl`. Pure numpy.

A grid for each size: pieces are in that whose cells are a quarter of their size, in all that they touch. Cells are
found by a hash; what shares a list with others is told apart by where it is (Eitz and Lixu, "Hierarchical spatial
hashing for real-time collision detection", 2007).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...optics.scattering.sampler import hash_array
from ...scene.arrays import Float32Array, Float64Array
from ..cells.lookup import PIECE_RECORDS
from .pieces import Pieces

MOST_LEVELS = 12
CELLS_ACROSS = 4.0
"""The extent of a piece"""
FEW = 0.02
"""Share of the pieces that may be smaller than the finest cells, or larger than the coarsest"""
MARGIN = 1e-4
"""By which pieces reach into cells beside them, in cells: what rounding may take for theirs"""
ASIDE = 4e-3
"""Of the finest cells: what lies just on the side of two pieces would have both of them or none"""
LARGEST_RECORD = 1e30


def records_of(pieces: Pieces) -> Float32Array:
    """(n, 4): a head (levels, first list record, first piece record, how far aside places are looked up), for each
    level (cell size, first bucket record, mask of its hash, 0); buckets (first of the list, count), lists of four
    pieces each, PIECE_RECORDS a piece."""
    if pieces.count == 0:
        return np.zeros((1, 4), np.float32)
    kept = _piece_records(pieces)
    low, high = pieces.corners.min(axis=1), pieces.corners.max(axis=1)
    low, high = low - pieces.thickness[:, None], high + pieces.thickness[:, None]
    exponents = np.ceil(np.log2(np.maximum((high - low).max(axis=1), 1e-12) / CELLS_ACROSS)).astype(np.int64)
    finest = int(np.quantile(exponents, FEW, method="lower"))
    finest = max(finest, int(exponents.max()) - MOST_LEVELS + 1)
    levels = np.maximum(exponents, finest) - finest
    buckets, heads = [], []
    entries: list[NDArray[np.int64]] = []
    used = np.unique(levels)
    first_bucket, first_entry = 1 + len(used), 0
    for level in used.tolist():
        mine = np.flatnonzero(levels == level)
        size = 2.0 ** (level + finest)
        hashes, owners = _cells(low[mine] / size, high[mine] / size, kept[mine], size)
        mask = (1 << max(int(np.ceil(np.log2(max(len(hashes), 1)))), 2)) - 1
        # (Two cells of a piece may share a bucket, which has it once.)
        keys = np.sort((hashes & np.uint32(mask)).astype(np.int64) << 32 | mine[owners])
        keys = keys[np.diff(keys, prepend=-1) != 0]
        counts = np.bincount(keys >> 32, minlength=mask + 1)
        starts = first_entry + np.cumsum(counts) - counts
        heads.append((size, first_bucket, mask, 0.0))
        buckets.append(np.stack([starts, counts, np.zeros_like(counts), np.zeros_like(counts)], axis=1))
        entries.append(keys & 0xFFFFFFFF)
        first_bucket += mask + 1
        first_entry += len(keys)
    listed = np.concatenate(entries)
    lists = np.zeros((-(-len(listed) // 4), 4))
    lists.ravel()[: len(listed)] = listed
    head = (len(heads), first_bucket, first_bucket + len(lists), ASIDE * heads[0][0])
    parts = (np.array([head, *heads]), *buckets, lists, kept.reshape(-1, 4))
    return np.concatenate([np.clip(part, -LARGEST_RECORD, LARGEST_RECORD).astype(np.float32) for part in parts])


def _cells(
    low: Float64Array, high: Float64Array, records: Float64Array, size: float
) -> tuple[NDArray[np.uint32], NDArray[np.int64]]:
    """Hashes of the cells that pieces (n,) touch, and which piece that is; `low`, `high` (n, 3) in cells."""
    rounding = MARGIN + 4e-7 * np.maximum(np.abs(low), np.abs(high))
    first = np.floor(low - rounding).astype(np.int64)
    last = np.floor(high + rounding).astype(np.int64)
    hashes, owners = [], []
    most = (last - first).max(axis=0, initial=0)
    half = size * (0.5 + rounding.max(axis=1))
    for step in np.ndindex(*(most + 1).tolist()):
        cell = first + np.array(step)
        inside = np.flatnonzero((cell <= last).all(axis=1))
        if len(inside) == 0:
            continue
        touched = inside[_touch(records[inside], (cell[inside] + 0.5) * size, half[inside])]
        bits = cell[touched].astype(np.uint32)
        with np.errstate(over="ignore"):
            hashes.append(hash_array(bits[:, 0] ^ hash_array(bits[:, 1] ^ hash_array(bits[:, 2]))))
        owners.append(touched)
    return np.concatenate(hashes), np.concatenate(owners)


def _touch(records: Float64Array, middles: Float64Array, half: Float64Array) -> NDArray[np.bool_]:
    """(n,) whether cubes about these middles (n, 3) may hold a place that pieces light: none of the half-spaces that
    these are made of is beside them (for triangles: Akenine-Moeller, "Fast 3D triangle-box overlap testing", 2001)."""
    offset = middles - records[:, 0, :3]
    u_row, v_row, normal = records[:, 1, :3], records[:, 2, :3], records[:, 1:4, 3]

    def along(row: Float64Array) -> tuple[Float64Array, Float64Array]:
        """Where the middle is, and how far the cube reaches from there."""
        return np.einsum("nc,nc->n", row, offset), half * np.abs(row).sum(axis=1)

    u, u_reach = along(u_row)
    v, v_reach = along(v_row)
    w, w_reach = along(u_row + v_row)
    h, h_reach = along(normal)
    off_plane = np.abs(h) > h_reach + records[:, 0, 3]
    return ~off_plane & (u >= -u_reach) & (v >= -v_reach) & (w <= 1.0 + w_reach)


def _piece_records(pieces: Pieces) -> Float64Array:
    """(n, PIECE_RECORDS, 4): corner and thickness; two rows that give the place in the triangle across the light, as
    from its first corner, irradiance and direction, with the plane's normal as their last numbers."""
    records = np.zeros((pieces.count, PIECE_RECORDS, 4))
    a, b, c = (pieces.corners[:, k] for k in range(3))
    along = pieces.directions
    ab, ac = b - a, c - a
    # Rows dual to the two sides, across the light.
    across = np.einsum("nc,nc->n", np.cross(ab, ac), along)
    with np.errstate(divide="ignore", invalid="ignore"):
        records[:, 1, :3] = np.cross(ac, along) / across[:, None]
        records[:, 2, :3] = np.cross(along, ab) / across[:, None]
    records[:, 0, :3], records[:, 0, 3] = a, pieces.thickness
    records[:, 3, :3], records[:, 4, :3] = pieces.irradiance, along
    records[:, 1:4, 3] = pieces.normals
    return np.nan_to_num(records, nan=0.0, posinf=LARGEST_RECORD, neginf=-LARGEST_RECORD)
