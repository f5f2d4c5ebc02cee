# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of the texture that rays walk through: nodes, triangles, corners and materials (see `ray_walk.glsl`)."""

from __future__ import annotations

from enum import IntFlag

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import (
    Float32Array,
    InstanceArrays,
    Int32Array,
    MeshArrays,
)
from ...scene.programs.program import Attribute
from ..geometry.chunk_attributes import places_of
from .hierarchy import Hierarchy

NODE_RECORDS = 4


TRIANGLE_RECORDS = 4


OUT_OF_THE_WAY = 1e30
"""Where a box is that no ray need enter"""


class InstanceFlag(IntFlag):
    """What is known of an instance."""

    SEEN_IN_MIRRORS = 1
    CASTS_SHADOWS = 2
    NEVER_SEES_ITSELF = 4
    """The next too: of mirrors and of what is seen through"""
    IS_CLOSED = 8
    IS_MIRRORED = 16
    """Its matrix turns space inside out"""
    SEEN_BY_CAMERA = 32
    SEEN_THROUGH_GLASS = 64
    HOLDS_OUT = 128
    """A hole for rays of the camera"""
    CASTS_IN_PART = 256
    """Shadows; light goes straight on through some of it"""
    SEEN_BY_DIFFUSE = 512
    """By rays off what scatters light"""


def seen_by(instance: InstanceArrays, is_clear: bool) -> int:
    """Flags of what an instance is there for; `is_clear`: light goes straight on through some of it."""
    return (
        InstanceFlag.SEEN_IN_MIRRORS * instance.visible_glossy
        | InstanceFlag.CASTS_SHADOWS * instance.visible_shadow
        | InstanceFlag.SEEN_BY_CAMERA * instance.visible_camera
        | InstanceFlag.SEEN_THROUGH_GLASS * instance.visible_transmission
        | InstanceFlag.SEEN_BY_DIFFUSE * instance.visible_diffuse
        | InstanceFlag.HOLDS_OUT * instance.holdout
        | InstanceFlag.CASTS_IN_PART * (instance.visible_shadow and is_clear)
    )


def triangle_corners(mesh: MeshArrays, corners: Int32Array) -> tuple[Float32Array, Float32Array, Float32Array]:
    """Where the three corners (n, 3) are, (n, 3) each, object space."""
    # (`take` gathers rows in half the time of an index)
    vertices = np.take(mesh.corner_vertex, corners)
    a, b, c = (np.take(mesh.positions, vertices[:, k], axis=0) for k in range(3))
    return a, b, c


def node_records(hierarchy: Hierarchy, leaf_link: NDArray[np.int64], leaf_count: NDArray[np.int64]) -> Float32Array:
    """Of all inner nodes; `leaf_link`, `leaf_count`: what stands for leaves (nodes,)."""
    is_inner = hierarchy.count == 0
    number = np.cumsum(is_inner) - 1
    if not is_inner.any():
        # The root is a leaf: it gets an inner node above it, with itself once more as other child, out of the way.
        records = np.zeros((1, 2, 2, 4), np.float32)
        records[:, :, 0, 3], records[:, :, 1, 3] = leaf_link[0], leaf_count[0]
        records[0, 0, 0, :3], records[0, 0, 1, :3] = hierarchy.low[0], hierarchy.high[0]
        records[0, 1, :, :3] = OUT_OF_THE_WAY
        return records.reshape(-1, 4)
    children = hierarchy.children
    records = np.empty((len(children), 2, 2, 4), np.float32)
    records[:, :, 0, 3] = np.where(is_inner, number, leaf_link)[children]
    records[:, :, 1, 3] = np.where(is_inner, 0, leaf_count)[children]
    joined = records.reshape(-1, 4)
    put_boxes(joined, hierarchy)
    return joined


def put_boxes(records: Float32Array, hierarchy: Hierarchy) -> None:
    """Write the boxes of a tree into its `node_records`; its root is no leaf."""
    boxes = records.reshape(-1, 2, 2, 4)
    boxes[:, :, 0, :3], boxes[:, :, 1, :3] = hierarchy.low[hierarchy.children], hierarchy.high[hierarchy.children]


def triangle_records(mesh: MeshArrays, order: NDArray[np.int64]) -> Float32Array:
    corners = np.take(mesh.triangles, order, axis=0)
    a, b, c = triangle_corners(mesh, corners)
    records = np.empty((len(order), TRIANGLE_RECORDS, 4), np.float32)
    records[:, 0, :3] = a
    np.subtract(b, a, out=records[:, 1, :3])
    np.subtract(c, a, out=records[:, 2, :3])
    records[:, :3, 3] = 0.0
    records[:, 3, :3] = corners
    records[:, 3, 3] = np.take(mesh.triangle_slot, order)
    return records.reshape(-1, 4)


def corner_records(mesh: MeshArrays) -> Float32Array:
    records = np.zeros((len(mesh.corner_vertex), 4), np.float32)
    records[:, :3] = mesh.corner_normals
    # (for `hierarchy_fit`)
    records[:, 3] = mesh.corner_vertex
    return records


def attribute_records(mesh: MeshArrays) -> Float32Array:
    """What programs read of the mesh, corner by corner."""
    if mesh.corner_attributes is None:
        return np.zeros((0, 4), np.float32)
    return mesh.corner_attributes.reshape(-1, 4)


class NumberLists:
    """Lists of numbers, four to a record; equal ones are stored once."""

    def __init__(self) -> None:
        self._firsts: dict[tuple[int, ...], int] = {}
        self._numbers: list[int] = []

    def first_record(self, numbers: tuple[int, ...]) -> int:
        """Where a list is."""
        if numbers not in self._firsts:
            self._firsts[numbers] = len(self._numbers) // 4
            self._numbers += numbers
            self._numbers += [0] * (-len(self._numbers) % 4)
        return self._firsts[numbers]

    def first_of_places(self, order: tuple[Attribute, ...], mesh: MeshArrays) -> int:
        """Where it says how many attributes a mesh has, and at which place each of the scene's; 0 without any."""
        return self.first_record((len(mesh.attributes), *places_of(order, mesh.attributes))) if order else 0

    @property
    def records(self) -> Float32Array:
        """All, (n, 4)."""
        return np.array(self._numbers, np.float32).reshape(-1, 4)
