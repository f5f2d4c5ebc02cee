# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes to light: bodies, lamps and a camera, and the arrays that `Lighting` reads of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.scene.arrays import (
    ImageSource,
    InstanceArrays,
    LightArrays,
    MaterialArrays,
    MeshArrays,
    SceneArrays,
    WorldArrays,
)
from mathutils import Matrix, Vector
from scenes.paths.programs import Looked, cut_out, with_attributes


@dataclass(frozen=True)
class Cut:
    """Alpha of an image, or whether it is above a threshold."""

    looked: Looked = field(default_factory=Looked)
    threshold: float | None = None


@dataclass
class Body:
    """A mesh with one material."""

    positions: np.ndarray
    triangles: np.ndarray
    material: MaterialArrays = field(
        default_factory=lambda: MaterialArrays("gray", (0.5, 0.5, 0.5), specular_level=0.0)
    )
    smooth_center: tuple[float, float, float] | None = None
    """Shading normals point away from here; None: flat"""
    visible_shadow: bool = True
    uv: np.ndarray | None = None
    """(vertices, 2)"""
    cut: Cut | None = None
    """In place of the material's alpha"""


@dataclass
class Stage:
    """What both renderers are given."""

    bodies: list[Body]
    lights: list[LightArrays] = field(default_factory=list)
    world: WorldArrays = field(default_factory=WorldArrays)
    eye: tuple[float, float, float] = (0.0, 0.0, 6.0)
    target: tuple[float, float, float] = (0.0, 0.0, 0.0)
    width: float = 2.0
    """Orthographic width of the picture, meters"""
    pixels: int = 48
    images: tuple[ImageSource, ...] = ()


def plane(size: float = 4.0, z: float = 0.0, **more: Any) -> Body:
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32) * (size / 2)
    corners[:, 2] = z
    return Body(corners, np.array([[0, 1, 2], [0, 2, 3]], np.int32), **more)


def box(low: tuple[float, float, float], high: tuple[float, float, float], **more: Any) -> Body:
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], np.float32)
    corners = np.asarray(low, np.float32) + corners * (np.asarray(high, np.float32) - np.asarray(low, np.float32))
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return Body(corners, np.array(triangles, np.int32), **more)


def ball(center: tuple[float, float, float], radius: float, rings: int = 48, smooth: bool = True, **more: Any) -> Body:
    theta = np.linspace(0, np.pi, rings + 1)
    phi = np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    points = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1).reshape(-1, 3)
    index = np.arange(points.shape[0]).reshape(rings + 1, 2 * rings)
    a, b = index[:-1], np.roll(index[:-1], -1, axis=1)
    c, d = np.roll(index[1:], -1, axis=1), index[1:]
    upper = np.stack([a, d, c], axis=-1).reshape(-1, 3)
    lower = np.stack([a, c, b], axis=-1).reshape(-1, 3)
    triangles = np.concatenate([upper[2 * rings :], lower[: -2 * rings]])
    positions = (np.asarray(center) + radius * points).astype(np.float32)
    return Body(positions, triangles.astype(np.int32), smooth_center=center if smooth else None, **more)


def scene_arrays(stage: Stage) -> SceneArrays:
    meshes, instances, materials = [], [], []
    for index, body in enumerate(stage.bodies):
        positions = body.positions[body.triangles].reshape(-1, 3)
        if body.smooth_center is None:
            a, b, c = (body.positions[body.triangles[:, k]] for k in range(3))
            normals = np.repeat(np.cross(b - a, c - a), 3, axis=0)
        else:
            normals = positions - np.asarray(body.smooth_center, np.float32)
        normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
        count = len(positions)
        mesh = MeshArrays(
            f"mesh{index}",
            positions,
            np.arange(count, dtype=np.int32),
            normals.astype(np.float32),
            None,
            np.arange(count, dtype=np.int32).reshape(-1, 3),
            np.zeros(count // 3, np.int32),
        )
        if body.uv is not None:
            mesh = with_attributes(mesh, uv=body.uv[body.triangles].reshape(-1, 2))
        meshes.append(mesh)
        cut = body.cut
        materials.append(body.material if cut is None else cut_out(body.material, cut.looked, cut.threshold))
        instances.append(
            InstanceArrays(f"body{index}", index + 1, index, np.eye(4), (index,), visible_shadow=body.visible_shadow)
        )
    return SceneArrays(
        tuple(meshes), tuple(instances), tuple(materials), stage.images, tuple(stage.lights), stage.world
    )


def lamp(
    kind: str,
    color: tuple[float, float, float],
    place: tuple[float, float, float] = (0.0, 0.0, 3.0),
    towards: tuple[float, float, float] = (0.0, 0.0, 0.0),
    **more: Any,
) -> LightArrays:
    back = (Vector(place) - Vector(towards)).normalized()
    rotation = back.to_track_quat("Z", "Y").to_matrix().to_4x4()
    matrix = np.array(Matrix.Translation(place) @ rotation, np.float64)
    return LightArrays(kind.lower(), kind, color, matrix, **more)


def camera_matrix(stage: Stage) -> np.ndarray:
    back = (Vector(stage.eye) - Vector(stage.target)).normalized()
    rotation = back.to_track_quat("Z", "Y").to_matrix().to_4x4()
    return np.array(Matrix.Translation(stage.eye) @ rotation, np.float64)
