# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes and balls around the instances of a scene, of which only those that move or deform are found again, and boxes
around chunks of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float64Array
from .chunk import Chunk, Placed
from .mesh_facts import MeshFactsCache
from .placed_instances import box_around, corners_of_boxes, stretches_of


class InstanceBounds:
    """Of the instances that `follow` was told last."""

    def __init__(self, facts: MeshFactsCache) -> None:
        self._facts = facts
        self._placed: Sequence[Placed] = ()
        self._stale: set[int] | None = None
        """Rows to find again; None: all"""
        self._corners = np.zeros((0, 8, 3))
        self._centers, self._radii = np.zeros((0, 3)), np.zeros(0)

    def follow(self, placed: Sequence[Placed], changed: Iterable[int] | None = None) -> None:
        """Know these instances. `changed`: indices of those that are not as before; None: any may not be."""
        self._placed = placed
        if changed is None:
            self._stale = None
        elif self._stale is not None:
            self._stale.update(changed)

    def balls(self, indices: NDArray[np.int64] | None = None) -> tuple[Float64Array, Float64Array]:
        """Centers (n, 3) and radii (n,) of balls around instances, world space. Not to be written to."""
        self._find()
        chosen = slice(None) if indices is None else indices
        return self._centers[chosen], self._radii[chosen]

    def corners(self, indices: NDArray[Any] | Sequence[int]) -> Float64Array:
        """(n, 8, 3) corners of the boxes around instances, world space."""
        self._find()
        return self._corners[np.asarray(indices, np.int64)]

    def _find(self) -> None:
        if self._stale is None:
            count = len(self._placed)
            rows = np.arange(count)
            self._corners = np.zeros((count, 8, 3))
            self._centers, self._radii = np.zeros((count, 3)), np.zeros(count)
        elif self._stale:
            rows = np.array(sorted(self._stale), np.int64)
            # (Others may hold the arrays of before.)
            self._corners, self._centers, self._radii = self._corners.copy(), self._centers.copy(), self._radii.copy()
        else:
            return
        self._stale = set()
        if len(rows) == 0:
            return
        items = [self._placed[row] for row in rows.tolist()]
        boxes = np.array([self._facts.of(item.mesh).box for item in items], np.float64)
        matrices = np.array([item.instance.matrix for item in items])
        self._corners[rows] = corners_of_boxes(boxes, matrices)
        middle = boxes.mean(axis=1)
        self._centers[rows] = np.einsum("nij,nj->ni", matrices[:, :3, :3], middle) + matrices[:, :3, 3]
        self._radii[rows] = np.linalg.norm(0.5 * (boxes[:, 1] - boxes[:, 0]), axis=1) * stretches_of(matrices)


_NO_BOXES: tuple[tuple[int, ...], Float64Array] = ((), np.zeros((0, 8, 4)))


class ChunkBoxes:
    """(8, 4) homogeneous corners of boxes around chunks, world space."""

    def __init__(self, bounds: InstanceBounds) -> None:
        self._bounds = bounds
        self._boxes: dict[int, Float64Array] = {}
        """By a chunk's id"""
        self._joined = _NO_BOXES
        """Ids of the chunks asked for last, and their boxes"""

    def of(self, chunk: Chunk, rows: NDArray[Any] | Sequence[int]) -> Float64Array:
        """Found when first asked for. `rows`: its instances."""
        box = self._boxes.get(id(chunk))
        if box is None:
            box = self._boxes[id(chunk)] = box_around(self._bounds.corners(rows).reshape(-1, 3))
        return box

    def joined(self, chunks: Sequence[Chunk], rows_of: Callable[[Chunk], NDArray[Any]]) -> Float64Array:
        """(n, 8, 4) the same of several."""
        key = tuple(map(id, chunks))
        if self._joined[0] != key:
            self._joined = key, np.array([self.of(chunk, rows_of(chunk)) for chunk in chunks]).reshape(-1, 8, 4)
        return self._joined[1]

    def grow(self, chunk: Chunk, moved: Sequence[int]) -> None:
        """Make a known box hold these instances too; it gets no smaller until it is forgotten."""
        box = self._boxes.get(id(chunk))
        if box is not None:
            self._boxes[id(chunk)] = box_around(np.concatenate([box[:, :3], *self._bounds.corners(moved)]))
            self._joined = _NO_BOXES

    def forget(self, chunk: Chunk) -> None:
        """Its instances are others than before."""
        self._boxes.pop(id(chunk), None)
        self._joined = _NO_BOXES

    def forget_all(self) -> None:
        """Chunks are others, whose ids may be the same."""
        self._boxes.clear()
        self._joined = _NO_BOXES
