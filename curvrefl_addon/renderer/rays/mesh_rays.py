# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What rays need of one mesh, and of its place."""

from __future__ import annotations

from collections.abc import Collection, Generator, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...pacing.pieces import outcome
from ...scene.arrays import (
    LARGEST_COORDINATE,
    Float32Array,
    Float64Array,
    MeshArrays,
)
from ..device.record_regions import RecordRegions
from .hierarchy import Boxes, Hierarchy
from .hierarchy_fit import HierarchyFit
from .ray_records import (
    NODE_RECORDS,
    TRIANGLE_RECORDS,
    attribute_records,
    corner_records,
    node_records,
    triangle_corners,
    triangle_records,
)

BOXES_AT_ONCE = 1 << 18
AT_ONCE = 500_000
"""Triangles of meshes that are built or uploaded together: more would gain nothing and take memory"""


@dataclass
class MeshRays:
    """One mesh on the GPU."""

    mesh: MeshArrays
    hierarchy: Hierarchy
    kept: NDArray[np.int64]
    """Triangles that have a place: the items of the hierarchy"""
    starts: list[int]
    """First records of nodes, triangles, corners and attributes"""
    sizes: list[int]
    cost: float
    """Of the tree when it was built; vertices may have moved since"""
    is_best: bool
    """`improve` leaves the tree as it is"""
    box: Boxes
    """Lowest and highest corner (3,) around it"""
    fit: HierarchyFit | None = None
    """Once it deforms; the boxes of `hierarchy` are those of before then"""

    @property
    def is_judged(self) -> bool:
        """It has deformed, and what its tree costs now is to be looked at."""
        return self.fit is not None and self.fit.is_judged

    @property
    def present_hierarchy(self) -> Hierarchy:
        """With boxes of the mesh as it is."""
        return self.hierarchy if self.fit is None else self.hierarchy.fitted(*triangle_boxes(self.mesh, self.kept))

    def leave(self, regions: RecordRegions) -> None:
        """Free the room that its records take there."""
        for start, size in zip(self.starts, self.sizes, strict=True):
            if size:
                regions.drop(start, size)
        self.sizes = [0] * len(self.sizes)

    @cached_property
    def topology(self) -> tuple[int, int]:
        """See `topology_of`."""
        return topology_of(self.mesh)


@dataclass(frozen=True, slots=True)
class MeshTree:
    """Of a mesh that is to be stored; the names are those of `MeshRays`."""

    mesh: MeshArrays
    kept: NDArray[np.int64]
    hierarchy: Hierarchy
    cost: float
    is_best: bool

    @property
    def record_sizes(self) -> list[int]:
        """Records of each of its regions, in the order of `MeshRays.starts`."""
        inner = int(np.count_nonzero(self.hierarchy.count == 0))
        triangles = len(self.hierarchy.order) * TRIANGLE_RECORDS
        attributes = 0 if self.mesh.corner_attributes is None else self.mesh.corner_attributes.size // 4
        return [max(inner, 1) * NODE_RECORDS, triangles, len(self.mesh.corner_vertex), attributes]

    def arrived(self, starts: list[int], sizes: list[int]) -> MeshRays:
        """Once its records are there."""
        box = self.hierarchy.low[0], self.hierarchy.high[0]
        return MeshRays(self.mesh, self.hierarchy, self.kept, starts, sizes, self.cost, self.is_best, box)

    def records(self) -> tuple[Float32Array, ...]:
        """What each of its regions holds."""
        return (
            node_records(self.hierarchy, self.hierarchy.link, self.hierarchy.count),
            triangle_records(self.mesh, self.kept[self.hierarchy.order]),
            corner_records(self.mesh),
            attribute_records(self.mesh),
        )


def batches_of[Item](items: list[Item], sizes: list[int]) -> Iterator[list[Item]]:
    """The items in turn, some together whose sizes add up to no more than AT_ONCE, or one that is larger."""
    batch: list[Item] = []
    total = 0
    for item, size in zip(items, sizes, strict=True):
        if batch and total + size > AT_ONCE:
            yield batch
            batch, total = [], 0
        batch.append(item)
        total += size
    if batch:
        yield batch


def of_same_topology(mesh: MeshArrays, known: Collection[MeshRays]) -> MeshRays | None:
    """The one whose vertices have moved to be this mesh."""
    for item in known:
        # (to go through all of their content takes milliseconds a million triangles)
        if item.mesh.triangles is mesh.triangles and item.mesh.corner_vertex is mesh.corner_vertex:
            return item
    if not known:
        return None
    wanted = topology_of(mesh)
    return next((item for item in known if item.topology == wanted), None)


def topology_of(mesh: MeshArrays) -> tuple[int, int]:
    """The same for a mesh whose vertices have moved."""
    return hash(mesh.triangles.tobytes()), hash(mesh.corner_vertex.tobytes())


def triangles_with_a_place(mesh: MeshArrays) -> tuple[NDArray[np.int64], bool]:
    """Indices of the triangles that rays can be tested against; whether others are too far out for that."""
    # (a comparison with what is no number is not true)
    if np.abs(mesh.positions).max(initial=0.0) < LARGEST_COORDINATE:
        return np.arange(len(mesh.triangles)), False
    places = mesh.positions[mesh.corner_vertex[mesh.triangles]]
    kept = np.flatnonzero((np.abs(places) < LARGEST_COORDINATE).all(axis=(1, 2)))
    # (of what is no number the reader has said so)
    return kept, len(kept) < int(np.isfinite(places).all(axis=(1, 2)).sum())


def triangle_boxes(mesh: MeshArrays, kept: NDArray[np.int64]) -> Boxes:
    """About these triangles."""
    return outcome(box_steps(mesh, kept))


def box_steps(mesh: MeshArrays, kept: NDArray[np.int64]) -> Generator[None, None, Boxes]:
    """The same, some triangles in each step."""
    low, high = np.empty((len(kept), 3), np.float32), np.empty((len(kept), 3), np.float32)
    is_all = len(kept) == len(mesh.triangles)
    for first in range(0, len(kept), BOXES_AT_ONCE):
        some = slice(first, first + BOXES_AT_ONCE)
        a, b, c = triangle_corners(mesh, mesh.triangles[some] if is_all else mesh.triangles[kept[some]])
        np.minimum(np.minimum(a, b), c, out=low[some])
        np.maximum(np.maximum(a, b), c, out=high[some])
        yield
    return low, high


def world_boxes(items: list[MeshRays], matrices: Float64Array) -> tuple[Float32Array, Float32Array]:
    """Boxes (n, 3) around placed meshes: around the box around the mesh, and a little more than rounding takes."""
    low = np.array([item.box[0] for item in items], np.float64)
    high = np.array([item.box[1] for item in items], np.float64)
    center, half = 0.5 * (low + high), 0.5 * (high - low)
    middle = np.einsum("nij,nj->ni", matrices[:, :3, :3], center) + matrices[:, :3, 3]
    reach = np.einsum("nij,nj->ni", np.abs(matrices[:, :3, :3]), half)
    reach += 1e-6 * (np.abs(middle) + reach)
    return (middle - reach).astype(np.float32), (middle + reach).astype(np.float32)
