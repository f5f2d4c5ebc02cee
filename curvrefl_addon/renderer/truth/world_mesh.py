# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Placed meshes as one, world space, float64: what rays and searches in numpy go through."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...optics.surfaces.mesh_images import MeshImages
from ...optics.surfaces.mesh_rays import MeshRays
from ...optics.surfaces.mesh_reflections import ReflectingMesh
from ...scene.arrays import Float64Array, SceneArrays


@dataclass(frozen=True)
class WorldMesh:
    """The triangles of some instances of a scene."""

    positions: Float64Array
    """(corners, 3)"""
    normals: Float64Array
    """(corners, 3) shading normals; not of unit length: they are interpolated as in the instances' own space"""
    triangles: NDArray[np.int64]
    """(triangles, 3) of corners"""
    instance: NDArray[np.int64]
    """(triangles,) index in the scene"""
    triangle: NDArray[np.int64]
    """(triangles,) number in the instance's mesh"""

    @cached_property
    def rays(self) -> MeshRays:
        """For casting rays; made when first asked for. There is a triangle."""
        return MeshRays(self.positions, self.normals, self.triangles)

    @cached_property
    def mirror(self) -> ReflectingMesh:
        """For searching reflection points; made when first asked for. There is a triangle."""
        return ReflectingMesh(self.positions, self.normals, self.triangles)

    @cached_property
    def images(self) -> MeshImages:
        """For searching where a picture shows a scene point; made when first asked for. There is a triangle."""
        return MeshImages(self.positions, self.normals, self.triangles)

    @property
    def middle(self) -> Float64Array:
        """(3,) of the box around it."""
        return 0.5 * (self.positions.min(axis=0) + self.positions.max(axis=0))

    @property
    def size(self) -> float:
        """Of the box around it, from corner to corner."""
        return float(np.linalg.norm(np.ptp(self.positions, axis=0)))


def world_mesh(scene: SceneArrays, instances: Iterable[int]) -> WorldMesh:
    """Of the instances with these indices."""
    positions, normals, triangles = [np.zeros((0, 3))], [np.zeros((0, 3))], [np.zeros((0, 3), np.int64)]
    owner, number = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    first = 0
    for index in instances:
        item = scene.instances[index]
        mesh, turn = scene.meshes[item.mesh], item.matrix[:3, :3]
        positions.append(mesh.positions[mesh.corner_vertex].astype(np.float64) @ turn.T + item.matrix[:3, 3])
        normals.append(mesh.corner_normals.astype(np.float64) @ np.linalg.inv(turn))
        triangles.append(mesh.triangles.astype(np.int64) + first)
        owner.append(np.full(len(mesh.triangles), index))
        number.append(np.arange(len(mesh.triangles)))
        first += len(mesh.corner_vertex)
    return WorldMesh(
        np.concatenate(positions),
        np.concatenate(normals),
        np.concatenate(triangles),
        np.concatenate(owner),
        np.concatenate(number),
    )
