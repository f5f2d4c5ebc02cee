# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which tree a mesh gets: the best one at once, a quick one, or the one of its topology with other boxes; and its way
to the GPU, piece by piece, for which a viewport can wait."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...pacing.pieces import OutOfTime, outcome, piece_of_work
from ...scene.arrays import Float32Array, MeshArrays
from ..device.record_regions import RecordRegions
from .hierarchy import Boxes, Hierarchy
from .hierarchy_build import build_all, quick_steps
from .mesh_rays import MeshRays, MeshTree, box_steps
from .ray_records import (
    NODE_RECORDS,
    TRIANGLE_RECORDS,
    attribute_records,
    corner_records,
    node_records,
    triangle_records,
)

FEW = 4096
"""A mesh of no more triangles gets the best tree at once: 15 milliseconds at most in place of 8, and rays look at a
third of the boxes, also while the mesh deforms and nothing can be improved"""
MOST_IMPROVED = 400_000
"""A mesh of more triangles keeps the tree of the quick build: a step of the better one, 0.4 microseconds a triangle,
would be felt in a viewport"""
WORSE = 1.4
"""A tree whose cost has grown by this factor since it was built is built anew"""
SLAB = 1 << 17
"""Triangles, or nodes, whose records go to the GPU in one piece"""
type Steps = Generator[None, None, list[MeshRays]]


@dataclass(frozen=True, slots=True)
class Fresh:
    """A mesh that has come."""

    mesh: MeshArrays
    kept: NDArray[np.int64]
    """Its triangles that have a place"""
    before: MeshRays | None = None
    """The same mesh with its vertices elsewhere"""


def tree_steps(fresh: Sequence[Fresh], counters: dict[str, int]) -> Generator[None, None, list[MeshTree]]:
    """Trees of these meshes, in any order, in steps; `counters` gets how they came about."""
    trees: list[MeshTree] = []
    to_build: list[tuple[Fresh, Boxes, Hierarchy | None]] = []
    for item in fresh:
        boxes = yield from box_steps(item.mesh, item.kept)
        before, fitted = item.before, None
        if before is not None and np.array_equal(before.kept, item.kept):
            fitted = before.hierarchy.fitted(*boxes)
            if fitted.cost() < WORSE * before.cost:
                counters["hierarchies fitted"] += 1
                trees.append(MeshTree(item.mesh, item.kept, fitted, before.cost, before.is_best))
                continue
        to_build.append((item, boxes, fitted))
    for is_best in (True, False):
        group = [built for built in to_build if (len(built[0].kept) <= FEW) == is_best]
        if not group:
            continue
        yield
        all_boxes = [boxes for _, boxes, _ in group]
        built = build_all(all_boxes) if is_best else (yield from quick_steps(all_boxes))
        for (item, _, fitted), tree in zip(group, built, strict=True):
            # One that has come apart may still be better than one that is built quickly.
            better = fitted if fitted is not None and fitted.cost() < tree.cost() else tree
            stays = is_best or len(item.kept) > MOST_IMPROVED
            trees.append(MeshTree(item.mesh, item.kept, better, better.cost(), stays))
    counters["hierarchies built"] += len(to_build)
    return trees


class Arrivals:
    """Into one record texture."""

    def __init__(self, regions: RecordRegions, counters: dict[str, int]) -> None:
        """`counters` gets how hierarchies came about."""
        self._regions, self._counters = regions, counters
        self._under_way: tuple[Sequence[Fresh], Steps] | None = None
        """What has begun, and the steps that are left"""

    def bring(self, batch: Sequence[Fresh]) -> list[MeshRays]:
        """These meshes on the GPU. Raises InputError where there is no room, OutOfTime where the same call goes on."""
        if self._under_way is None or not _are_same(self._under_way[0], batch):
            # (What else was under way is let go with its steps.)
            self._under_way = (batch, _steps(batch, self._regions, self._counters))
        try:
            while True:
                with piece_of_work("hierarchies"):
                    next(self._under_way[1])
        except StopIteration as arrived:
            self._under_way = None
            return list(arrived.value)
        except OutOfTime:
            raise
        except BaseException:
            self._under_way = None
            raise

    def store(self, trees: Sequence[MeshTree]) -> list[MeshRays]:
        """Trees that are there, at once. Raises InputError where there is no room."""
        return outcome(_storing(trees, self._regions))


def _are_same(one: Sequence[Fresh], other: Sequence[Fresh]) -> bool:
    return [id(item.mesh) for item in one] == [id(item.mesh) for item in other]


def _steps(batch: Sequence[Fresh], regions: RecordRegions, counters: dict[str, int]) -> Steps:
    trees = yield from tree_steps(batch, counters)
    yield
    for item in batch:
        if item.before is not None:
            # (What comes takes its place.)
            item.before.leave(regions)
    return (yield from _storing(trees, regions))


def _storing(trees: Sequence[MeshTree], regions: RecordRegions) -> Steps:
    """Small ones all at once: each would be an upload of its own."""
    small = [tree for tree in trees if len(tree.kept) <= SLAB]
    parts = [part for tree in small for part in tree.records()]
    # (What has no records gets no region.)
    stored = iter(regions.put([part for part in parts if len(part)]))
    arrived = []
    for tree in small:
        sizes = tree.record_sizes
        arrived.append(tree.arrived([next(stored) if size else 0 for size in sizes], sizes))
    for tree in trees:
        if len(tree.kept) <= SLAB:
            continue
        yield
        sizes = tree.record_sizes
        reserved = iter(regions.reserve([size for size in sizes if size]))
        starts = [next(reserved) if size else 0 for size in sizes]
        try:
            for part, first, records in _slabs(tree):
                yield
                regions.replace(starts[part] + first, records)
        except GeneratorExit:
            for start, size in zip(starts, sizes, strict=True):
                if size:
                    regions.drop(start, size)
            raise
        arrived.append(tree.arrived(starts, sizes))
    return arrived


def _slabs(tree: MeshTree) -> Iterator[tuple[int, int, Float32Array]]:
    """A tree's records in slabs, whose size does not grow with the mesh: which of its parts each belongs to, the first
    record there, and the records (n, 4)."""
    nodes = node_records(tree.hierarchy, tree.hierarchy.link, tree.hierarchy.count)
    for part, records in ((0, nodes), (2, corner_records(tree.mesh)), (3, attribute_records(tree.mesh))):
        for first in range(0, len(records), SLAB * NODE_RECORDS):
            yield part, first, records[first : first + SLAB * NODE_RECORDS]
    order = tree.hierarchy.order
    for first in range(0, len(order), SLAB):
        yield 1, first * TRIANGLE_RECORDS, triangle_records(tree.mesh, tree.kept[order[first : first + SLAB]])
