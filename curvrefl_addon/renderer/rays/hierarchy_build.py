# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Grows bounding-volume hierarchies over boxes, level by level. Pure numpy.

All nodes of a level are split at once: the items of a node are neighbors in one array, and what is asked of nodes is a
reduction over segments of it. Trees over many meshes grow side by side, as numpy asks as much for a short array as for
a thousand numbers. Splits follow the surface-area heuristic over a few bins an axis (Wald 2007, "On fast
construction of SAH-based bounding volume hierarchies"). The quick build sorts items along Morton's curve (Lauterbach
et al. 2009, "Fast BVH construction on GPUs") and asks the heuristic only about clusters of neighbors.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence

import numpy as np
from numpy.typing import NDArray

from ...pacing.pieces import outcome
from ...scene.arrays import Float32Array
from .hierarchy import Boxes, Hierarchy, IntArray, fit, fit_rows

BINS = 8
LEAF = 4
"""Most items of a leaf"""
CLUSTER = 16
"""Neighbors on Morton's curve that the quick build does not take apart by the heuristic"""
PLACE_BITS = 32
"""Of an item's place, below its code on the curve"""
LARGE = 1 / 512
"""An item with this share of the whole's area is a cluster of its own: it would blow up its neighbors' box"""
HEURISTIC_LEVELS = 30
"""Deeper down nodes are halved by number, so that no input makes a deep tree"""


class HierarchyBuild:
    """A build by the heuristic, a level at each `step`, so that it can go on between the frames of a viewport."""

    def __init__(self, low: Float32Array, high: Float32Array, leaf: int = LEAF, counts: IntArray | None = None) -> None:
        """Boxes (items, 3), at least one; with `counts`, of several trees: the first `counts[0]` are of one, and so on,
        and the first nodes are the roots."""
        self._leaf = leaf
        counts = np.array([len(low)]) if counts is None else counts
        self._growth = _Growth(np.arange(len(low)), np.cumsum(counts) - counts, counts)
        # Lower ends and negated upper ends, so that everything is a minimum; a row each, which numpy likes best.
        self._boxes = np.ascontiguousarray(np.concatenate([low, -high], axis=1).T)

    def step(self) -> bool:
        """Split a level; False when there was nothing left to split."""
        growth = self._growth
        nodes = growth.splittable(self._leaf)
        if len(nodes) == 0:
            return False
        if growth.level >= HEURISTIC_LEVELS:
            growth.halve(nodes)
        else:
            growth.split(nodes, self._boxes)
        return True

    def finished(self) -> Hierarchy:
        """All steps that are left, and the tree."""
        while self.step():
            pass
        order = self._growth.order
        return self._growth.tree(np.stack([np.take(row, order) for row in self._boxes]))


def build(low: Float32Array, high: Float32Array, leaf: int = LEAF) -> Hierarchy:
    """The best tree over boxes (items, 3), at least one."""
    return HierarchyBuild(low, high, leaf).finished()


def build_all(boxes: Sequence[Boxes], leaf: int = LEAF) -> list[Hierarchy]:
    """The best tree over each of these."""
    counts = np.array([len(low) for low, _ in boxes])
    low, high = (np.concatenate([pair[end] for pair in boxes]) for end in range(2))
    growing = HierarchyBuild(low, high, leaf, counts)
    return _apart(growing.finished(), counts)


def build_quickly(low: Float32Array, high: Float32Array, leaf: int = LEAF) -> Hierarchy:
    """A good tree in a fraction of the time."""
    return build_all_quickly([(low, high)], leaf)[0]


def build_all_quickly(boxes: Sequence[Boxes], leaf: int = LEAF) -> list[Hierarchy]:
    """A good tree over each of these in a fraction of the time."""
    return outcome(quick_steps(boxes, leaf))


