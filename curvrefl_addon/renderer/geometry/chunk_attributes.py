# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs read at the corners of a chunk: attributes, and which instance a corner is of (see
`common/corner_attributes.glsl`). On the GPU only once it is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float32Array, Int32Array, MeshArrays, SceneArrays
from ...scene.programs.program import UV, Attribute
from ..device.records import record_texture
from ..device.shaders import Piece

LACKING, LACKING_BY_NAME = -1, -2
"""In place of an attribute's place: it is 0, or (0, 0, 0, 1)"""
CORNER_ATTRIBUTES = Piece(
    samplers={"corner_attribute_records": "FLOAT_2D"}, defines={"LACKING_BY_NAME": LACKING_BY_NAME}
)
"""What `common/corner_attributes.glsl` needs"""
CORNER_INSTANCES = Piece(samplers={"corner_instance_records": "FLOAT_2D"})
"""What `common/corner_instances.glsl` needs"""


def attributes_of(scene: SceneArrays) -> tuple[Attribute, ...]:
    """All that programs read of meshes, ascending: their numbers in shaders are those in this list."""
    programs = (material.program for material in scene.materials)
    return tuple(sorted({item for program in programs if program is not None for item in program.attributes}))


def places_of(order: Sequence[Attribute], own: Sequence[Attribute]) -> list[int]:
    """For each attribute of the scene its place among one's own, or LACKING, LACKING_BY_NAME."""
    places = {attribute: place for place, attribute in enumerate(own)}
    return [places.get(item, LACKING_BY_NAME if item.name and item.kind != UV else LACKING) for item in order]


class CornerAttributes:
    """Of the corners of a chunk, or of pieces of its triangles."""

    def __init__(self, own: tuple[Attribute, ...], values: Float32Array | None, instances: Int32Array) -> None:
        self.own = own
        """Those that any of its meshes has"""
        self.values = values
        """(corners, len(own), 4); None where there are none"""
        self.instances = instances
        """(corners,) number of the instance in its chunk"""
        self._order: tuple[Attribute, ...] | None = None
        self._texture: Any = None
        self._rows = b""
        self._instance_texture: Any = None

    @classmethod
    def of_meshes(cls, meshes: Sequence[MeshArrays]) -> CornerAttributes:
        """Of placed meshes, one after the other."""
        own = tuple(sorted({attribute for mesh in meshes for attribute in mesh.attributes}))
        counts = [len(mesh.corner_vertex) for mesh in meshes]
        instances = np.repeat(np.arange(len(meshes), dtype=np.int32), counts)
        if not own:
            return cls(own, None, instances)
        values = np.zeros((sum(counts), len(own), 4), np.float32)
        start = 0
        for mesh, count in zip(meshes, counts, strict=True):
            here = values[start : start + count]
            start += count
            for number, place in enumerate(places_of(own, mesh.attributes)):
                if place >= 0:
                    assert mesh.corner_attributes is not None
                    here[:, number] = mesh.corner_attributes[:, place]
                elif place == LACKING_BY_NAME:
                    here[:, number, 3] = 1.0
        return cls(own, values, instances)

    def of_pieces(self, halved: Sequence[Int32Array], used: NDArray[np.integer]) -> CornerAttributes:
        """Those of the rows `used` of these corners and, after them, of the means of pairs (n, 2) of rows in turn."""
        values, instances = self.values, self.instances
        for pairs in halved:
            # (Both ends are the same instance's.)
            instances = np.concatenate([instances, instances[pairs[:, 0]]])
            if values is not None:
                values = np.concatenate([values, np.float32(0.5) * (values[pairs[:, 0]] + values[pairs[:, 1]])])
        return CornerAttributes(self.own, None if values is None else values[used], instances[used])

    def texture(self, order: tuple[Attribute, ...]) -> Any:
        """Record texture for the sampler `corner_attribute_records`; `order`: see `attributes_of`."""
        if self._texture is None or self._order != order:
            self._order = order
            head = np.zeros((len(order), 4), np.float32)
            head[:, 0] = places_of(order, self.own)
            head[:, 1], head[:, 2] = len(order), len(self.own)
            parts = [head] if self.values is None else [head, self.values.reshape(-1, 4)]
            self._texture = record_texture(np.concatenate(parts))
        return self._texture

    def instance_texture(self, rows: Int32Array) -> Any:
        """Record texture for `corner_instance_records`; `rows`: of the chunk's instances in the table of instances."""
        if self._instance_texture is None or self._rows != rows.tobytes():
            self._rows = rows.tobytes()
            numbers = np.zeros(-(-len(self.instances) // 4) * 4, np.float32)
            numbers[: len(self.instances)] = rows[self.instances]
            self._instance_texture = record_texture(numbers.reshape(-1, 4))
        return self._instance_texture
