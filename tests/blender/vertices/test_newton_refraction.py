# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shaders of `newton_refraction` are held to their float64 reference, and to the vertices they are made from."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.fermat import sample, towards_eye
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.snell import refracted
from curvrefl.curvrefl_addon.optics.solvers import newton_refraction
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import RadialSurface, unit
from curvrefl.curvrefl_addon.renderer.device.cubes import cube_texture
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.vertices.solution import VertexSolution
from curvrefl.curvrefl_addon.renderer.vertices.solve import Reflector, solve_vertices
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.radial_maps import SURFACES, radial_map
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

EYE = np.array([2.3, -2.9, 1.8])
INSIDE = np.array([0.1, -0.12, 0.08])


class Glass:
    """A surface that stands turned and away from the origin, and vertices made from its refracted lines of sight."""

    def __init__(
        self,
        surface: RadialSurface,
        index: float,
        eye: np.ndarray = EYE,
        orthographic: bool = False,
        scale: float = 1.0,
    ) -> None:
        faces = radial_map(surface, 128)
        faces = (faces * scale).astype(np.float32)
        self.surface, self.index = CubeMapSurface(faces.astype(np.float64)), index
        self.side = -1.0 if eye is INSIDE else 1.0
        turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
        self.turn = turn * np.sign(np.linalg.det(turn))
        self.place = scale * np.array([3.0, -2.0, 5.0])
        world_to_map = np.eye(4)
        world_to_map[:3, :3] = self.turn
        world_to_map[:3, 3] = -self.turn @ self.place
        self.view = look_at(self.place + scale * eye, self.place, 640, 480, np.radians(40), orthographic=orthographic)
        self.eye = world_to_map @ self.view.eye
        random = np.random.default_rng(7)
        at = sample(self.surface, unit(random.normal(size=(12_000, 3))))
        to_eye, normal = towards_eye(self.eye, at.position), self.side * at.normal
        ray = refracted(to_eye, normal, index)
        kept = (np.einsum("ij,ij->i", to_eye, normal) > 0.05) & np.isfinite(ray[:, 0])
        distance = scale * 10 ** random.uniform(-3, 1, kept.sum())
        self.vertices = at.position[kept] + distance[:, None] * ray[kept]
        world = (self.vertices @ self.turn + self.place).astype(np.float32)
        self.positions = record_texture(np.column_stack([world, np.ones(len(world))]))
        self.reflector = Reflector(
            world_to_map, self.surface.bound, {"radial": cube_texture(faces)}, side=self.side, index=index
        )

    def solve(self, previous: VertexSolution | None = None, view: View | None = None, **options: int) -> VertexSolution:
        return solve_vertices(
            "newton_refraction",
            view or self.view,
            self.reflector,
            self.positions,
            len(self.vertices),
            previous=previous,
            **options,
        )

    def reference(self, **options: int) -> tuple[newton_refraction.Solution, np.ndarray]:
        return newton_refraction.solve(
            self.surface, Screen(self.eye, self.view.focal_pixels), self.vertices, self.index, side=self.side, **options
        )

    def in_map(self, points: np.ndarray) -> np.ndarray:
        return (points - self.place) @ self.turn.T

    def pixels(self, points: np.ndarray, expected: np.ndarray) -> np.ndarray:
        """(n,) between world points and points of the map frame."""
        return np.linalg.norm(self.view.project(points) - self.view.project(expected @ self.turn + self.place), axis=1)

    def misses(self, points: np.ndarray) -> np.ndarray:
        """(n,) pixels to first order between world points and where the surface refracts to the vertices: how far the
        points have to move for the ray to pass the vertex, by differences."""
        return self.pixels(points, self.polished(points))

    def polished(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) map frame: from world points on by the reference alone, to a thousandth of the tolerance."""
        u = unit(self.in_map(points.astype(np.float64)))
        return newton_refraction.solve(
            self.surface,
            Screen(self.eye, self.view.focal_pixels),
            self.vertices,
            self.index,
            u,
            1e-4,
            self.side,
        )[0].at.position


@pytest.mark.parametrize("index", [1.01, 1.5, 2.4, 3.0, 1.0 / 1.5])
@pytest.mark.parametrize("name", SURFACES)
def test_shader_follows_the_reference(name: str, index: float) -> None:
    glass = Glass(SURFACES[name], index)
    points, code, iterations, virtual = glass.solve().read()
    reference, _ = glass.reference()
    print(
        name,
        index,
        len(code),
        (code == status.REFLECTED).mean(),
        (reference.status == status.REFLECTED).mean(),
        (code == reference.status).mean(),
    )
    both = (code == status.REFLECTED) & (reference.status == status.REFLECTED)
    error = glass.misses(points)[both]
    print(np.percentile(error, [50, 99, 99.9, 100]), iterations[both].mean(), reference.iterations[both].mean())
    print(np.linalg.norm(glass.view.project(virtual[:, :3]) - glass.view.project(points), axis=1)[both].max())
