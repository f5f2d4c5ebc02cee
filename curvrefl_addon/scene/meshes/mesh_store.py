# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of a scene, each read once for all that share it, and again only when its data-blocks change."""

from __future__ import annotations

from dataclasses import dataclass, replace
from heapq import heappop, heappush
from typing import Any

import bpy
import numpy as np

from ..arrays import MeshArrays
from ..remarks import Remark
from ..strands.particles import HairSystem
from ..strands.reading import is_strands_or_points, read_strands
from .meshes import MeshNeeds, MeshReading, mirrored, read_mesh
from .topology import Topology, same_bits

EMPTY = MeshArrays(
    name="",
    positions=np.zeros((0, 3), np.float32),
    corner_vertex=np.zeros(0, np.int32),
    corner_normals=np.zeros((0, 3), np.float32),
    corner_uv=None,
    triangles=np.zeros((0, 3), np.int32),
    triangle_slot=np.zeros(0, np.int32),
)
"""At the numbers of meshes that are gone: those of the others stay"""

_ARRAYS = (
    "corner_vertex",
    "triangles",
    "triangle_slot",
    "corner_normals",
    "corner_uv",
    "corner_attributes",
)
"""Of `MeshArrays`, that may stay while a mesh deforms"""
type Source = bpy.types.Object | HairSystem
type _Key = tuple[int, MeshNeeds, bool]
"""Address of the evaluated mesh, what is read of it, whether wound the other way round"""
type _Shape = tuple[int, MeshNeeds, bool]
"""`session_uid` of an object, the rest as of a key: the same where the mesh has been evaluated anew"""


@dataclass(frozen=True, slots=True)
class StoredMesh:
    """A mesh of the scene."""

    number: int
    """Index into `MeshStore.meshes`"""
    dropped: int
    """Triangles left out because a coordinate is not finite"""
    remarks: tuple[Remark | str, ...]
    owners: frozenset[int]
    """`session_uid` of data-blocks whose change of geometry changes the mesh"""
    reach: float
    """Largest distance of a vertex from the object's origin, or more"""
    shape: _Shape


class MeshStore:
    """Keeps what it has read. An edited mesh whose arrays come out the same stays the same object."""

    def __init__(self) -> None:
        self.meshes: list[MeshArrays] = []
        self.reads = 0
        """How many meshes have been read"""
        self._stored: dict[_Key, StoredMesh] = {}
        self._used: set[_Key] = set()
        self._free: list[int] = []
        """Numbers of `EMPTY` meshes, a heap"""
        self._replaced: dict[int, MeshArrays] = {}
        """By signature, arrays that were dropped since the last walk"""
        self._shapes: dict[_Shape, MeshArrays] = {}
        """The same by what they were read of"""
        self._topologies: dict[_Shape, Topology] = {}
        """Of what has been read more than once"""

    def begin(self) -> None:
        """Before a walk through all instances."""
        self._used = set()

    def end(self) -> None:
        """After it: what no instance shows is let go."""
        for key in set(self._stored) - self._used:
            self._drop(key)
        self.settle()
        if self._topologies:
            shapes = {stored.shape for stored in self._stored.values()}
            self._topologies = {key: item for key, item in self._topologies.items() if key in shapes}

    def settle(self) -> None:
        """All that was dropped has been read again."""
        self._replaced.clear()
        self._shapes.clear()

    def forget_all(self) -> None:
        """Any may have changed; those whose arrays come out the same stay the same objects all the same."""
        for key in list(self._stored):
            self._drop(key)

    def forget(self, owners: set[int]) -> set[int]:
        """The geometry of these data-blocks changed; returns the numbers of meshes that are to be read again."""
        keys = [key for key, stored in self._stored.items() if not stored.owners.isdisjoint(owners)] if owners else []
        numbers = {self._stored[key].number for key in keys}
        for key in keys:
            self._drop(key)
        return numbers

    def read(self, source: Source, owner: int, needs: MeshNeeds, is_mirrored: bool) -> StoredMesh:
        """The mesh of an evaluated object or of its hair, which the data-block `owner` (session_uid) makes or
        instances."""
        obj = source.obj if isinstance(source, HairSystem) else source
        assert obj.data is not None
        key = (source.address if isinstance(source, HairSystem) else obj.data.as_pointer(), needs, is_mirrored)
        self._used.add(key)
        if key not in self._stored:
            owners = frozenset((owner, obj.original.session_uid, obj.data.original.session_uid))
            shape = (obj.original.session_uid, needs, is_mirrored)
            if is_mirrored:
                plain = self.read(source, owner, needs, is_mirrored=False)
                arrays, dropped, remarks = mirrored(self.meshes[plain.number]), plain.dropped, plain.remarks
            else:
                arrays, dropped, remarks = self._read(source, needs, shape)
            arrays = self._replaced.get(arrays.signature) or with_known_arrays(arrays, self._shapes.get(shape))
            reach = 2.0 * max(float(arrays.positions.max(initial=0.0)), -float(arrays.positions.min(initial=0.0)))
            self._stored[key] = StoredMesh(self._number(arrays), dropped, remarks, owners, reach, shape)
        return self._stored[key]

    def _read(
        self, source: Source, needs: MeshNeeds, shape: _Shape
    ) -> tuple[MeshArrays, int, tuple[Remark | str, ...]]:
        reading = _read_surface(source, needs, self._topologies.get(shape))
        if shape in self._shapes and reading.topology is not None:
            self._topologies[shape] = reading.topology
        obj = source.obj if isinstance(source, HairSystem) else source
        self.reads += 1
        remarks: list[Remark | str] = []
        if reading.dropped:
            remarks.append(
                f'{reading.dropped} triangles of "{obj.name}" have a corner at no finite place or too far out '
                "and are left out."
            )
        remarks += [Remark(cause, "object", obj.name) for cause in reading.repaired]
        return reading.mesh, reading.dropped, tuple(remarks)

    def _number(self, arrays: MeshArrays) -> int:
        """The lowest free number for these arrays."""
        if self._free:
            number = heappop(self._free)
            self.meshes[number] = arrays
            return number
        self.meshes.append(arrays)
        return len(self.meshes) - 1

    def _drop(self, key: _Key) -> None:
        stored = self._stored.pop(key)
        arrays = self.meshes[stored.number]
        self._replaced[arrays.signature] = self._shapes[stored.shape] = arrays
        self.meshes[stored.number] = EMPTY
        heappush(self._free, stored.number)


def with_known_arrays(arrays: MeshArrays, known: MeshArrays | None) -> MeshArrays:
    """A mesh with those arrays of another one that hold the same: of one that deforms all but two stay the same
    objects."""
    if known is None:
        return arrays
    kept: dict[str, Any] = {}
    for name in _ARRAYS:
        new, old = getattr(arrays, name), getattr(known, name)
        if new is not None and old is not None and same_bits(new, old):
            kept[name] = old
    return replace(arrays, **kept)


def _read_surface(obj: Source, needs: MeshNeeds, known: Topology | None) -> MeshReading:
    if isinstance(obj, HairSystem) or is_strands_or_points(obj.data):
        return read_strands(obj, needs)
    assert isinstance(obj.data, bpy.types.Mesh)
    if not obj.data.is_editmode:
        return read_mesh(obj.data, needs, known)
    # What is being edited has its evaluated arrays only in a copy.
    mesh = obj.to_mesh()
    assert mesh is not None
    try:
        return read_mesh(mesh, needs, known)
    finally:
        obj.to_mesh_clear()
