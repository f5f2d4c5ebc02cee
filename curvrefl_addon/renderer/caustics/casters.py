# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that throw light on: of chosen mirrors, and of what light goes through. Pure numpy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ...optics.surfaces.radial_surfaces import unit
from ...scene.arrays import Float64Array, InstanceArrays, SceneArrays
from ..geometry.mesh_facts import MeshFactsCache
from ..paths.features import SHARP_ROUGHNESS, goes_on

type Int64Array = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Casters:
    """All of a scene's, in world space."""

    corners: Float64Array
    """(n, 3, 3) places of the triangles' corners"""
    normals: Float64Array
    """(n, 3, 3) unit shading normals there"""
    facing: Float64Array
    """(n, 3) unit normals of the triangles, on the side of their front faces"""
    areas: Float64Array
    """(n,)"""
    instances: Int64Array
    """(n,) indices in the scene"""
    triangles: Int64Array
    """(n,) in their meshes"""
    materials: Int64Array
    """(n,)"""
    objects: Int64Array
    """(n,) object_id"""
    mirrors: Int64Array
    """(n,) numbers of chosen mirrors, else 0"""
    numbers: Int64Array
    """(n, 3) of the corners of their meshes: triangles that meet smoothly share them"""
    is_closed: NDArray[np.bool_]
    """(n,) nothing shines on their back faces"""

    @property
    def count(self) -> int:
        """Of triangles"""
        return len(self.areas)


def casters_of(scene: SceneArrays, numbers: Mapping[int, int], facts: MeshFactsCache) -> Casters | None:
    """None where nothing throws light; `numbers`: of mirrors, by the indices of their instances."""
    parts = []
    corners = 0
    for index, instance in enumerate(scene.instances):
        is_mirror = index in numbers
        thrown = {number for number in instance.materials if throws(scene, number, is_mirror)}
        if not thrown or not _is_met(instance):
            continue
        part = _placed(scene, index, numbers.get(index, 0), facts)
        kept = np.isin(part.materials, list(thrown)) & (part.areas > 0.0)
        if kept.any():
            part.numbers[:] += corners
            parts.append([getattr(part, field.name)[kept] for field in fields(Casters)])
            corners += len(scene.meshes[instance.mesh].corner_vertex)
    return Casters(*(np.concatenate(column) for column in zip(*parts, strict=True))) if parts else None


def throws(scene: SceneArrays, material: int, is_mirror: bool) -> bool:
    """Whether a material throws light on that is sharp enough to be told from scattered light, which the light between
    surfaces knows."""
    known = scene.materials[material]
    # (Where light goes straight on it is no caustic: lamps' shadows know.)
    follows = is_mirror or (goes_on(known, is_mirror) and known.may_be("transmission"))
    reflects = known.may_be("metallic") or known.glossy_only or known.varies("kind") or known.may_be("specular_level")
    is_sharp = known.range_of("roughness")[0] <= SHARP_ROUGHNESS
    return follows and is_sharp and (reflects or known.may_be("transmission"))


def _is_met(instance: InstanceArrays) -> bool:
    """Whether light that is scattered elsewhere can have come from there."""
    return instance.visible_diffuse and not instance.holdout


def _placed(scene: SceneArrays, index: int, mirror: int, facts: MeshFactsCache) -> Casters:
    instance = scene.instances[index]
    mesh = scene.meshes[instance.mesh]
    matrix = instance.matrix[:3, :3]
    world = mesh.positions.astype(np.float64) @ matrix.T + instance.matrix[:3, 3]
    corners = world[mesh.corner_vertex[mesh.triangles]]
    normals = unit(mesh.corner_normals.astype(np.float64) @ np.linalg.inv(matrix))[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if np.linalg.det(matrix) < 0.0:
        across = -across
    length = np.linalg.norm(across, axis=1)
    count = len(corners)
    slots = np.minimum(mesh.triangle_slot, len(instance.materials) - 1)
    return Casters(
        corners,
        normals,
        across / np.maximum(length, 1e-300)[:, None],
        np.where(np.isfinite(length), 0.5 * length, 0.0),
        np.full(count, index),
        np.arange(count),
        np.array(instance.materials, np.int64)[slots],
        np.full(count, instance.object_id),
        np.full(count, mirror),
        mesh.triangles.astype(np.int64),
        np.full(count, facts.of(mesh).is_closed),
    )
