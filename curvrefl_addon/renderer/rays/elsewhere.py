# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a scene is another one with things elsewhere, so that what rays walk through stays but for places."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ...scene.arrays import InstanceArrays, MeshArrays, SceneArrays
from ..geometry.placed_instances import others
from ..geometry.vertex_uploads import is_deformed


@dataclass(frozen=True, slots=True)
class Elsewhere:
    """What is not where it was."""

    instances: list[int]
    """Indices of instances whose matrices or meshes are others, and of those that show a mesh which deformed"""
    meshes: list[tuple[MeshArrays, MeshArrays]]
    """Meshes that deformed, as they were and as they are"""


def things_elsewhere(
    before: SceneArrays, numbers_before: Mapping[int, int], scene: SceneArrays, numbers: Mapping[int, int]
) -> Elsewhere | None:
    """None where more than places has changed. `numbers`: see `RayScene.follow`."""
    if len(scene.instances) != len(before.instances) or len(scene.meshes) != len(before.meshes):
        return None
    if numbers != numbers_before:
        return None
    pairs = enumerate(zip(before.meshes, scene.meshes, strict=True))
    changed = {index: (old, new) for index, (old, new) in pairs if old is not new}
    if any(not is_deformed(old, new) for old, new in changed.values()):
        return None
    found = others(before.instances, scene.instances)
    if any(_all_but_place(before.instances[index]) != _all_but_place(scene.instances[index]) for index in found):
        return None
    if changed:
        found = sorted({*found, *(index for index, item in enumerate(scene.instances) if item.mesh in changed)})
    return Elsewhere(found, list(changed.values()))


def _all_but_place(instance: InstanceArrays) -> tuple[object, ...]:
    """What the records of an instance are made of beside its matrix."""
    return (
        instance.object_id,
        instance.mesh,
        instance.materials,
        instance.visible_camera,
        instance.visible_glossy,
        instance.visible_shadow,
        instance.visible_transmission,
        instance.holdout,
        instance.shadow_set,
    )
