# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What of paths a scene needs: nothing where mirrors are sharp and all else is opaque. Pure numpy."""

from __future__ import annotations

import numpy as np

from ...optics.scattering.microfacet import SHARP_ALPHA
from ...scene.arrays import InstanceArrays, MaterialArrays, SceneArrays

ROUGH, COAT, GLASS, ALPHA = "PATHS_ROUGH", "PATHS_COAT", "PATHS_GLASS", "PATHS_ALPHA"
ANISOTROPY, FILM, ABSORPTION, TINT = "PATHS_ANISOTROPY", "PATHS_FILM", "PATHS_ABSORPTION", "PATHS_TINT"
SHEEN, VARIES = "PATHS_SHEEN", "PATHS_VARIES"
"""Defines of the shaders of paths"""
SHARP_ROUGHNESS = 0.3
"""What lobes of at most this roughness send on of lamps are caustics, not light between surfaces"""


def path_features(scene: SceneArrays) -> frozenset[str]:
    """Defines that the scene's paths need; none where no path goes on but off sharp mirrors.

    Chosen mirrors count and what is seen through, as far as rays see them.
    """
    of = {is_mirror: [features_of(item, is_mirror) for item in scene.materials] for is_mirror in (False, True)}
    found: set[str] = set()
    asked: set[tuple[bool, int, tuple[int, ...]]] = set()
    for instance in scene.instances:
        is_mirror = instance.object_id in scene.reflectors
        key = (is_mirror, instance.mesh, instance.materials)
        is_seen = instance.visible_camera or instance.visible_glossy or instance.visible_transmission
        if key in asked or not is_seen:
            continue
        asked.add(key)
        wanted = {
            index
            for index in instance.materials
            if goes_on(scene.materials[index], is_mirror) and not of[is_mirror][index] <= found
        }
        for index in in_use(scene, instance, wanted):
            found |= of[is_mirror][index]
    return frozenset(found)


def same_for_paths(before: SceneArrays, scene: SceneArrays) -> bool:
    """Whether nothing beside the instances has changed that paths' features or limits are made of."""
    objects = ("materials", "images")
    values = ("reflectors", "most_bounces", "mirror_bounces", "transmission_bounces", "transparent_bounces")
    return all(getattr(scene, name) is getattr(before, name) for name in objects) and all(
        getattr(scene, name) == getattr(before, name) for name in values
    )


def goes_on(material: MaterialArrays, is_mirror: bool) -> bool:
    """Whether a path that meets the material may go on from there. `is_mirror`: of a chosen mirror."""
    return is_mirror or material.is_seen_through


def lets_straight_on(material: MaterialArrays) -> bool:
    """Whether light goes through as if nothing was there, at some places or in part: not so through glass."""
    return material.range_of("alpha")[0] < 1.0


def has_base(material: MaterialArrays) -> bool:
    """Whether a surface shows something besides what its lobes do, at least at some places."""
    if _varies(material):
        return True
    shines = max(material.emission) > 0.0 or material.sheen_weight > 0.0
    is_lobe_alone = material.glossy_only or material.metallic >= 1.0 or material.transmission >= 1.0
    return shines or not is_lobe_alone


def _varies(material: MaterialArrays) -> bool:
    """Whether more than its base color and its normal differs from place to place."""
    return material.program is not None and not {"base_color", "normal"}.issuperset(material.program.shape.channels)


def features_of(material: MaterialArrays, is_mirror: bool) -> frozenset[str]:
    """Defines that a path needs which goes on from the material. `is_mirror`: of a chosen mirror."""
    # (Lobes of what only lets light straight on are not followed.)
    is_followed = is_mirror or material.may_be("transmission")
    # (A color over a surface that reflects nothing has no lobe, whatever its roughness.)
    is_dielectric = material.may_be("specular_level") and material.range_of("ior") != (1.0, 1.0)
    reflects = material.may_be("metallic") or material.glossy_only or material.varies("kind") or is_dielectric
    is_rough = (reflects or material.may_be("transmission")) and material.range_of("roughness")[1] ** 2 >= SHARP_ALPHA
    has_coat = material.may_be("coat_weight")
    is_coat_rough = has_coat and material.range_of("coat_roughness")[1] ** 2 >= SHARP_ALPHA
    of_lobes = {
        ROUGH: is_rough or is_coat_rough,
        COAT: has_coat,
        GLASS: material.may_be("transmission"),
        ANISOTROPY: material.range_of("anisotropy") != (0.0, 0.0) and is_rough,
        FILM: material.may_be("film_thickness"),
        # (Nothing but paths knows it; they always do.)
        TINT: material.range_of("specular_tint") != (1.0, 1.0) and reflects and not material.glossy_only,
        SHEEN: material.may_be("sheen_weight") and not material.glossy_only,
        ABSORPTION: material.may_be("transmission") and max(material.absorption) > 0.0,
        VARIES: _varies(material),
    }
    found = {ALPHA: lets_straight_on(material)}
    needed = found | of_lobes if is_followed else found
    return frozenset(name for name, is_needed in needed.items() if is_needed)


def in_use(scene: SceneArrays, instance: InstanceArrays, wanted: set[int]) -> set[int]:
    """Those of the `wanted` materials that triangles of the instance have."""
    if not wanted or len(instance.materials) == 1:
        return wanted
    # (As the shaders do: a slot that is not there is the last.)
    slots = np.minimum(scene.meshes[instance.mesh].triangle_slot, len(instance.materials) - 1)
    used = np.flatnonzero(np.bincount(slots, minlength=1)).tolist()
    return wanted & {instance.materials[slot] for slot in used}
