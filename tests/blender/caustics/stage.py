# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirrors and glass of numbers under lamps, and white screens that what they throw lands on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from curvrefl.curvrefl_addon.optics.caustics import RoundMirror
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import (
    InstanceArrays,
    LightArrays,
    MaterialArrays,
    MeshArrays,
    SceneArrays,
    WorldArrays,
)
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.scene.meshes.made import quad_mesh, smooth_mesh

WHITE = MaterialArrays("white", (1.0, 1.0, 1.0), roughness=1.0, specular_level=0.0)
CHROME = MaterialArrays("chrome", (1.0, 1.0, 1.0), metallic=1.0, roughness=0.0)
GLASS = MaterialArrays("glass", (1.0, 1.0, 1.0), roughness=0.0, transmission=1.0)
WHITE_THING, CHROME_THING, GLASS_THING = range(3)
"""What things are of"""
SUN = LightArrays("sun", "SUN", (1.0, 1.0, 1.0), np.eye(4))


@dataclass
class Stage:
    """Collects things; those of chrome are mirrors."""

    lights: tuple[LightArrays, ...] = (SUN,)
    _meshes: list[MeshArrays] = field(default_factory=list)
    _instances: list[InstanceArrays] = field(default_factory=list)

    def add(self, mesh: MeshArrays, material: int, place: Sequence[float] = (0.0, 0.0, 0.0), **flags: bool) -> None:
        """A thing of one of the materials."""
        matrix = np.eye(4)
        matrix[:3, 3] = place
        number = len(self._meshes)
        self._meshes.append(mesh)
        self._instances.append(InstanceArrays(f"thing {number}", number + 1, number, matrix, (material,), **flags))

    def add_screen(self, height: float, half: float, **flags: bool) -> None:
        """A white square about the z axis that stands in no light's way."""
        corners = half * np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
        mesh = quad_mesh("screen", corners + np.array([0.0, 0.0, height]), (0.0, 0.0, 1.0))
        self.add(mesh, WHITE_THING, visible_shadow=False, **flags)

    def arrays(self) -> SceneArrays:
        mirrors = tuple(item.object_id for item in self._instances if item.materials == (CHROME_THING,))
        materials = (WHITE, CHROME, GLASS)
        return SceneArrays(
            tuple(self._meshes), tuple(self._instances), materials, (), self.lights, WorldArrays(), mirrors
        )


def round_mesh(mirror: RoundMirror, rings: int, segments: int) -> MeshArrays:
    """With exact normals, on the side from which the beam comes."""
    rho = np.linspace(0.0, mirror.rim, rings + 1)[1:]
    turn = np.linspace(0.0, 2.0 * np.pi, segments, endpoint=False)
    height, slope, _ = mirror._profile(np.concatenate([[1e-9], rho]))
    around = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    middle, places = np.array([[0.0, 0.0, height[0]]]), np.empty((rings, segments, 3))
    places[..., :2], places[..., 2] = rho[:, None, None] * around, height[1:, None]
    normals = np.empty_like(places)
    normals[..., :2], normals[..., 2] = -slope[1:, None, None] * around, 1.0
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    index = 1 + np.arange(rings * segments).reshape(rings, segments)
    next_one = np.roll(index, -1, axis=1)
    fan = np.stack([np.zeros(segments, np.int64), index[0], next_one[0]], axis=1)
    lower = np.stack([index[:-1], index[1:], next_one[1:]], axis=-1).reshape(-1, 3)
    upper = np.stack([index[:-1], next_one[1:], next_one[:-1]], axis=-1).reshape(-1, 3)
    return smooth_mesh(
        "round",
        np.concatenate([middle, places.reshape(-1, 3)]),
        np.concatenate([[[0.0, 0.0, 1.0]], normals.reshape(-1, 3)]),
        np.concatenate([fan, lower, upper]),
    )


def ring_mesh(radius: float, height: float, segments: int) -> MeshArrays:
    """The inner side of a ring about the z axis that stands on z = 0."""
    turn = np.linspace(0.0, 2.0 * np.pi, segments, endpoint=False)
    around = np.stack([np.cos(turn), np.sin(turn), np.zeros(segments)], axis=1)
    positions = np.concatenate([radius * around, radius * around + np.array([0.0, 0.0, height])])
    low = np.arange(segments)
    following = np.roll(low, -1)
    triangles = np.concatenate(
        [
            np.stack([low, low + segments, following], axis=1),
            np.stack([following, low + segments, following + segments], axis=1),
        ]
    )
    return smooth_mesh("ring", positions, np.concatenate([-around, -around]), triangles)


def drawn(scene: SceneArrays, view: View, **settings: Any) -> Frame:
    """With caustics."""
    renderer = Renderer(
        scene, Settings(**{"method": "exact", "samples": 1, "caustics": True, "caustic_patches": 16384, **settings})
    )
    frame = renderer.render(view)
    frame.surfaces  # noqa: B018  (read while the renderer is there)
    renderer.free()
    return frame


def sun_along(way: Sequence[float]) -> LightArrays:
    """A sun whose light goes this unit way."""
    z = -np.asarray(way, np.float64)
    x = np.cross((0.0, 1.0, 0.0), z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    return replace(SUN, matrix=matrix)


def irradiance(frame: Frame) -> np.ndarray:
    """(h, w) of what a white surface that the eye sees gets."""
    return np.pi * frame.color()[..., 0].astype(np.float64)
