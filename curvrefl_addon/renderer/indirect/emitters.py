# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that shine, as lights: their triangles with how often each is asked. Pure numpy, but for the texture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import EVERY_SET, Float32Array, Float64Array, MaterialArrays, SceneArrays
from ..device.records import record_texture
from ..device.shaders import Piece

RECORDS = 3
"""Of a triangle"""
MOST_EMITTERS = 200_000
"""Triangles; of more only the strongest are lights"""
EMITTERS = Piece(
    samplers={"emitters": "FLOAT_2D"},
    constants={"emitter_count": "INT"},
    defines={"EMITTERS": "", "EMITTER_RECORDS": RECORDS},
)
"""What `emitters.glsl` needs"""
SHINES = Piece(samplers={"shining": "FLOAT_2D"})
"""Of materials: the density of a place on them over area, and with shadow linking 1 where rays to them find all"""


@dataclass(frozen=True, slots=True)
class EmitterTable:
    """Triangles in world space."""

    records: Float32Array
    """(triangles * RECORDS, 4), see `emitters.glsl`"""
    densities: Float32Array
    """(materials,) of a place on a material over area, 1/m2; 0 of those that do not shine"""
    are_linked: NDArray[np.bool_]
    """(materials,) some objects cast no shadow in their light"""

    @property
    def count(self) -> int:
        return len(self.records) // RECORDS


class Emitters:
    """The same on the GPU."""

    def __init__(self, table: EmitterTable) -> None:
        self.count = table.count
        self._records = record_texture(table.records)
        densities = np.zeros((len(table.densities), 4), np.float32)
        densities[:, 0], densities[:, 1] = table.densities, table.are_linked
        self._densities = record_texture(densities)

    def bind(self, shader: Any) -> None:
        """Set what `EMITTERS` names on a bound shader."""
        shader.uniform_sampler("emitters", self._records)
        shader.uniform_int("emitter_count", self.count)

    def bind_densities(self, shader: Any) -> None:
        """Set what `SHINES` names."""
        shader.uniform_sampler("shining", self._densities)


def emitter_table(scene: SceneArrays) -> EmitterTable | None:
    """Of all triangles that rays see; None where nothing shines."""
    strengths = np.array([strength_of(material) for material in scene.materials])
    if not (strengths > 0.0).any():
        return None
    parts: list[Float64Array] = []
    powers: list[Float64Array] = []
    strong: list[Float64Array] = []
    blocked: list[Float64Array] = []
    blocked_by = np.array([float(material.blocked_by) for material in scene.materials])
    for instance in scene.instances:
        of_slots = strengths[list(instance.materials)]
        if instance.holdout or not instance.visible_diffuse or not (of_slots > 0.0).any():
            continue
        mesh = scene.meshes[instance.mesh]
        slots = np.minimum(mesh.triangle_slot, len(instance.materials) - 1)
        shining = np.flatnonzero(of_slots[slots] > 0.0)
        corners = mesh.positions[mesh.corner_vertex[mesh.triangles[shining]]].astype(np.float64)
        corners = corners @ instance.matrix[:3, :3].T + instance.matrix[:3, 3]
        edges = corners[:, 1:] - corners[:, :1]
        area = 0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
        kept = area > 0.0
        parts.append(np.concatenate([corners[:, :1], edges], axis=1)[kept])
        strong.append(of_slots[slots[shining]][kept])
        powers.append(area[kept] * strong[-1])
        blocked.append(blocked_by[list(instance.materials)][slots[shining]][kept])
    if not parts or sum(map(len, parts)) == 0:
        return None
    triangles, power, strength = np.concatenate(parts), np.concatenate(powers), np.concatenate(strong)
    blocking = np.concatenate(blocked)
    if len(power) > MOST_EMITTERS:
        chosen = np.argpartition(-power, MOST_EMITTERS)[:MOST_EMITTERS]
        triangles, power, strength, blocking = triangles[chosen], power[chosen], strength[chosen], blocking[chosen]
    total = float(power.sum())
    records = np.zeros((len(power), RECORDS, 4), np.float32)
    records[:, :, :3] = triangles
    records[:, 0, 3] = np.cumsum(power) / total
    records[-1, 0, 3] = 2.0
    records[:, 1, 3] = strength / total
    records[:, 2, 3] = blocking
    densities = (strengths / total).astype(np.float32)
    return EmitterTable(records.reshape(-1, 4), densities, blocked_by != EVERY_SET)


def strength_of(material: MaterialArrays) -> float:
    """How often a place on a material is asked: what it sends on the mean, where that is known."""
    high = material.range_of("emission")[1]
    if high <= 0.0:
        return 0.0
    mean = float(np.mean(np.maximum(material.emission, 0.0)))
    if material.varies("emission"):
        return max(mean, 0.05 * min(high, 100.0))
    return mean
