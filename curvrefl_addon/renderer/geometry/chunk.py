# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Some instances of a scene as one set of triangles on the GPU: object space and matrices up, world space there.

A *position* is a vertex of a placed mesh; the solver works on positions. A *corner* adds normal and UV; triangles
index corners. On the GPU all live in record textures (see `device/records.py`), and vertex shaders fetch them by
gl_VertexID = corner index (`geometry.glsl`), so one set serves every pass. A compute pass (`place.comp.glsl`) makes
the world-space records: when an instance moves, its matrix is all that is uploaded, and when its mesh deforms what
`vertex_uploads` has of it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import InstanceArrays, Int32Array, MeshArrays
from ..device.batches import by_material, indexed_batch
from ..device.context import gpu_cache
from ..device.records import empty_record_texture, padded_count, record_texture
from ..device.shaders import Image, Piece, flags, named
from ..device.ways.features import Features, features
from ..device.ways.record_pass import RecordPass, build_record_pass
from .chunk_attributes import CornerAttributes
from .mesh_pieces import is_count
from .vertex_uploads import VertexUploads

HOLDOUT = -1
"""Material index of what cuts a hole into the picture"""
INSTANCE_RECORDS = 8
"""Per instance: rows of the matrix, of the normals' matrix, (object_id, mirror number, 0, 0), 0"""
CHUNK = Piece(samplers=named("FLOAT_2D", "positions", "corners"))
"""What `geometry.glsl` needs of a chunk"""
MOST_RANGES = 8
"""More moved instances than these are placed all in one dispatch"""

type Range = tuple[int, int, int, int]
"""First position, how many, first corner, how many"""
type Pieces = frozenset[tuple[int, int]]
"""Pairs (index of an instance in its chunk, piece of its mesh)"""
type Batches = tuple[tuple[int, Any], ...]
"""(material index, GPUBatch without attributes) for every material that has triangles"""


@dataclass(frozen=True, slots=True)
class Placed:
    """An instance and what is drawn for it."""

    instance: InstanceArrays
    mesh: MeshArrays
    """As it was read"""
    drawn: MeshArrays
    """The same surface, its long edges split (see `split`)"""
    pieces: NDArray[np.int8]
    """(triangles of `drawn`,) which piece of the mesh each is in (see `mesh_pieces`)"""
    mirror: int = 0
    """1, 2, ... for a reflector"""


class Triangles(Protocol):
    """What passes over triangles draw: a chunk, or parts of one."""

    @property
    def positions(self) -> Any: ...

    @property
    def corners(self) -> Any: ...

    @property
    def attributes(self) -> CornerAttributes: ...

    @property
    def placed_chunk(self) -> Chunk:
        """Whose instances they are of."""
        ...


