# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bisector searches: the shader against its float64 reference, grids, and the search on the screen."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import bisector, status
from curvrefl.curvrefl_addon.optics.cube_map import CubeMapSurface
from curvrefl.curvrefl_addon.optics.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.optics.study_surfaces import STUDIES
from curvrefl.curvrefl_addon.renderer.gpu_objects import cube_texture, record_texture
from curvrefl.curvrefl_addon.renderer.solve import Reflector, solve_vertices
from scenes.views import look_at
from test_solve import SURFACES, radial_map, vertices_around

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.mark.parametrize("orthographic", [False, True], ids=["perspective", "orthographic"])
@pytest.mark.parametrize("name", [*SURFACES, "bowl"])
def test_shader_follows_the_reference(name: str, orthographic: bool) -> None:
    hollow = name == "bowl"
    shape = STUDIES["bowl"].surface if hollow else SURFACES[name]
    faces = radial_map(shape)
    surface = CubeMapSurface(faces)
    vertices = vertices_around(Ellipsoid() if hollow else shape, 8000)
    if hollow:
        vertices = vertices[vertices[:, 2] > -0.2] * 0.8
    eye_place = np.array([0.4, -0.3, 2.6]) if hollow else np.array([2.3, -2.9, 1.8])
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    place = np.array([3.0, -2.0, 5.0])
    view = look_at(place + turn.T @ eye_place, place, 640, 480, np.radians(40), orthographic=orthographic)
    world_to_map = np.eye(4)
    world_to_map[:3, :3], world_to_map[:3, 3] = turn, -turn @ place
    world = (vertices @ turn + place).astype(np.float32)
    records = record_texture(np.column_stack([world, np.ones(len(world))]))
    side = -1.0 if hollow else 1.0
    reflector = Reflector(world_to_map, surface.bound, {"radial": cube_texture(faces)}, side)
    points, code, iterations, _ = solve_vertices("bisector_cube", view, reflector, records, len(world)).read()

    reference = bisector.solve(surface, world_to_map @ view.eye, vertices, side=side)
    assert (code == reference.status).mean() > 0.98
    both = (code == status.REFLECTED) & (reference.status == status.REFLECTED)
    assert both.mean() > 0.3
    error = np.linalg.norm(view.project(points) - view.project(reference.position @ turn + place), axis=1)[both]
    assert np.median(error) < 0.02
    assert np.percentile(error, 95) < 0.5
    assert abs(iterations.mean() - reference.iterations.mean()) < 0.5
