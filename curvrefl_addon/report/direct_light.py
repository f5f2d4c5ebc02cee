# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How often direct light goes on from mirror to mirror, the same in our pictures and in Cycles'."""

from __future__ import annotations

from ..renderer.geometry.mesh_facts import MeshFacts
from ..scene.arrays import SceneArrays


def mirrors_met(scene: SceneArrays, bounces: int) -> int:
    """Mirrors one after the other on the way of a ray in direct light: `bounces` where mirrors can meet, else 1.

    With a single closed convex mirror the renderer needs no more, and with one bounce Cycles follows no reflections in
    glossy objects that are not chosen as mirrors.
    """
    mirrors = [instance for instance in scene.instances if instance.object_id in scene.reflectors]
    if len(mirrors) > 1:
        return bounces
    return 1 if all(MeshFacts(scene.meshes[one.mesh]).never_sees_itself for one in mirrors) else bounces
