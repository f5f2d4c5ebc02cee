# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What of paths a scene needs: nothing where mirrors are sharp and all else is opaque. Pure numpy."""

from __future__ import annotations

import numpy as np

from ...scene.arrays import InstanceArrays, MaterialArrays, SceneArrays

ROUGH, COAT, GLASS, ALPHA = "PATHS_ROUGH", "PATHS_COAT", "PATHS_GLASS", "PATHS_ALPHA"
SCALARS, ANISOTROPY, FILM, ABSORPTION = "PATHS_SCALARS", "PATHS_ANISOTROPY", "PATHS_FILM", "PATHS_ABSORPTION"
TINT = "PATHS_TINT"
"""Defines of the shaders of paths"""
SHARPEST_LOBE = 7e-4
"""Lobes with a smaller square of the roughness are drawn sharp"""


def path_features(scene: SceneArrays) -> frozenset[str]:
    """Defines that the scene's paths need; none where no path goes on but off sharp mirrors.

    Chosen mirrors count and what is seen through, as far as rays see them.
    """
    of = [features_of(material) for material in scene.materials]
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
            if goes_on(scene.materials[index], is_mirror) and not of[index] <= found
        }
        for index in in_use(scene, instance, wanted):
            found |= of[index]
    return frozenset(found)


def same_for_paths(before: SceneArrays, scene: SceneArrays) -> bool:
    """Whether nothing has changed that paths' features or limits are made of."""
    objects = ("materials", "instances", "images", "meshes")
    values = ("reflectors", "most_bounces", "mirror_bounces", "transmission_bounces", "transparent_bounces")
    return all(getattr(scene, name) is getattr(before, name) for name in objects) and all(
        getattr(scene, name) == getattr(before, name) for name in values
    )


def goes_on(material: MaterialArrays, is_mirror: bool) -> bool:
    """Whether a path that meets the material may go on from there. `is_mirror`: of a chosen mirror."""
    return is_mirror or material.is_seen_through


def lets_straight_on(material: MaterialArrays) -> bool:
    """Whether light goes through as if nothing was there, at some places or in part: not so through glass."""
    return material.alpha < 1.0


def features_of(material: MaterialArrays) -> frozenset[str]:
    """Defines that a path needs which goes on from the material."""
    # (A color over a surface that reflects nothing has no lobe, whatever its roughness.)
    is_dielectric = material.specular_level > 0.0 and material.ior != 1.0
    reflects = material.metallic > 0.0 or material.glossy_only or is_dielectric
    has_scalars = material.scalars is not None
    is_rough = (reflects or material.transmission > 0.0) and material.roughness**2 >= SHARPEST_LOBE
    is_coat_rough = material.coat_weight > 0.0 and material.coat_roughness**2 >= SHARPEST_LOBE
    found = {
        ROUGH: is_rough or is_coat_rough or has_scalars,
        COAT: material.coat_weight > 0.0,
        GLASS: material.transmission > 0.0,
        ALPHA: lets_straight_on(material),
        SCALARS: has_scalars,
        ANISOTROPY: material.anisotropy != 0.0 and (is_rough or has_scalars),
        FILM: material.film_thickness > 0.0,
        # (Nothing but paths knows it; they always do.)
        TINT: material.specular_tint != (1.0, 1.0, 1.0) and reflects and not material.glossy_only,
        ABSORPTION: material.transmission > 0.0 and max(material.absorption) > 0.0,
    }
    return frozenset(name for name, is_needed in found.items() if is_needed)


def in_use(scene: SceneArrays, instance: InstanceArrays, wanted: set[int]) -> set[int]:
    """Those of the `wanted` materials that triangles of the instance have."""
    if not wanted or len(instance.materials) == 1:
        return wanted
    # (As the shaders do: a slot that is not there is the last.)
    slots = np.minimum(scene.meshes[instance.mesh].triangle_slot, len(instance.materials) - 1)
    used = np.flatnonzero(np.bincount(slots, minlength=1)).tolist()
    return wanted & {instance.materials[slot] for slot in used}
