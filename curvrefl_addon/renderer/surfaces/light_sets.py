# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where shaders find the sets of light linking (`surfaces/light_sets.glsl`)."""

from __future__ import annotations

from ...scene.arrays import EVERY_SET, MaterialArrays, SceneArrays

LINKED, SHADOWS_LINKED = "LIGHTING_LINKED", "LIGHTING_SHADOWS_LINKED"
"""Defines of scenes in which lamps, or what shines, light some objects alone, and of those in which some objects cast
no shadows in the light of some lamps"""
LIGHT_SET_SHIFT = 4
"""A material's light set is above the KIND_ bits"""
SHINES_ON_SHIFT = 3
"""And the sets that it shines on are above the VARIES_ bits"""
SHADOW_SET_SHIFT = 10
"""An instance's shadow set is above its flags for rays"""
SET_STEPS = 64.0
"""Of a whole: the set of what a ray has left is a fraction of the number of the object that it met"""


def set_of_kind(material: MaterialArrays) -> int:
    """What is added to a material's KIND_ bits."""
    return material.light_set << LIGHT_SET_SHIFT


def sets_of_varies(material: MaterialArrays, links: frozenset[str]) -> int:
    """And to its VARIES_ bits: nothing where no shader asks."""
    return material.shines_on << SHINES_ON_SHIFT if LINKED in links else 0


def links_of(scene: SceneArrays) -> frozenset[str]:
    """Defines that a scene needs; none without light linking."""
    is_linked = any(light.lights_on != EVERY_SET for light in scene.lights) or any(
        item.light_set or item.shines_on != EVERY_SET for item in scene.materials
    )
    masks = {item.blocked_by for item in scene.lights} | {item.blocked_by for item in scene.materials}
    has_shadows = bool(masks - {EVERY_SET})
    return frozenset(name for name, is_so in ((LINKED, is_linked), (SHADOWS_LINKED, has_shadows)) if is_so)
