# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All instances of a scene as one set of world-space triangles, in numpy and on the GPU.

A *position* is a vertex of a placed mesh; the solver works on positions. A *corner* adds normal and UV; triangles
index corners. On the GPU both live in record textures (see `gpu_objects`), and the vertex shader fetches them by
gl_VertexID = corner index (`geometry.glsl`), so one upload serves every pass.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..scene.arrays import Float32Array, InstanceArrays, Int32Array, MeshArrays, SceneArrays
from .gpu_objects import indexed_batch, record_texture

HOLDOUT = -1
"""Material index of what cuts a hole into the picture."""


@dataclass(frozen=True)
class WorldGeometry:
    """World-space triangle soup with shared vertices."""

    positions: Float32Array
    """(positions, 3)"""
    position_object: Int32Array
    """(positions,) object_id"""
    corner_position: Int32Array
    """(corners,) index into `positions`"""
    corner_normals: Float32Array
    """(corners, 3) unit"""
    corner_uv: Float32Array
    """(corners, 2)"""
    corner_color: Float32Array | None
    """(corners, 4) or None where no object has vertex colours; white for the objects that have none"""
    triangles: Int32Array
    """(triangles, 3) index into corners"""
    triangle_material: Int32Array
    """(triangles,) index into SceneArrays.materials, or HOLDOUT"""
    corner_mirror: Int32Array | None = None
    """(corners,) 1, 2, ... on the first, second, ... reflector and 0 elsewhere; None: no reflector is here"""

    @cached_property
    def bounds(self) -> tuple[Float32Array, Float32Array]:
        """Lowest and highest corner (3,) of the box around all positions; zeros without any."""
        if len(self.positions) == 0:
            return np.zeros(3, np.float32), np.zeros(3, np.float32)
        return self.positions.min(axis=0), self.positions.max(axis=0)

    @cached_property
    def position_texture(self) -> Any:
        """Records (xyz, object_id)."""
        return record_texture(np.column_stack([self.positions, self.position_object]).astype(np.float32))

    @cached_property
    def corner_texture(self) -> Any:
        """Two consecutive records per corner: (normal xyz, position index), (u, v, packed colour, mirror)."""
        records = np.zeros((len(self.corner_position), 2, 4), np.float32)
        records[:, 0, :3] = self.corner_normals
        records[:, 0, 3] = self.corner_position
        records[:, 1, :2] = self.corner_uv
        records[:, 1, 2] = 0xFFFFFF if self.corner_color is None else _pack_color(self.corner_color)
        if self.corner_mirror is not None:
            records[:, 1, 3] = self.corner_mirror
        return record_texture(records.reshape(-1, 4))

    @cached_property
    def batches(self) -> tuple[tuple[int, Any], ...]:
        """(material index, attribute-less GPUBatch) for every material that has triangles."""
        if len(self.triangles) == 0:
            return ()
        order = np.argsort(self.triangle_material, kind="stable")
        materials, starts = np.unique(self.triangle_material[order], return_index=True)
        groups = np.split(order, starts[1:])
        return tuple(
            (int(material), indexed_batch(self.triangles[group]))
            for material, group in zip(materials, groups, strict=True)
        )


def flatten(
    scene: SceneArrays,
    keep: Callable[[InstanceArrays], bool] = lambda _: True,
    mirror_of: Callable[[InstanceArrays], int] | None = None,
    holdouts: bool = False,
) -> WorldGeometry:
    """Place every instance that `keep` accepts into world space.

    `mirror_of` numbers the reflectors (see `corner_mirror`). With `holdouts`, instances that hold out get that as their
    material: the eye sees a hole there, a mirror sees the object. Normals go by the inverse transpose; a mirroring
    matrix (negative scale) keeps them pointing to the same side.
    """
    chosen = [instance for instance in scene.instances if keep(instance)]
    parts = [_place(scene.meshes[instance.mesh], instance) for instance in chosen]
    position_counts = [len(part[0]) for part in parts]
    corner_counts = [len(part[1]) for part in parts]
    position_starts = np.concatenate([[0], np.cumsum(position_counts, dtype=np.int64)]).astype(np.int32)
    corner_starts = np.concatenate([[0], np.cumsum(corner_counts, dtype=np.int64)]).astype(np.int32)
    meshes = [scene.meshes[instance.mesh] for instance in chosen]
    any_color = any(mesh.corner_color is not None for mesh in meshes)

    def joined(arrays: list[np.ndarray], shape: tuple[int, ...], dtype: type) -> np.ndarray:
        return np.concatenate(arrays) if arrays else np.zeros(shape, dtype)

    return WorldGeometry(
        positions=joined([part[0] for part in parts], (0, 3), np.float32),
        position_object=np.repeat(np.array([instance.object_id for instance in chosen], np.int32), position_counts),
        corner_position=joined(
            [mesh.corner_vertex + start for mesh, start in zip(meshes, position_starts, strict=False)], (0,), np.int32
        ),
        corner_normals=joined([part[1] for part in parts], (0, 3), np.float32),
        corner_uv=joined(
            [
                mesh.corner_uv if mesh.corner_uv is not None else np.zeros((count, 2), np.float32)
                for mesh, count in zip(meshes, corner_counts, strict=True)
            ],
            (0, 2),
            np.float32,
        ),
        corner_color=joined(
            [
                mesh.corner_color if mesh.corner_color is not None else np.ones((count, 4), np.float32)
                for mesh, count in zip(meshes, corner_counts, strict=True)
            ],
            (0, 4),
            np.float32,
        )
        if any_color
        else None,
        triangles=joined(
            [mesh.triangles + start for mesh, start in zip(meshes, corner_starts, strict=False)],
            (0, 3),
            np.int32,
        ),
        triangle_material=joined(
            [
                np.full(len(mesh.triangles), HOLDOUT, np.int32)
                if holdouts and instance.holdout
                else np.asarray(instance.materials, np.int32)[
                    np.minimum(mesh.triangle_slot, len(instance.materials) - 1)
                ]
                for mesh, instance in zip(meshes, chosen, strict=True)
            ],
            (0,),
            np.int32,
        ),
        corner_mirror=np.repeat(np.array([mirror_of(instance) for instance in chosen], np.int32), corner_counts)
        if mirror_of
        else None,
    )


def _place(mesh: MeshArrays, instance: InstanceArrays) -> tuple[Float32Array, Float32Array]:
    """World positions and corner normals of one instance."""
    linear = instance.matrix[:3, :3]
    positions = mesh.positions @ linear.T.astype(np.float32) + instance.matrix[:3, 3].astype(np.float32)
    normals = mesh.corner_normals @ np.linalg.inv(linear).astype(np.float32)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals /= np.where(lengths > 0, lengths, 1)
    return positions.astype(np.float32), normals.astype(np.float32)


def _pack_color(color: Float32Array) -> Float32Array:
    """24-bit colour in a float (exact up to 2^24): vertex colours are smooth, 8 bits of their square root suffice."""
    levels = np.rint(np.sqrt(np.clip(color[:, :3], 0.0, 1.0)) * 255.0).astype(np.int32)
    return (levels[:, 0] + 256 * levels[:, 1] + 65536 * levels[:, 2]).astype(np.float32)
