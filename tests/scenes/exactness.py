# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of `exact` judged pixel by pixel: each mirror pixel's own reflected ray against all triangles in float64."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.geometry.convexity import is_convex
from curvrefl.curvrefl_addon.renderer.geometry.mesh_inside import is_closed
from curvrefl.curvrefl_addon.renderer.rays.ray_instances import OWN_RANGE
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.ray_cast import first_hits, world_triangles

TIE = 1e-4
"""Two surfaces at distances closer than this share are one to float32"""
ROUNDING = 1e-6
"""Of positions, as a share of the mirror's size"""


@dataclass
class Verdict:
    """Of mirror pixels."""

    pixels: int
    ties: int
    wrong: int


def judge(scene: SceneArrays, view: View, frame: Frame) -> Verdict:
    """Each mirror pixel's own reflected ray, from the surface buffer that the method had, against all triangles."""
    triangles = world_triangles(scene)
    mask = frame.mask()
    seen = frame.surfaces["seen_position"].astype(np.float64)
    normal = frame.surfaces["seen_normal"].astype(np.float64)[..., :3]
    shown, ids = frame.reflected_position(), frame.reflected_object()
    object_ids = np.array([instance.object_id for instance in scene.instances])
    total = Verdict(0, 0, 0)
    for own, instance in enumerate(scene.instances):
        if instance.object_id not in scene.reflectors:
            continue
        here = mask == instance.object_id
        if not here.any():
            continue
        point = seen[here][:, :3]
        incoming = unit(point * view.eye[3] - view.eye[:3])
        facing = normal[here]
        ray = incoming - 2.0 * (incoming * facing).sum(1, keepdims=True) * facing
        mesh = scene.meshes[instance.mesh]
        size = float(np.linalg.norm(instance.matrix[:3, :3] @ np.ptp(mesh.positions, axis=0)))
        rules = own_rules(scene, own)
        kept = triangles
        if rules == "never":
            chosen = triangles.instance != own
            kept = replace(triangles, corners=triangles.corners[chosen], instance=triangles.instance[chosen])
        hits = first_hits(kept, point, ray, own, OWN_RANGE * size, 1.0 if rules == "facing" else 0.0)
        expected = np.where(hits.triangle >= 0, object_ids[kept.instance[hits.triangle]], 0)
        got = ids[here]
        distance = np.linalg.norm(shown[here][:, :3] - point, axis=1)
        same_place = (expected == 0) | (np.abs(distance - hits.distance) <= TIE * hits.distance + ROUNDING * size)
        wrong = (got != expected) | ~same_place
        tie = hits.is_at_edge | (hits.second <= hits.distance * (1.0 + TIE))
        total.pixels += int(here.sum())
        total.ties += int((wrong & tie).sum())
        total.wrong += int((wrong & ~tie).sum())
    return total


def own_rules(scene: SceneArrays, index: int) -> str:
    """How a mirror sees itself: see `ray_scene`."""
    mesh = scene.meshes[scene.instances[index].mesh]
    if is_closed(mesh):
        return "never" if is_convex(mesh) else "facing"
    return "both"
