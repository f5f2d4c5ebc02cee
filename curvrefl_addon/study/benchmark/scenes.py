# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Halls (`renderer/measured/hall.py`) with more in them, and changes of them from frame to frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...renderer.measured.hall import GRAY, hall, placed
from ...scene.arrays import InstanceArrays, SceneArrays


def crowd(instances: int, seed: int = 0) -> SceneArrays:
    """The mirror amid so many instances of one small mesh."""
    rng = np.random.default_rng(seed)
    scene = hall(96, things=1, seed=seed)
    more = tuple(InstanceArrays(f"thing {index}", 4 + index, 2, placed(rng), (GRAY,)) for index in range(instances))
    return replace(scene, instances=(*scene.instances[:2], *more))


def moved(scene: SceneArrays, index: int, offset: Sequence[float]) -> SceneArrays:
    """The scene with one instance elsewhere; all else is the same objects."""
    instance = scene.instances[index]
    matrix = instance.matrix.copy()
    matrix[:3, 3] += offset
    instances = (*scene.instances[:index], replace(instance, matrix=matrix), *scene.instances[index + 1 :])
    return replace(scene, instances=instances)


def deformed(scene: SceneArrays, index: int, phase: float) -> SceneArrays:
    """The scene with one mesh in waves; the other meshes and its topology are the same objects."""
    mesh = scene.meshes[index]
    wave = np.sin(2.0 * mesh.positions[:, [1, 2, 0]] + np.float32(phase))
    positions = (mesh.positions + np.float32(0.05) * wave).astype(np.float32)
    meshes = (*scene.meshes[:index], replace(mesh, positions=positions), *scene.meshes[index + 1 :])
    return replace(scene, meshes=meshes)
