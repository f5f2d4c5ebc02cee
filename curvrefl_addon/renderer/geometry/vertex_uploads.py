# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that deform: what an armature, a shape key or a wave leaves of a mesh are other positions and other normals.

These go to the GPU once, as they are, for all that is made of them there: world-space vertices (`chunk`), boxes and
triangles of hierarchies (`rays/hierarchy_fit`).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ...scene.arrays import Float32Array, MeshArrays
from ..device.records import packed_texture


def is_deformed(before: MeshArrays, after: MeshArrays) -> bool:
    """Whether a mesh is another one with its vertices elsewhere: all but positions and normals are the same arrays."""
    return (
        after.triangles is before.triangles
        and after.corner_vertex is before.corner_vertex
        and after.triangle_slot is before.triangle_slot
        and after.corner_attributes is before.corner_attributes
        and after.attributes == before.attributes
        and len(after.positions) == len(before.positions)
        and len(after.corner_normals) == len(before.corner_normals)
    )


class VertexUploads:
    """Arrays (n, 3) of meshes that deform as textures of numbers one after the other (`fetch_three`)."""

    def __init__(self) -> None:
        self.count = 0
        """How many have been uploaded"""
        self._textures: dict[int, tuple[Float32Array, Any]] = {}
        """By the array's id, it and its texture"""

    def texture(self, array: Float32Array) -> Any:
        """Of positions or normals; the same for the same array."""
        found = self._textures.get(id(array))
        if found is None:
            found = self._textures[id(array)] = (array, packed_texture(array))
            self.count += 1
        return found[1]

    def keep(self, meshes: Iterable[MeshArrays]) -> None:
        """Forget what none of these has."""
        if self._textures:
            used = {id(array) for mesh in meshes for array in (mesh.positions, mesh.corner_normals)}
            self._textures = {key: item for key, item in self._textures.items() if key in used}
