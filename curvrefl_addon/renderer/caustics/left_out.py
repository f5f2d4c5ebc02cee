# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustics that are not followed, one sentence for each kind. Pure numpy."""

from __future__ import annotations

from collections.abc import Callable

from ...scene.arrays import InstanceArrays, MaterialArrays, SceneArrays
from ...scene.names import listed
from ..paths.features import SHARP_ROUGHNESS, in_use


def not_followed(scene: SceneArrays) -> tuple[str, ...]:
    """Of a scene in which they are asked for: those of sharp metal that nobody chose, and those of what shines."""
    unchosen = [item for item in scene.instances if item.object_id not in scene.reflectors]
    found = []
    if names := _made_of(scene, unchosen, _is_sharp_metal):
        found.append(f"Caustics of {listed(names)} are left out: of metal only chosen mirrors throw them.")
    if names := _made_of(scene, scene.instances, _shines):
        found.append(f"Caustics of the light of {listed(names)} are spread evenly: only lamps' are followed.")
    return tuple(found)


def _is_sharp_metal(material: MaterialArrays) -> bool:
    is_metal = material.glossy_only or material.range_of("metallic")[1] > 0.5
    return is_metal and not material.is_seen_through and material.range_of("roughness")[0] <= SHARP_ROUGHNESS


def _shines(material: MaterialArrays) -> bool:
    return material.may_be("emission")


def _made_of(
    scene: SceneArrays,
    instances: tuple[InstanceArrays, ...] | list[InstanceArrays],
    is_it: Callable[[MaterialArrays], bool],
) -> list[str]:
    """Names of the objects of which a triangle is made of such a material."""
    wanted = {index for index, material in enumerate(scene.materials) if is_it(material)}
    return [item.object_name for item in instances if in_use(scene, item, wanted & set(item.materials))]
