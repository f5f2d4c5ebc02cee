# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands with fewer points, where those left out would hardly be seen to lie beside the rest. Pure numpy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .strands import Strands, ways

OF_LENGTH = 0.003
"""Share of its length that a strand may be off by: less than a pixel of one 300 pixels long"""
OF_RADIUS = 0.5
"""The same of its radius at the root, and as a radius may be off"""


def straightened(strands: Strands) -> Strands:
    """Without points that lie near the line between those that are kept; none goes where points have attributes."""
    if len(strands.slots) == 0 or any(len(values) == len(strands.points) for _, values in strands.layers):
        return strands
    _, length = ways(strands)
    widest = np.maximum.reduceat(strands.radii, strands.starts[:-1])
    allowed = np.maximum(OF_LENGTH * length, OF_RADIUS * widest)
    keep = np.zeros(len(strands.points), bool)
    keep[strands.starts[:-1]] = keep[strands.starts[1:] - 1] = True
    first, last = strands.starts[:-1], strands.starts[1:] - 1
    owner = np.arange(len(first))
    while len(first):
        is_long = last - first > 1
        first, last, owner = first[is_long], last[is_long], owner[is_long]
        if len(first) == 0:
            break
        off, thicker = _deviations(strands, first, last)
        bent = (off > allowed[owner]) | (thicker > OF_RADIUS * widest[owner])
        first, last, owner = first[bent], last[bent], owner[bent]
        middle = (first + last) // 2
        keep[middle] = True
        first, last = np.concatenate([first, middle]), np.concatenate([middle, last])
        owner = np.concatenate([owner, owner])
    counts = np.add.reduceat(keep, strands.starts[:-1], dtype=np.int64)
    starts = np.concatenate([[0], np.cumsum(counts)])
    return Strands(strands.points[keep], strands.radii[keep], starts, strands.slots, strands.layers)


def _deviations(
    strands: Strands, first: NDArray[np.int64], last: NDArray[np.int64]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """(m,) how far the points between two of a strand are at most from the line from one to the other, and how far
    their radii are from a mean of those there."""
    counts = last - first - 1
    starts = np.cumsum(counts) - counts
    inner = np.arange(int(counts.sum())) + np.repeat(first + 1 - starts, counts)
    begin, step = strands.points[first], strands.points[last] - strands.points[first]
    squared = np.maximum(np.einsum("ij,ij->i", step, step), np.float32(1e-30))
    away = strands.points[inner] - np.repeat(begin, counts, axis=0)
    along = np.einsum("ij,ij->i", away, np.repeat(step / squared[:, None], counts, axis=0))
    along = np.clip(along, 0.0, 1.0)
    away -= along[:, None] * np.repeat(step, counts, axis=0)
    off = np.sqrt(np.einsum("ij,ij->i", away, away))
    ends = strands.radii[first], strands.radii[last] - strands.radii[first]
    thicker = np.abs(strands.radii[inner] - np.repeat(ends[0], counts) - along * np.repeat(ends[1], counts))
    return np.maximum.reduceat(off, starts), np.maximum.reduceat(thicker, starts)
