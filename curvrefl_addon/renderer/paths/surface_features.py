# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What surfaces have where they are lit, beside one lobe over an even base; nothing in scenes of plain materials. Pure
numpy."""

from __future__ import annotations

from ...scene.arrays import MaterialArrays, SceneArrays
from .features import in_use

SHEEN, COAT, DIFFUSE_ROUGHNESS = "SURFACE_SHEEN", "SURFACE_COAT", "SURFACE_DIFFUSE_ROUGHNESS"
TRANSLUCENT, TINT = "SURFACE_TRANSLUCENT", "SURFACE_TINT"
"""Defines of `lighting.glsl`"""
SURFACE_FEATURES = frozenset({SHEEN, COAT, DIFFUSE_ROUGHNESS, TRANSLUCENT, TINT})


def surface_features(scene: SceneArrays) -> frozenset[str]:
    """Defines that the scene's surfaces need, those of its mirrors too."""
    of = [surface_features_of(material) for material in scene.materials]
    found: set[str] = set()
    asked: set[tuple[int, tuple[int, ...]]] = set()
    for instance in scene.instances:
        key = (instance.mesh, instance.materials)
        if key not in asked:
            asked.add(key)
            for index in in_use(scene, instance, {index for index in instance.materials if not of[index] <= found}):
                found |= of[index]
    return frozenset(found)


def surface_features_of(material: MaterialArrays) -> frozenset[str]:
    """The same of one material."""

    def may_be_above(channel: str, least: float) -> bool:
        return material.range_of(channel)[1] > least

    channels = material.program.shape.channels if material.program is not None else ()
    has_tint = material.specular_tint != (1.0, 1.0, 1.0) or "specular_tint" in channels
    needed = {TINT: has_tint and not material.glossy_only}
    if not material.glossy_only:
        needed[SHEEN] = may_be_above("sheen_weight", 0.0)
        needed[COAT] = may_be_above("coat_weight", 0.0)
        needed[DIFFUSE_ROUGHNESS] = may_be_above("diffuse_roughness", 0.0)
        needed[TRANSLUCENT] = may_be_above("translucency", 0.0)
    return frozenset(name for name, is_needed in needed.items() if is_needed)
