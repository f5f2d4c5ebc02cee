# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Star-shaped meshes to bake, some that are not, and their baking."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.mirrors.reflector_bake import Limits, bake_reflector
from curvrefl.curvrefl_addon.renderer.mirrors.reflector_map import ReflectorMap
from curvrefl.curvrefl_addon.scene.arrays import MeshArrays
from scenes.star_meshes import centroids, joined, moved, only, scene_of, star_mesh

ANYTHING = Limits(1.0, 1.0)
ORIGIN = (0.0, 0.0, 0.0)


def bake(mesh: MeshArrays, resolution: int = 64, **options: object) -> ReflectorMap:
    return bake_reflector(scene_of(mesh), 1, resolution, **options)  # type: ignore[arg-type]


def rotation(seed: int) -> np.ndarray:
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return turn * np.sign(np.linalg.det(turn))


def affine(linear: np.ndarray, place: tuple[float, float, float]) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = linear, place
    return matrix


CAP = 0.8
"""Cosine of a cap's angle: it covers (1 - 0.8) / 2 = 10 percent of all directions"""


def capped_ball() -> MeshArrays:
    """A ball with a cap of another one, half as large again, hovering over it."""
    ball = star_mesh(Ellipsoid(), 96)
    top = centroids(ball)[:, 2] > CAP
    return joined(ball, moved(only(ball, top), ORIGIN, 1.5))


def two_balls() -> MeshArrays:
    ball = star_mesh(Ellipsoid(), 32)
    return joined(moved(ball, (2.0, 0.0, 0.0)), moved(ball, (-2.0, 0.0, 0.0)))


def bowl() -> MeshArrays:
    ball = star_mesh(Ellipsoid(), 32)
    return only(ball, centroids(ball)[:, 2] < 0.0)
