# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror and another object as arrays, for what follows from their materials alone."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.scene.arrays import (
    InstanceArrays,
    MaterialArrays,
    MeshArrays,
    SceneArrays,
    WorldArrays,
)
from curvrefl.curvrefl_addon.scene.programs.program import Program, Shape

CHROME = MaterialArrays("chrome", metallic=1.0, roughness=0.0)
ROUGH_METAL = MaterialArrays("rough", metallic=1.0, roughness=0.3)
LEAF = MaterialArrays("leaf", alpha=0.5, specular_level=0.0)


def varying(material: MaterialArrays, **ranges: tuple[float, float]) -> MaterialArrays:
    """With channels that a program sets, from a lowest to a highest value."""
    text = "void material_program(ShadingPoint s, inout Material m)\n{\n}\n"
    program = Program(Shape(text, channels=tuple(ranges)), np.zeros((0, 4), np.float32))
    return replace(material, program=program, ranges=tuple((name, *ends) for name, ends in ranges.items()))


def scene_of(
    mirror: MaterialArrays, scenery: MaterialArrays, slots: tuple[int, ...] = (0,), **more: Any
) -> SceneArrays:
    """A mirror of the first material, another object of the first and second."""
    corners = np.zeros((3, 3), np.float32)
    triangles = np.tile(np.arange(3, dtype=np.int32), (len(slots), 1))
    mesh = MeshArrays(
        "mesh", corners, np.arange(3, dtype=np.int32), corners, None, triangles, np.array(slots, np.int32)
    )
    single = replace(mesh, triangle_slot=np.zeros(len(slots), np.int32))
    instances = (
        InstanceArrays("mirror", 1, 0, np.eye(4), (0,)),
        InstanceArrays("scenery", 2, 1, np.eye(4), (1, 2), **more),
    )
    plain = MaterialArrays("plain", metallic=1.0)
    return SceneArrays((single, mesh), instances, (mirror, scenery, plain), (), (), WorldArrays(), (1,))
