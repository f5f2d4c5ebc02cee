# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that goes from object to object and is not followed, one sentence for each way. Pure numpy."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ...scene.arrays import InstanceArrays, MaterialArrays, SceneArrays
from ...scene.camera.srgb import linear_to_srgb
from ...scene.names import listed

SHINY = 0.02
"""What a reflection of ordinary surroundings adds to a material as the screen shows it, 0..1, from which on pictures
are off without: an object with less that fills a quarter of a picture is off (by 8 % of the screen's range) in under
2 % of it, as measured against Cycles"""
ORDINARY_LIGHT, ORDINARY_CONTRAST = 0.35, 0.25
"""Of those surroundings: how much they light a white surface, and how much of it is missing in a reflection"""
LEAST_SHARE = 0.01
"""Of an object's triangles: of a material that counts"""


def left_out(scene: SceneArrays) -> tuple[str, ...]:
    """What the scene's objects, wherever they are, would do to each other in Cycles; one sentence each."""
    # (What is seen through is drawn by paths, which go on from it.)
    shiny = {
        index
        for index, material in enumerate(scene.materials)
        if not material.is_seen_through and _shine(material) > SHINY
    }
    found = []
    if shiny and len(scene.instances) > 1 and not is_lit_indirectly(scene):
        others = [item for item in scene.instances if item.object_id not in scene.reflectors]
        names = list(_made_of(scene, others, shiny))
        if names:
            verb = "shows" if len(set(names)) == 1 else "show"
            found.append(f"Only mirrors reflect objects: {listed(names)} {verb} the world and lamps alone.")
    return tuple(found)


def oddly_seen(scene: SceneArrays) -> tuple[str, ...]:
    """Where the world lights: objects that diffuse rays see and shadow rays do not, or the other way; one sentence."""
    # Cycles draws rays for the light of an even world by the surface, and of an image by its brightness as well.
    odd = [item.object_name for item in scene.instances if item.visible_diffuse != item.visible_shadow]
    if not odd:
        return ()
    what = "as that of lamps: visibility to diffuse rays is left out."
    return (f"The world's light is shadowed by {listed(odd)} {what}",)


def seen_in_spite_of_links(scene: SceneArrays) -> tuple[str, ...]:
    """What an environment, which does not know the mirror that looks it up, shows of light linking: one sentence."""
    sets = {scene.light_set_of(item) for item in scene.instances if item.object_id in scene.reflectors}

    def is_unlinked(bits: int) -> bool:
        return not all(bits >> number & 1 for number in sets)

    found = [
        light.name
        for light in scene.lights
        if is_unlinked(light.lights_on) and light.visible_glossy and (light.kind == "AREA" or light.radius > 0.0)
    ]
    found += [
        item.object_name
        for item in scene.instances
        if item.visible_glossy and any(is_unlinked(scene.materials[index].shines_on) for index in item.materials)
    ]
    if not found:
        return ()
    verb = "shines" if len(set(found)) == 1 else "shine"
    return (f"In mirrors {listed(found)} {verb} whatever the light linking: choose Automatic or Exact to follow it.",)


def is_lit_indirectly(scene: SceneArrays) -> bool:
    """Whether the file's own renders follow light on from surfaces that scatter it."""
    used = {index for instance in scene.instances for index in instance.materials}
    return scene.diffuse_bounces > 0 and any(
        scene.materials[index].range_of("metallic")[0] < 1.0 and not scene.materials[index].glossy_only
        for index in used
    )


def _shine(material: MaterialArrays) -> float:
    """See `SHINY`. What varies counts as the shiniest that it may be."""
    high = {name: material.range_of(name)[1] for name in ("base_color", "metallic", "ior", "specular_level")}
    color = min(high["base_color"], max(1.0, *material.base_color))
    root = 1.0 if np.isinf(high["ior"]) else (high["ior"] - 1.0) / (high["ior"] + 1.0)
    roughness, emission = material.range_of("roughness")[0], material.range_of("emission")[0]
    if not material.varies("emission"):
        emission = max(material.emission)
    # (What very rough dielectrics reflect of all around them hardly differs from place to place.)
    dielectric = min(2.0 * high["specular_level"] * root * root, 0.99) * (1.0 - roughness**3)
    metal = 1.0 if material.glossy_only else high["metallic"]
    below = ORDINARY_LIGHT * (1.0 - metal) * color + max(emission, 0.0)
    return _shown(below + ORDINARY_CONTRAST * (metal * color + (1.0 - metal) * dielectric)) - _shown(below)


def _shown(radiance: float) -> float:
    """By sRGB's curve."""
    return float(linear_to_srgb(min(max(radiance, 0.0), 1.0)))


def _made_of(scene: SceneArrays, instances: Iterable[InstanceArrays], wanted: set[int]) -> Iterator[str]:
    """Names of those that can be seen and have enough of these materials."""
    for instance in instances:
        matters = instance.visible_camera or instance.visible_glossy
        if instance.holdout or not matters:
            continue
        slots = [slot for slot, material in enumerate(instance.materials) if material in wanted]
        if not slots:
            continue
        if len(slots) < len(instance.materials):
            used = np.bincount(
                np.minimum(scene.meshes[instance.mesh].triangle_slot, len(instance.materials) - 1),
                minlength=len(instance.materials),
            )
            if used[slots].sum() < LEAST_SHARE * used.sum():
                continue
        yield instance.object_name