class Chunk:
    """GPU side of a few or many placed instances; its textures are freed with it."""

    def __init__(self, placed: Sequence[Placed]) -> None:
        """Uploads all. At least one instance."""
        self.placed = list(placed)
        meshes = [item.drawn for item in placed]
        self._position_starts = _starts([len(mesh.positions) for mesh in meshes])
        self._corner_starts = _starts([len(mesh.corner_vertex) for mesh in meshes])
        triangle_counts = [len(mesh.triangles) for mesh in meshes]
        self.position_count = int(self._position_starts[-1])
        self.triangle_count = sum(triangle_counts)
        self.triangles: Int32Array = _joined([mesh.triangles for mesh in meshes], self._corner_starts)
        """(triangles, 3) index into corners; not to be changed, as the next two"""
        self._triangle_instance = np.repeat(np.arange(len(meshes), dtype=np.int32), triangle_counts)
        self.triangle_material: Int32Array = np.concatenate([_materials(item) for item in placed])
        """(triangles,) material index"""
        self.corner_position = _joined([mesh.corner_vertex for mesh in meshes], self._position_starts)
        """(corners,) index into positions"""
        self._is_count = len(meshes) == 1 and is_count(self.corner_position)
        self._batches: dict[tuple[bytes, bool], Batches] = {}
        self._caster_batches: dict[tuple[Pieces, frozenset[int]], Any] = {}
        self._batches_of_casters: dict[tuple[Pieces, frozenset[int]], Batches] = {}
        self.revision = 0
        """Another one when positions are not the same any more"""
        self.shape_revision = 0
        """And when they are not in object space"""
        self._deformed: dict[int, tuple[Any, Any]] = {}
        """By instance textures of positions and normals (`VertexUploads`), in place of those it was made with"""

        corner_count = int(self._corner_starts[-1])
        sources = np.zeros((padded_count(self.position_count), 4), np.float32)
        corners = np.zeros((padded_count(2 * corner_count) // 2, 2, 4), np.float32)
        corners[:corner_count, 0, 3] = self.corner_position
        for index, mesh in enumerate(meshes):
            here = slice(self._position_starts[index], self._position_starts[index + 1])
            sources[here, :3] = mesh.positions
            sources[here, 3] = index
            here = slice(self._corner_starts[index], self._corner_starts[index + 1])
            corners[here, 0, :3] = mesh.corner_normals
        self._source_positions = record_texture(sources)
        self._source_corners = record_texture(corners.reshape(-1, 4))
        self.positions = empty_record_texture(self.position_count)
        """Records (world xyz, object_id)"""
        self.corners = empty_record_texture(2 * corner_count)
        """Two consecutive records per corner: (normal xyz, position index), (0, 0, 0, mirror)"""
        self._table = np.zeros((len(meshes), INSTANCE_RECORDS, 4), np.float32)
        self._fill_table(range(len(meshes)))
        self._place(((0, self.position_count, 0, corner_count),))

    @property
    def placed_chunk(self) -> Chunk:
        """Itself (see `Triangles`)."""
        return self

    @cached_property
    def attributes(self) -> CornerAttributes:
        """What programs read at its corners."""
        return CornerAttributes.of_meshes([item.drawn for item in self.placed])

    def move(self, changed: Mapping[int, Placed]) -> None:
        """Replace instances by the same with another matrix, object_id or mirror number."""
        for index, item in changed.items():
            self.placed[index] = item
        self.revision += 1
        self._fill_table(changed)
        if len(changed) > MOST_RANGES:
            if len(self._deformed) < len(self.placed):
                self._place(((0, self.position_count, 0, int(self._corner_starts[-1])),))
            deformed = set(self._deformed)
        else:
            self._place([self._range(index) for index in changed if index not in self._deformed])
            deformed = self._deformed.keys() & changed.keys()
        for index in deformed:
            self._place([self._range(index)], deformed=index)

    def deform(self, changed: Mapping[int, Placed], uploads: VertexUploads) -> None:
        """Replace instances by the same with their vertices elsewhere (`is_deformed`), and what `move` does."""
        ranges: dict[int, Range] = {}
        for index, item in changed.items():
            before = self.placed[index]
            assert item.drawn is item.mesh, "parts of split edges cannot follow"
            if before.pieces is not item.pieces:
                self._caster_batches.clear()
                self._batches_of_casters.clear()
            first, count, first_corner, corner_count = self._range(index)
            is_turned = (
                before.drawn.corner_normals is not item.drawn.corner_normals
                or before.mirror != item.mirror
                or not np.array_equal(before.instance.matrix, item.instance.matrix)
            )
            ranges[index] = (first, count, first_corner, corner_count if is_turned else 0)
            mesh = item.drawn
            self._deformed[index] = uploads.texture(mesh.positions), uploads.texture(mesh.corner_normals)
            self.placed[index] = item
        if len(self._deformed) == len(self.placed):
            # Nothing will be placed from there any more.
            self._source_positions = None
        self.revision += 1
        self.shape_revision += 1
        self._fill_table(changed)
        for index, numbers in ranges.items():
            self._place([numbers], deformed=index)

    def _range(self, index: int) -> Range:
        """Of an instance."""
        first, end = self._position_starts[index : index + 2].tolist()
        first_corner, corner_end = self._corner_starts[index : index + 2].tolist()
        return (first, end - first, first_corner, corner_end - first_corner)

    def batches(self, keep: NDArray[np.bool_], holdouts: bool = False) -> Batches:
        """Triangles of the instances that `keep` (instances,) chooses, by material.

        With `holdouts`, instances that hold out get HOLDOUT as their material: the eye sees a hole there, a mirror
        sees the object.
        """
        held = np.array([item.instance.holdout for item in self.placed]) if holdouts else np.zeros(len(keep), bool)
        holdouts = bool((held & keep).any())
        key = (keep.tobytes(), holdouts)
        if key not in self._batches:
            material = self.triangle_material
            if holdouts:
                material = np.where(held[self._triangle_instance], HOLDOUT, material)
            triangles = self.triangles
            if not keep.all():
                chosen = keep[self._triangle_instance]
                triangles, material = triangles[chosen], material[chosen]
            self._batches[key] = by_material(triangles, material)
        return self._batches[key]

    def casters(self, idle: Pieces, without: frozenset[int] = frozenset()) -> Any:
        """GPUBatch, indices into positions, of the triangles that cast shadows; None where there are none.

        `idle` are left out, and those of the materials `without`.
        """
        key = (idle, without)
        if key not in self._caster_batches:
            casts = np.array([item.instance.visible_shadow for item in self.placed])
            if not idle and not without and casts.all() and self._is_count:
                # Corners are the positions: what is seen whole serves.
                whole = self.batches(casts)
                if len(whole) == 1:
                    self._caster_batches[key] = whole[0][1]
                    return whole[0][1]
            chosen = self._casting(idle)
            if without:
                chosen &= ~np.isin(self.triangle_material, list(without))
            triangles = self.triangles if chosen.all() else self.triangles[chosen]
            batch = indexed_batch(self.corner_position[triangles]) if len(triangles) else None
            self._caster_batches[key] = batch
        return self._caster_batches[key]

    def casters_of(self, idle: Pieces, materials: frozenset[int]) -> Batches:
        """Batches, indices into corners, of the triangles of some materials that cast shadows; `idle` are left out."""
        key = (idle, materials)
        if key not in self._batches_of_casters:
            chosen = self._casting(idle) & np.isin(self.triangle_material, list(materials))
            self._batches_of_casters[key] = by_material(self.triangles[chosen], self.triangle_material[chosen])
        return self._batches_of_casters[key]

    def _casting(self, idle: Pieces) -> NDArray[np.bool_]:
        """(triangles,)"""
        casts = np.array([item.instance.visible_shadow for item in self.placed])
        chosen = casts[self._triangle_instance]
        for index, piece in idle:
            pieces = self.placed[index].pieces
            start = int(np.searchsorted(self._triangle_instance, index))
            chosen[start : start + len(pieces)] &= pieces != piece
        return chosen

    def _fill_table(self, indices: Sequence[int] | Mapping[int, Placed] | range) -> None:
        rows = list(indices)
        matrices = np.array([self.placed[index].instance.matrix for index in rows])
        self._table[rows, :3] = matrices[:, :3]
        # (M^-1)^T, for row vectors of normals n M^-1
        self._table[rows, 3:6, :3] = np.linalg.inv(matrices[:, :3, :3]).transpose(0, 2, 1)
        self._table[rows, 6, 0] = [self.placed[index].instance.object_id for index in rows]
        self._table[rows, 6, 1] = [self.placed[index].mirror for index in rows]

    def place_points(self, sources: Any, count: int) -> Any:
        """World-space records of other points of the same instances: `sources` has (object xyz, index of instance)."""
        points = empty_record_texture(count)
        self._place(((0, count, 0, 0),), sources, points)
        return points

    def _place(
        self, ranges: Sequence[Range], sources: Any = None, positions: Any = None, deformed: int | None = None
    ) -> None:
        """Run the pass over these; `deformed`: an instance whose mesh has, which they are of."""
        if not ranges:
            return
        table = record_texture(self._table.reshape(-1, 4))
        device = features()
        for what in ("both",) if device.compute else ("positions", "corners"):
            placing = _place_pass(device, what, deformed is not None)
            shader = placing.shader
            shader.bind()
            if deformed is None:
                shader.uniform_sampler("source_positions", sources or self._source_positions)
            else:
                shader.uniform_int("deformed_instance", deformed)
                for name, texture in zip(("mesh_positions", "mesh_normals"), self._deformed[deformed], strict=True):
                    shader.uniform_sampler(name, texture)
            shader.uniform_sampler("source_corners", self._source_corners)
            shader.uniform_sampler("instances", table)
            images = {"positions": positions or self.positions, "corners": self.corners}
            for numbers in ranges:
                shader.uniform_int("range", numbers)
                first, count = (numbers[0], max(numbers[1], numbers[3]))
                if what == "corners":
                    first, count = 2 * numbers[2], 2 * numbers[3]
                placing.run(images, count, first)


def _starts(counts: list[int]) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])


