# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A bounding-volume hierarchy over boxes, and fitting it to boxes that have moved. Pure numpy; `hierarchy_build` grows
it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float32Array

type IntArray = NDArray[np.int64]
type Boxes = tuple[Float32Array, Float32Array]
"""Lowest and highest corners (items, 3)"""


@dataclass(frozen=True)
class Hierarchy:
    """A binary tree of boxes. Node 0 is the root; the two children of a node are neighbors, and come after it."""

    order: IntArray
    """(items,) the items, leaf by leaf"""
    link: IntArray
    """(nodes,) first of the two children; of a leaf where its items begin in `order`"""
    count: IntArray
    """(nodes,) items of a leaf, 0 of an inner node"""
    levels: tuple[int, ...]
    """First node of each level, and the number of nodes"""
    low: Float32Array = field(repr=False)
    """(nodes, 3)"""
    high: Float32Array = field(repr=False)
    """(nodes, 3)"""

    @cached_property
    def depth(self) -> int:
        """Most nodes between the root and a leaf, both included."""
        depth = np.ones(len(self.link), np.int64)
        for begin, end in zip(self.levels[:-1], self.levels[1:], strict=True):
            inner = begin + np.flatnonzero(self.count[begin:end] == 0)
            depth[self.link[inner]] = depth[self.link[inner] + 1] = depth[inner] + 1
        return int(depth.max())

    def fitted(self, low: Float32Array, high: Float32Array) -> Hierarchy:
        """The same tree over the same items when their boxes (items, 3) have changed."""
        low, high = fit(self.link, self.count, self.levels, *taken(low, high, self.order))
        return replace(self, low=low, high=high)

    def cost(self) -> float:
        """What the heuristic expects of a ray that meets the root: boxes and items it is tested against."""
        areas = half_area(self.low, self.high).astype(np.float64)
        return float((areas * np.where(self.count > 0, self.count, 2)).sum() / max(areas[0], 1e-30))


def half_area(low: Float32Array, high: Float32Array) -> Float32Array:
    """(...,) half the surface of boxes (..., 3)."""
    x, y, z = np.moveaxis(high - low, -1, 0)
    return x * y + y * z + z * x


def taken(low: Float32Array, high: Float32Array, order: IntArray) -> tuple[Float32Array, Float32Array]:
    """Rows in another order (`take` is twice as fast as an index)."""
    return np.take(low, order, axis=0), np.take(high, order, axis=0)


def fit(
    link: IntArray, count: IntArray, levels: tuple[int, ...], low: Float32Array, high: Float32Array
) -> tuple[Float32Array, Float32Array]:
    """Boxes (nodes, 3) of a tree over items' boxes in the tree's order."""
    leaves = np.flatnonzero(count > 0)
    # Leaves in the order of their items: none begin where another does.
    leaf_at = np.full(len(low), -1)
    leaf_at[link[leaves]] = leaves
    by_start = leaf_at[leaf_at >= 0]
    starts = link[by_start]
    node_low, node_high = (np.empty((len(link), 3), np.float32) for _ in range(2))
    for axis in range(3):
        node_low[by_start, axis] = np.minimum.reduceat(np.ascontiguousarray(low[:, axis]), starts)
        node_high[by_start, axis] = np.maximum.reduceat(np.ascontiguousarray(high[:, axis]), starts)
    for begin, end in zip(levels[-2::-1], levels[:0:-1], strict=True):
        inner = begin + np.flatnonzero(count[begin:end] == 0)
        child = link[inner]
        node_low[inner] = np.minimum(node_low[child], node_low[child + 1])
        node_high[inner] = np.maximum(node_high[child], node_high[child + 1])
    return node_low, node_high
