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
class FitRows:
    """Which rows of a tree's boxes are filled from which: what its links say, whatever the boxes are."""

    leaves: IntArray
    """(leaves,) nodes, in the order of their items"""
    starts: IntArray
    """(leaves,) where their items begin"""
    levels: tuple[tuple[IntArray, IntArray, IntArray], ...]
    """Of each level, the lowest first: inner nodes (n,), and the two children of each"""


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

    @cached_property
    def children(self) -> IntArray:
        """(inner nodes, 2) in the order of the nodes."""
        return self.link[self.count == 0][:, None] + np.arange(2)

    @cached_property
    def fit_rows(self) -> FitRows:
        """For `fit`."""
        return fit_rows(self.link, self.count, self.levels)

    def fitted(self, low: Float32Array, high: Float32Array) -> Hierarchy:
        """The same tree over the same items when their boxes (items, 3) have changed."""
        low, high = fit(self.fit_rows, *taken(low, high, self.order))
        made = replace(self, low=low, high=high)
        # (What follows from the links alone is not found again in each redraw while something moves.)
        made.__dict__.update(depth=self.depth, children=self.children, fit_rows=self.fit_rows)
        return made

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


def fit_rows(link: IntArray, count: IntArray, levels: tuple[int, ...]) -> FitRows:
    """Of a tree's fields (see `Hierarchy`)."""
    leaves = np.flatnonzero(count > 0)
    # Leaves in the order of their items: none begin where another does.
    leaf_at = np.full(int(count.sum()), -1)
    leaf_at[link[leaves]] = leaves
    by_start = leaf_at[leaf_at >= 0]
    inner = [
        begin + np.flatnonzero(count[begin:end] == 0) for begin, end in zip(levels[-2::-1], levels[:0:-1], strict=True)
    ]
    return FitRows(by_start, link[by_start], tuple((rows, link[rows], link[rows] + 1) for rows in inner if len(rows)))


def fit(rows: FitRows, low: Float32Array, high: Float32Array) -> tuple[Float32Array, Float32Array]:
    """Boxes (nodes, 3) of a tree over items' boxes in the tree's order."""
    count = len(rows.leaves) + sum(len(inner) for inner, _, _ in rows.levels)
    # Lowest corners and the highest with their signs turned: one minimum for both.
    bounds = np.empty((count, 6), np.float32)
    if len(rows.leaves) == len(low):
        bounds[rows.leaves, :3], bounds[rows.leaves, 3:] = low, -high
    else:
        for axis in range(3):
            bounds[rows.leaves, axis] = np.minimum.reduceat(np.ascontiguousarray(low[:, axis]), rows.starts)
            bounds[rows.leaves, 3 + axis] = -np.maximum.reduceat(np.ascontiguousarray(high[:, axis]), rows.starts)
    for inner, first, second in rows.levels:
        bounds[inner] = np.minimum(np.take(bounds, first, axis=0), np.take(bounds, second, axis=0))
    return np.ascontiguousarray(bounds[:, :3]), -bounds[:, 3:]