def quick_steps(boxes: Sequence[Boxes], leaf: int = LEAF) -> Generator[None, None, list[Hierarchy]]:
    """The same in steps, of which none takes longer than a tenth of a microsecond for each item."""
    counts = np.array([len(low) for low, _ in boxes])
    firsts = np.cumsum(counts) - counts
    rows = np.empty((6, int(counts.sum())), np.float32)
    orders, starts, clusters = [], [], []
    for first, (own_low, own_high) in zip(firsts, boxes, strict=True):
        own = rows[:, first : first + len(own_low)]
        own[:3], own[3:] = own_low.T, -own_high.T
        yield
        own_order, own_starts = yield from _clusters(own)
        orders.append(first + own_order)
        starts.append(first + own_starts)
        clusters.append(len(own_starts))
    order, start = np.concatenate(orders), np.concatenate(starts)
    sizes = np.diff(np.append(start, len(order)))
    for row in rows:
        row[:] = np.take(row, order)
    yield
    ends = np.stack([np.minimum.reduceat(row, start) for row in rows])
    yield
    building = HierarchyBuild(ends[:3].T, -ends[3:].T, 1, np.array(clusters))
    while building.step():
        yield
    growth = _Growth.below(building.finished(), order, start, sizes)
    while len(nodes := growth.splittable(leaf)):
        growth.halve(nodes)
    yield
    forest = growth.tree(rows)
    yield
    return _apart(forest, counts)


def _clusters(rows: Float32Array) -> Generator[None, None, tuple[IntArray, IntArray]]:
    """Items (n,) in the order of their clusters, and where each of these begins; `rows` as in `HierarchyBuild`."""
    count = rows.shape[1]
    if count <= 4 * CLUSTER:
        return np.arange(count), np.arange(count)
    areas = _areas(rows)
    whole = float(_areas(rows.min(axis=1)))
    yield
    few = count // CLUSTER
    threshold = max(LARGE * whole, np.partition(areas, count - few)[count - few])
    is_large = areas > threshold
    large, small = np.flatnonzero(is_large), np.flatnonzero(~is_large)
    yield
    code = _morton([(rows[axis] - rows[axis + 3])[small] for axis in range(3)])
    yield
    # (Sorting numbers that hold their place is several times as fast as finding the order of others.)
    code <<= np.uint64(PLACE_BITS)
    code |= np.arange(len(small), dtype=np.uint64)
    code.sort()
    code &= np.uint64((1 << PLACE_BITS) - 1)
    order = np.concatenate([large, small[code.astype(np.int64)]])
    return order, np.concatenate([np.arange(len(large)), np.arange(len(large), count, CLUSTER)])