def _joined(indices: list[Int32Array], starts: NDArray[np.int64]) -> Int32Array:
    """Indices into joined arrays, those of the first as they are."""
    if len(indices) == 1:
        return indices[0]
    return np.concatenate([part + np.int32(start) for part, start in zip(indices, starts, strict=False)])


def _materials(item: Placed) -> Int32Array:
    """(triangles,) material index."""
    materials = np.asarray(item.instance.materials, np.int32)
    if len(materials) == 1:
        return np.full(len(item.drawn.triangles), materials[0], np.int32)
    return materials[np.minimum(item.drawn.triangle_slot, len(materials) - 1)]


@gpu_cache
def _place_pass(device: Features, what: str, is_deformed: bool) -> RecordPass:
    """`what`: "positions" or "corners", or "both" by compute."""
    images = ("positions", "corners") if what == "both" else (what,)
    sources = ("mesh_positions", "mesh_normals") if is_deformed else ("source_positions",)
    return build_record_pass(
        f"place {'deformed ' if is_deformed else ''}{what}",
        device,
        Piece(
            constants={"range": "IVEC4", **({"deformed_instance": "INT"} if is_deformed else {})},
            samplers=named("FLOAT_2D", *sources, "source_corners", "instances"),
            images=dict.fromkeys(images, Image()),
            defines={
                "INSTANCE_RECORDS": INSTANCE_RECORDS,
                **flags(*(["PLACES_CORNERS"] if what == "corners" else []), *(["DEFORMED"] if is_deformed else [])),
            },
            compute="surfaces/place.comp.glsl",
        ),
    )
