# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Direct light, the same in our pictures and in Cycles': without bounces, and how often it goes on from mirror to
mirror."""

from __future__ import annotations

from dataclasses import replace

from ..renderer.geometry.mesh_facts import MeshFacts
from ..scene.arrays import UNLIMITED_BOUNCES, SceneArrays


def in_direct_light(scene: SceneArrays) -> SceneArrays:
    """Mirrors follow each other as often as asked on both sides, whatever the file says; light goes through as much
    glass as that allows."""
    return replace(
        scene,
        mirror_bounces=UNLIMITED_BOUNCES,
        most_bounces=UNLIMITED_BOUNCES,
        diffuse_bounces=0,
        indirect_clamp=0.0,
    )


def mirrors_met(scene: SceneArrays, bounces: int) -> int:
    """Mirrors one after the other on the way of a ray in direct light: `bounces` where mirrors can meet, else 1.

    With a single closed convex mirror the renderer needs no more, and with one bounce Cycles follows no reflections in
    glossy objects that are not chosen as mirrors.
    """
    mirrors = [instance for instance in scene.instances if instance.object_id in scene.reflectors]
    if len(mirrors) > 1:
        return bounces
    return 1 if all(MeshFacts(scene.meshes[one.mesh]).never_sees_itself for one in mirrors) else bounces
