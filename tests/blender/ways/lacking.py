# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Devices that lack something, and a mirror ball to solve and draw on them."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface
from curvrefl.curvrefl_addon.renderer.device.cubes import cube_texture
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.device.ways.features import Features, only_features
from curvrefl.curvrefl_addon.renderer.vertices.solution import VertexSolution
from curvrefl.curvrefl_addon.renderer.vertices.solve import Reflector, prepare_solve, solve_vertices
from curvrefl.curvrefl_addon.scene.camera.view import View
from scenes.radial_maps import SURFACES, radial_map, vertices_around
from scenes.views import look_at

WHOLE = Features()
LACKING = {
    "compute": Features(compute=False, atomics=False),
    "atomics": Features(atomics=False),
    "quads": Features(quads=False),
    "fits": Features(fits=False),
}
EYE = np.array([2.3, -2.9, 1.8])


def eyed(eye: np.ndarray = EYE) -> View:
    return look_at(eye, np.zeros(3), 640, 480, np.radians(40))


class Ellipsoids:
    """An ellipsoid's map and vertices around it."""

    def __init__(self, count: int) -> None:
        faces = radial_map(SURFACES["ellipsoid"])
        self.count = count
        self.vertices = vertices_around(SURFACES["ellipsoid"], count, 1e-3)
        self.vertices[count // 2] = np.nan
        self.positions = record_texture(np.column_stack([self.vertices, np.ones(count)]).astype(np.float32))
        self.reflector = Reflector(
            np.eye(4),
            CubeMapSurface(faces).bound,
            {"radial": cube_texture(faces)},
            plane=(0.0, 0.0, 1.0, -0.5),
            index=1.4,
        )

    def solve(
        self,
        method: str,
        device: Features,
        eye: np.ndarray = EYE,
        previous: VertexSolution | None = None,
        steps: int = 0,
    ) -> VertexSolution:
        with only_features(device):
            return solve_vertices(
                method, eyed(eye), self.reflector, self.positions, self.count, steps=steps, previous=previous
            )

    def twice(self, method: str, device: Features) -> list[np.ndarray]:
        """Of dispatches that are run again, as for timing."""
        with only_features(device):
            prepared = prepare_solve(method, eyed(), self.reflector, self.positions, self.count)
            prepared.run()
            prepared.run()
            return list(prepared.solution.read())
