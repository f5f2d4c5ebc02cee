# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of placed meshes in the texture that rays walk through (see `ray_walk.glsl`)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float32Array, Float64Array, InstanceArrays
from ..device.record_regions import UNIT
from ..geometry.mesh_facts import MeshFactsCache
from ..surfaces.light_sets import SHADOW_SET_SHIFT
from .mesh_rays import MeshRays
from .ray_records import InstanceFlag, seen_by

INSTANCE_RECORDS = 6
OWN_RANGE = 1e-4
"""A ray that leaves a mirror, or what is seen through, does not see it nearer than this share of its size"""


def fill_records(
    records: Float32Array,
    items: Sequence[MeshRays],
    instances: Sequence[InstanceArrays],
    mirrors: Sequence[int],
    sizes: Float64Array | Float32Array,
    seen_through: frozenset[int],
    clear: frozenset[int],
    facts: MeshFactsCache,
) -> None:
    """Fill `records` (n, INSTANCE_RECORDS, 4) but for where lists of the top level are and which row of a table it is.

    `mirrors`: 0, or 1, 2, ... of mirrors; `sizes` (n, 3) of boxes in world space; `seen_through`, `clear`: indices of
    materials that light goes on through, and of those it goes straight on through.
    """
    matrices = np.array([instance.matrix for instance in instances])
    records[:, :3] = np.linalg.inv(matrices)[:, :3]
    flags = np.array([seen_by(item, not clear.isdisjoint(item.materials)) for item in instances])
    flags += np.array([item.shadow_set for item in instances]) << SHADOW_SET_SHIFT
    flags[np.linalg.det(matrices[:, :3, :3]) < 0.0] += InstanceFlag.IS_MIRRORED
    records[:, 3, 0] = [item.object_id for item in instances]
    records[:, 3, 1] = mirrors
    records[:, 3, 3] = OWN_RANGE * np.linalg.norm(sizes, axis=1)
    lets_light_on = [not seen_through.isdisjoint(item.materials) for item in instances]
    for index in np.flatnonzero(np.logical_or(mirrors, lets_light_on)).tolist():
        known = facts.of(items[index].mesh)
        flags[index] += InstanceFlag.NEVER_SEES_ITSELF * known.never_sees_itself
        flags[index] += InstanceFlag.IS_CLOSED * known.is_closed
        records[index, 3, 3] = OWN_RANGE * np.linalg.norm(matrices[index, :3, :3] @ (known.box[1] - known.box[0]))
    records[:, 3, 2] = flags
    starts = np.array([item.starts for item in items]) // UNIT
    records[:, 4, :3] = starts[:, :3]
    records[:, 5, 0] = [len(item.materials) for item in instances]
    records[:, 5, 1] = starts[:, 3]


def places_hit(
    hits: Float32Array, items: Sequence[MeshRays], index_of: Sequence[int]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Of `packed_hit` (n, 4) the index of the instance in the scene and of the triangle in its mesh, (n,) each.

    `items`, and `index_of` in the scene: of the instances that rays know.
    """
    number, place = np.rint(hits[:, 0]).astype(np.int64), np.rint(hits[:, 1]).astype(np.int64)
    triangle = np.empty(len(hits), np.int64)
    for known in np.unique(number).tolist():
        here, item = number == known, items[known]
        triangle[here] = item.kept[item.hierarchy.order[place[here]]]
    return np.asarray(index_of, np.int64)[number], triangle
