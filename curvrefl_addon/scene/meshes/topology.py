# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How the triangles of a mesh are put together of Blender's: found once for a mesh that deforms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Float32Array, Int32Array
from ..signature import array_signature
from .corners import merge_corners


@dataclass(frozen=True, slots=True)
class Source:
    """What of Blender's mesh its topology is made of."""

    vertices: int
    normals_domain: str
    """POINT, FACE or CORNER"""
    corner_vertex: Int32Array
    """(corners of faces,)"""
    triangle_corners: Int32Array
    """(triangles, 3)"""
    slots: Int32Array
    """(triangles,)"""
    is_complete: bool
    """All corners are known to be used by a triangle"""

    def is_same(self, other: Source) -> bool:
        """Whether the same comes of both."""
        values = ("vertices", "normals_domain", "is_complete")
        arrays = ("corner_vertex", "triangle_corners", "slots")
        return all(getattr(self, name) == getattr(other, name) for name in values) and all(
            same_bits(getattr(self, name), getattr(other, name)) for name in arrays
        )


@dataclass(frozen=True, slots=True)
class Topology:
    """The arrays of `MeshArrays` that stay while it deforms, and which of Blender's values go into the others."""

    source: Source
    used_corners: Int32Array | None
    """Of Blender's mesh; None: all"""
    used_vertices: Int32Array | None
    models: Int32Array | None
    """(corners,) one of the used corners that each stands for; None where nothing was merged"""
    merged: Int32Array | None
    """(used corners,) the corner that each became; None where nothing was merged"""
    corner_vertex: Int32Array
    """(corners,)"""
    triangles: Int32Array
    """(triangles, 3)"""
    signature: int
    """Of these two and the material slots"""

    def serves(self, layers: Sequence[Float32Array]) -> bool:
        """Whether corners are alike as before that have been merged. `layers`: see `topology_of`."""
        if self.source.normals_domain == "FACE":
            return True
        if self.models is None or self.merged is None:
            return not layers
        models, merged = self.models, self.merged
        return all(
            same_bits(layer.take(models, axis=0).take(merged, axis=0), layer) for layer in map(self.used, layers)
        )

    def used(self, layer: Float32Array) -> Float32Array:
        """Of a layer (corners of faces, k) what is used."""
        return layer if self.used_corners is None else layer[self.used_corners]

    def at_corners(self, layer: Float32Array) -> Float32Array:
        """The same of the corners that they became."""
        layer = self.used(layer)
        return layer if self.models is None else layer[self.models]

    def at_vertices(self, layer: Float32Array) -> Float32Array:
        """Of a layer (vertices, k) what is used."""
        return layer if self.used_vertices is None else layer[self.used_vertices]


def topology_of(source: Source, layers: Sequence[Float32Array]) -> Topology:
    """`layers` (corners of faces, k): all that may differ between corners in one vertex. Vertices and corners that no
    triangle uses are left out."""
    used_corners, triangle_corners = _compact(
        source.triangle_corners, len(source.corner_vertex), complete=source.is_complete
    )
    corner_vertex = source.corner_vertex if used_corners is None else source.corner_vertex[used_corners]
    used_vertices, corner_vertex = _compact(corner_vertex, source.vertices, complete=False)
    count = source.vertices if used_vertices is None else len(used_vertices)
    models: Int32Array | None = None
    merged: Int32Array | None = None
    if source.normals_domain == "FACE":
        # Every face has its own normal: nothing to merge.
        triangles = triangle_corners
    elif not layers:
        triangles, corner_vertex = corner_vertex[triangle_corners], np.arange(count, dtype=np.int32)
    else:
        chosen = layers if used_corners is None else [layer[used_corners] for layer in layers]
        merged, models = merge_corners(corner_vertex, count, chosen)
        triangles, corner_vertex = merged[triangle_corners], corner_vertex[models]
    return Topology(
        source,
        used_corners,
        used_vertices,
        models,
        merged,
        corner_vertex,
        triangles,
        array_signature(corner_vertex, triangles, source.slots),
    )


def same_bits(one: NDArray[Any], other: NDArray[Any]) -> bool:
    """Whether two arrays of 32-bit numbers hold the same: what is no number is itself, and no zero another one."""
    if one is other:
        return True
    return one.dtype == other.dtype and np.array_equal(one.view(np.int32), other.view(np.int32))


def _compact(indices: Int32Array, count: int, complete: bool) -> tuple[Int32Array | None, Int32Array]:
    """The members of 0..count-1 that `indices` uses and the indices into these; None where that is all of them.

    `complete`: known to use all.
    """
    if complete:
        return None, indices
    used = np.zeros(count, bool)
    used[indices.reshape(-1)] = True
    if used.all():
        return None, indices
    members = np.flatnonzero(used).astype(np.int32)
    number = np.empty(count, np.int32)
    number[members] = np.arange(len(members), dtype=np.int32)
    return members, number[indices]