def _apart(forest: Hierarchy, counts: IntArray) -> list[Hierarchy]:
    """The trees whose roots are the first nodes of a forest; each is over so many items, in turn."""
    trees = len(counts)
    if trees == 1:
        return [forest]
    first_item = np.cumsum(counts) - counts
    root = np.empty(len(forest.link), np.int64)
    root[:trees] = np.arange(trees)
    in_level = []
    for begin, end in zip(forest.levels[:-1], forest.levels[1:], strict=True):
        inner = begin + np.flatnonzero(forest.count[begin:end] == 0)
        child = forest.link[inner]
        root[child] = root[child + 1] = root[inner]
        in_level.append(np.bincount(root[begin:end], minlength=trees))
    # Nodes keep their order: children stay neighbors, and come after their parent.
    nodes = np.argsort(root, kind="stable")
    sizes = np.bincount(root, minlength=trees)
    number = np.empty(len(nodes), np.int64)
    number[nodes] = np.arange(len(nodes)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    is_leaf = forest.count > 0
    link = np.where(is_leaf, forest.link - first_item[root], number[np.where(is_leaf, 0, forest.link)])
    ends = np.cumsum(in_level, axis=0)
    found = []
    for tree, own in enumerate(np.split(nodes, np.cumsum(sizes)[:-1])):
        levels = (0, *dict.fromkeys(ends[:, tree].tolist()))
        items = slice(first_item[tree], first_item[tree] + counts[tree])
        order = forest.order[items] - first_item[tree]
        found.append(Hierarchy(order, link[own], forest.count[own], levels, forest.low[own], forest.high[own]))
    return found


class _Growth:
    """A tree that grows level by level. Boxes come last."""

    def __init__(self, order: IntArray, start: IntArray, count: IntArray) -> None:
        self.order = order
        self._start, self._count, self._link = [start], [count], [np.full(len(start), -1)]
        self._levels = [0, len(start)]
        self._open = np.arange(len(start))

    @classmethod
    def below(cls, top: Hierarchy, order: IntArray, starts: IntArray, sizes: IntArray) -> _Growth:
        """To go on below a tree of one-item leaves: item i of `top` is order[starts[i] : starts[i] + sizes[i]]."""
        is_leaf = top.count > 0
        item = top.order[np.where(is_leaf, top.link, 0)]
        growth = cls(order, np.where(is_leaf, starts[item], 0), np.where(is_leaf, sizes[item], 0))
        growth._link = [np.where(is_leaf, -1, top.link)]
        growth._levels = list(top.levels)
        growth._open = np.flatnonzero(is_leaf)
        return growth

    @property
    def level(self) -> int:
        """Splits that led here."""
        return len(self._levels) - 2

    def splittable(self, leaf: int) -> IntArray:
        """(n,) nodes made by the last split, or the first ones, that hold more than `leaf` items."""
        count = self._joined(self._count)[self._open]
        return self._open[count > leaf]

    def halve(self, nodes: IntArray) -> None:
        """Split nodes by the number of their items."""
        self._grow(nodes, self._joined(self._count)[nodes] // 2)

    def split(self, nodes: IntArray, boxes: Float32Array) -> None:
        """Split nodes where the heuristic says; `boxes` (6, items): lower ends and negated upper ends."""
        start, count = self._joined(self._start)[nodes], self._joined(self._count)[nodes]
        first = np.concatenate([[0], np.cumsum(count)])[:-1]
        segment = np.repeat(np.arange(len(nodes)), count)
        rows = np.arange(len(segment)) + np.repeat(start - first, count)
        items = self.order[rows]
        here = [row[items] for row in boxes]
        goes_left = _best_split(here, segment, first, count)
        left = np.add.reduceat(goes_left, first, dtype=np.int64)
        # Where all centers coincide any half will do.
        stuck = (left == 0) | (left == count)
        if stuck.any():
            by_number = np.arange(len(segment)) - first[segment] < (count // 2)[segment]
            goes_left = np.where(stuck[segment], by_number, goes_left)
            left = np.where(stuck, count // 2, left)
        before = np.cumsum(goes_left) - goes_left
        left_rank = before - before[first][segment]
        right_rank = np.arange(len(segment)) - first[segment] - left_rank
        place = first[segment] + np.where(goes_left, left_rank, left[segment] + right_rank)
        self.order[rows[place]] = items
        self._grow(nodes, left)

    def _grow(self, nodes: IntArray, left: IntArray) -> None:
        start, count = self._joined(self._start), self._joined(self._count)
        total = len(start)
        self._link = [self._joined(self._link)]
        self._link[0][nodes] = total + 2 * np.arange(len(nodes))
        self._start.append(np.stack([start[nodes], start[nodes] + left], axis=1).ravel())
        self._count.append(np.stack([left, count[nodes] - left], axis=1).ravel())
        self._link.append(np.full(2 * len(nodes), -1))
        self._open = total + np.arange(2 * len(nodes))
        self._levels.append(total + 2 * len(nodes))

    def tree(self, rows: Float32Array) -> Hierarchy:
        """The tree about boxes (6, items) in its order: lower ends and negated upper ends."""
        link, count = self._joined(self._link), self._joined(self._count)
        is_leaf = link < 0
        link, count = np.where(is_leaf, self._joined(self._start), link), np.where(is_leaf, count, 0)
        levels = tuple(self._levels)
        # (Ends along an axis lie side by side, as `fit` likes them best.)
        fitted = fit(fit_rows(link, count, levels), rows[:3].T, -rows[3:].T)
        return Hierarchy(self.order, link, count, levels, *fitted)

    @staticmethod
    def _joined(parts: list[IntArray]) -> IntArray:
        if len(parts) > 1:
            parts[:] = [np.concatenate(parts)]
        return parts[0]


def _best_split(boxes: list[Float32Array], segment: IntArray, first: IntArray, count: IntArray) -> NDArray[np.bool_]:
    """(items,) which go to the first child. `boxes`: six rows as in `HierarchyBuild`, of items whose node is `segment`
    (ascending; begins at `first`, `count` items)."""
    nodes = len(first)
    best = np.full(nodes, np.inf, np.float32)
    goes_left = np.zeros(len(segment), bool)
    for axis in range(3):
        center = boxes[axis] - boxes[axis + 3]
        least = np.minimum.reduceat(center, first)
        extent = np.maximum.reduceat(center, first) - least
        scale = np.where(extent > 0.0, BINS * (1.0 - 1e-6) / np.where(extent > 0.0, extent, 1.0), 0.0).astype(
            np.float32
        )
        bins = ((center - least[segment]) * scale[segment]).astype(np.int64)
        cost, split = _cheapest(boxes, np.minimum(bins, BINS - 1) * nodes + segment, nodes)
        better = cost < best
        best = np.where(better, cost, best)
        chosen = better[segment]
        goes_left = np.where(chosen, bins <= split[segment], goes_left)
    return goes_left


def _cheapest(boxes: list[Float32Array], key: IntArray, nodes: int) -> tuple[Float32Array, IntArray]:
    """Per node the least cost of a split between bins, and the last bin before it; `key`: bin * nodes + node."""
    number = np.bincount(key, minlength=BINS * nodes).reshape(BINS, nodes)
    by_bin = np.full((6, BINS * nodes), np.inf, np.float32)
    for row, target in zip(boxes, by_bin, strict=True):
        # (Ten times as fast as sorting by bin and reducing what then lies side by side.)
        np.minimum.at(target, key, row)
    ends = by_bin.reshape(6, BINS, nodes)
    # (Bin after bin for all nodes: numpy takes as long for a row of eight as for a thousand numbers.)
    left, right = ends[:, :-1].copy(), ends[:, 1:].copy()
    for bins in range(1, BINS - 1):
        np.minimum(left[:, bins], left[:, bins - 1], out=left[:, bins])
        np.minimum(right[:, -1 - bins], right[:, -bins], out=right[:, -1 - bins])
    left_number = np.cumsum(number, axis=0)[:-1]
    right_number = number.sum(axis=0) - left_number
    costs = _areas(left) * left_number + _areas(right) * right_number
    costs = np.where((left_number > 0) & (right_number > 0), costs, np.inf)
    split = costs.argmin(axis=0)
    return costs[split, np.arange(nodes)].astype(np.float32), split


def _areas(ends: Float32Array) -> Float32Array:
    """Half areas of boxes (6, ...); 0 of empty ones."""
    with np.errstate(invalid="ignore"):
        x, y, z = -ends[3:] - ends[:3]
    return np.where(x >= 0.0, x * y + y * z + z * x, 0.0)


def _morton(doubled_centers: Sequence[Float32Array]) -> NDArray[np.uint64]:
    """(n,) ten bits of each axis, interleaved; of rows (n,) of coordinates."""
    code = np.zeros(len(doubled_centers[0]), np.uint32)
    for axis, row in enumerate(doubled_centers):
        least = row.min()
        extent = row.max() - least
        bits = ((row - least) * np.float32(1023.0 / extent if extent > 0.0 else 0.0)).astype(np.uint32)
        for shift, mask in ((16, 0x030000FF), (8, 0x0300F00F), (4, 0x030C30C3), (2, 0x09249249)):
            bits = (bits | (bits << np.uint32(shift))) & np.uint32(mask)
        code |= bits << np.uint32(axis)
    return code.astype(np.uint64)
