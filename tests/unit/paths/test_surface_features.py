# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the lit surfaces of a scene need."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.paths.surface_features import surface_features, surface_features_of
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays
from curvrefl.curvrefl_addon.scene.programs.program import Program, Shape


def scene(*materials: MaterialArrays, used: tuple[int, ...]) -> SceneArrays:
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    order = np.arange(3, dtype=np.int32)
    mesh = MeshArrays("m", corners, order, corners, None, order[None], np.zeros(1, np.int32))
    return SceneArrays((mesh,), (InstanceArrays("a", 1, 0, np.eye(4), used),), materials, (), (), WorldArrays())


@pytest.mark.parametrize(
    ("fields", "needed"),
    [
        ({}, ()),
        ({"sheen_weight": 0.1}, ("SURFACE_SHEEN",)),
        ({"coat_weight": 0.1, "diffuse_roughness": 0.2}, ("SURFACE_COAT", "SURFACE_DIFFUSE_ROUGHNESS")),
        ({"translucency": 0.1, "subsurface": 1.0}, ("SURFACE_TRANSLUCENT",)),
        ({"specular_tint": (1.0, 0.9, 1.0)}, ("SURFACE_TINT",)),
        ({"specular_tint": (1.0, 0.9, 1.0), "coat_weight": 1.0, "glossy_only": True}, ()),
    ],
)
def test_constants(fields: dict[str, Any], needed: tuple[str, ...]) -> None:
    material = MaterialArrays("m", **fields)
    assert surface_features_of(material) == frozenset(needed)
    assert surface_features(scene(material, used=(0,))) == frozenset(needed)


def test_what_no_triangle_has_needs_nothing() -> None:
    coated = MaterialArrays("coated", coat_weight=1.0)
    assert not surface_features(scene(MaterialArrays("plain"), coated, used=(0, 1)))
    assert surface_features(scene(MaterialArrays("plain"), coated, used=(1,))) == {"SURFACE_COAT"}


def test_programs_may_do_what_is_not_ruled_out() -> None:
    program = Program(
        Shape("", channels=("sheen_weight", "coat_weight", "specular_tint")), np.zeros((0, 4), np.float32)
    )
    material = MaterialArrays("m", program=program, ranges=(("coat_weight", 0.0, 0.0),))
    assert surface_features_of(material) == {"SURFACE_SHEEN", "SURFACE_TINT"}
