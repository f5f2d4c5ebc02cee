# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes and balls around the instances of a scene, of which only those that move are found again."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float64Array
from .chunk import Placed
from .mesh_facts import MeshFactsCache
from .placed_instances import corners_of_boxes, stretches_of


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
