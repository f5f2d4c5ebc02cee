# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which tree a mesh gets: the best one at once, a quick one, or the one of its topology with other boxes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import MeshArrays
from .hierarchy import Boxes, Hierarchy
from .hierarchy_build import build_all, build_all_quickly
from .mesh_rays import MeshRays, MeshTree, batches_of, triangle_boxes

FEW = 4096
"""A mesh of no more triangles gets the best tree at once: 15 milliseconds at most in place of 8, and rays look at a
third of the boxes, also while the mesh deforms and nothing can be improved"""
MOST_IMPROVED = 400_000
"""A mesh of more triangles keeps the tree of the quick build: a step of the better one, 0.4 microseconds a triangle,
would be felt in a viewport"""
WORSE = 1.4
"""A tree whose cost has grown by this factor since it was built is built anew"""


def trees_of(
    fresh: Sequence[tuple[MeshArrays, NDArray[np.int64], MeshRays | None]], counters: dict[str, int]
) -> list[MeshTree]:
    """Of meshes that have come, with the triangles that have a place and what was another mesh with the vertices
    elsewhere."""
    trees: list[MeshTree] = []
    to_build: list[tuple[MeshArrays, NDArray[np.int64], Boxes, Hierarchy | None]] = []
    for mesh, kept, before in fresh:
        boxes = triangle_boxes(mesh, kept)
        fitted = None
        if before is not None and np.array_equal(before.kept, kept):
            fitted = before.hierarchy.fitted(*boxes)
            if fitted.cost() < WORSE * before.cost:
                counters["hierarchies fitted"] += 1
                trees.append(MeshTree(mesh, kept, fitted, before.cost, before.is_best))
                continue
        to_build.append((mesh, kept, boxes, fitted))
    for is_best, build_them in ((True, build_all), (False, build_all_quickly)):
        group = [item for item in to_build if (len(item[1]) <= FEW) == is_best]
        for batch in batches_of(group, [len(kept) for _, kept, _, _ in group]):
            built = build_them([boxes for _, _, boxes, _ in batch])
            for (mesh, kept, _, fitted), tree in zip(batch, built, strict=True):
                # One that has come apart may still be better than one that is built quickly.
                better = fitted if fitted is not None and fitted.cost() < tree.cost() else tree
                trees.append(MeshTree(mesh, kept, better, better.cost(), is_best or len(kept) > MOST_IMPROVED))
    counters["hierarchies built"] += len(to_build)
    return trees
