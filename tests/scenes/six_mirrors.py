# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Six mirrors of different shapes in one room, as scene arrays."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.scene.arrays import (
    InstanceArrays,
    MaterialArrays,
    MeshArrays,
    SceneArrays,
    WorldArrays,
)
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.convex_mirrors import rounded_box
from scenes.mirror_halls import bowl, slab, vase
from scenes.star_meshes import mesh_of, star_mesh, torus
from scenes.views import look_at

MIRROR_NAMES = ("sphere", "slab", "torus", "bowl", "flat", "vase")


def flat() -> MeshArrays:
    """One square, upright, that faces -y."""
    corners = np.array([(-1.0, 0.0, -1.0), (1.0, 0.0, -1.0), (1.0, 0.0, 1.0), (-1.0, 0.0, 1.0)])
    return mesh_of(corners, np.tile((0.0, -1.0, 0.0), (4, 1)), np.array([[0, 1, 2], [0, 2, 3]]))


def six_mirrors() -> SceneArrays:
    """Mirrors are the objects 1 to 6, in two rows above a floor with colored cubes."""
    mirrors = (
        star_mesh(Ellipsoid(), 48),
        rounded_box(np.array([0.9, 0.4, 0.9]), 0.1, 5),
        torus(0.7, 0.3),
        bowl(),
        flat(),
        vase(),
    )
    meshes = (*mirrors, slab())
    instances = []
    for index in range(len(mirrors)):
        matrix = np.eye(4)
        matrix[:3, 3] = (2.6 * (index % 3) - 2.6, 0.0 if index < 3 else 2.0, 0.0 if index < 3 else 2.3)
        instances.append(InstanceArrays(f"mirror {MIRROR_NAMES[index]}", index + 1, index, matrix, (1,)))
    floor = np.diag([8.0, 8.0, 0.05, 1.0])
    floor[2, 3] = -1.4
    instances.append(InstanceArrays("floor", 7, 6, floor, (0,)))
    rng = np.random.default_rng(4)
    for index in range(16):
        size = rng.uniform(0.1, 0.35)
        matrix = np.diag([size, size, size, 1.0])
        matrix[:3, 3] = (rng.uniform(-4.5, 4.5), rng.uniform(-5.0, -1.6), -1.35 + size)
        instances.append(InstanceArrays(f"cube {index}", 8 + index, 6, matrix, (2 + index % 3,)))
    materials = (
        MaterialArrays("gray"),
        MaterialArrays("chrome", base_color=(1, 1, 1), metallic=1.0, roughness=0.0),
        MaterialArrays("red", base_color=(0.8, 0.1, 0.1)),
        MaterialArrays("green", base_color=(0.1, 0.7, 0.2)),
        MaterialArrays("blue", base_color=(0.1, 0.2, 0.8)),
    )
    return SceneArrays(
        meshes, tuple(instances), materials, (), (), WorldArrays((0.7, 0.75, 0.9)), reflectors=(1, 2, 3, 4, 5, 6)
    )


def six_mirrors_view(width: int, height: int) -> View:
    """All six and the floor before them."""
    return look_at(np.array([0.0, -9.0, 2.6]), np.array([0.0, 0.5, 0.9]), width, height, 0.9)
