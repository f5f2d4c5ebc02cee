# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror ball among balls and rectangles, as scene arrays, and what it must show by closed-form ray casting."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, RadialSurface, unit
from curvrefl.curvrefl_addon.scene.arrays import InstanceArrays, MaterialArrays, MeshArrays, SceneArrays, WorldArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.scene.meshes.made import smooth_mesh
from scenes.views import lines_of_sight

MIRROR = 1
"""object_id of the mirror ball: radius 1 about the origin"""


def radial_mesh(surface: RadialSurface, segments: int = 128) -> MeshArrays:
    """A star-shaped surface as a latitude-longitude mesh with the exact normals."""
    rings = segments // 2
    theta = np.linspace(0.0, np.pi, rings + 1)[:, None]
    phi = np.linspace(0.0, 2 * np.pi, segments, endpoint=False)[None]
    ones = np.ones_like(phi)
    u = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta) * ones], -1).reshape(-1, 3)
    radius, gradient = surface.radius(u)
    a = (np.arange(rings)[:, None] * segments + np.arange(segments)[None]).ravel()
    b = (np.arange(rings)[:, None] * segments + (np.arange(segments)[None] + 1) % segments).ravel()
    lower = np.column_stack([a, a + segments, b + segments])
    upper = np.column_stack([a, b + segments, b])
    triangles = np.concatenate([lower[:-segments], upper[segments:]])
    return smooth_mesh("radial", radius[:, None] * u, unit(radius[:, None] * u - gradient), triangles)


@dataclass
class Room:
    """Collects things, then gives arrays and answers."""

    balls: list[tuple[int, np.ndarray, float]] = field(default_factory=list)
    rectangles: list[tuple[int, np.ndarray, np.ndarray, np.ndarray]] = field(default_factory=list)
    _meshes: list[MeshArrays] = field(default_factory=list)
    _instances: list[InstanceArrays] = field(default_factory=list)

    def add_mirror(self, surface: RadialSurface, segments: int = 128) -> None:
        """The reflector, about the origin; first of all things."""
        self._add(radial_mesh(surface, segments), np.eye(4), 1)

    def add_half_ball(self, segments: int = 128) -> None:
        """The reflector: the lower half of the unit ball, open above; first of all things."""
        whole = radial_mesh(Ellipsoid(), segments)
        low = whole.positions[whole.triangles][..., 2].max(axis=1) < 1e-6
        self._add(replace(whole, triangles=whole.triangles[low], triangle_slot=whole.triangle_slot[low]), np.eye(4), 1)

    def add_ball(self, center: tuple[float, float, float], radius: float, **flags: bool) -> int:
        """A ball; returns its object_id."""
        matrix = np.diag([radius, radius, radius, 1.0])
        matrix[:3, 3] = center
        number = self._add(radial_mesh(Ellipsoid(), 64), matrix, 0, **flags)
        if flags.get("visible_glossy", True):
            self.balls.append((number, np.array(center, float), radius))
        return number

    def add_rectangle(
        self, center: tuple[float, float, float], half_x: tuple[float, ...], half_y: tuple[float, ...], **flags: bool
    ) -> int:
        """A rectangle of two triangles with the given half axes; returns its object_id."""
        c, x, y = np.array(center, float), np.array(half_x, float), np.array(half_y, float)
        corners = np.array([c - x - y, c + x - y, c + x + y, c - x + y])
        normals = np.tile(unit(np.cross(x, y)), (4, 1))
        number = self._add(
            smooth_mesh("rectangle", corners, normals, np.array([[0, 1, 2], [0, 2, 3]])), np.eye(4), 0, **flags
        )
        if flags.get("visible_glossy", True):
            self.rectangles.append((number, c, x, y))
        return number

    def _add(self, shape: MeshArrays, matrix: np.ndarray, material: int, **flags: bool) -> int:
        self._meshes.append(shape)
        number = len(self._meshes)
        self._instances.append(InstanceArrays(f"object {number}", number, number - 1, matrix, (material,), **flags))
        return number

    def arrays(self) -> SceneArrays:
        """The scene, with the first thing as the only reflector."""
        materials = (MaterialArrays("gray"), MaterialArrays("chrome", base_color=(1, 1, 1), metallic=1, roughness=0))
        return SceneArrays(
            tuple(self._meshes), tuple(self._instances), materials, (), (), WorldArrays((0.5, 0.5, 0.5)), (MIRROR,)
        )

    def cast(self, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """First object_id hit (...) or 0, and the distance (...), infinite for none; the mirror itself is not hit."""
        nearest = np.full(origins.shape[:-1], np.inf)
        hit = np.zeros(origins.shape[:-1], int)
        for number, center, radius in self.balls:
            offset = origins - center
            b = (offset * directions).sum(-1)
            root = b * b - (offset**2).sum(-1) + radius**2
            t = -b - np.sqrt(np.maximum(root, 0.0))
            closer = (root > 0) & (t > 1e-9) & (t < nearest)
            nearest[closer], hit[closer] = t[closer], number
        for number, center, x, y in self.rectangles:
            normal = np.cross(x, y)
            facing = directions @ normal
            t = ((center - origins) @ normal) / np.where(np.abs(facing) < 1e-15, 1e-15, facing)
            local = origins + t[..., None] * directions - center
            inside = (np.abs(local @ x) <= x @ x) & (np.abs(local @ y) <= y @ y)
            closer = inside & (t > 1e-9) & (t < nearest)
            nearest[closer], hit[closer] = t[closer], number
        return hit, nearest

    def seen_in_ball(self, view: View) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Per pixel (h, w): whether the mirror ball is on the line of sight and not covered, the object_id that it
        shows, and the point (h, w, 3) that it shows (for the background: the direction)."""
        origin, direction = lines_of_sight(view)
        b = (origin * direction).sum(-1)
        root = b * b - (origin**2).sum(-1) + 1.0
        t = -b - np.sqrt(np.maximum(root, 0.0))
        _, cover = self.cast(origin, direction)
        on_ball = (root > 0) & (t < cover)
        point = origin + t[..., None] * direction
        ray = direction - 2 * (direction * point).sum(-1, keepdims=True) * point
        hit, distance = self.cast(point, ray)
        shown = np.where(
            np.isfinite(distance)[..., None], point + np.where(np.isfinite(distance), distance, 0)[..., None] * ray, ray
        )
        return on_ball, hit, shown
