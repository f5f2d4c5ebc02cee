# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The solver's shader is held to its float64 reference on the same radial map."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.solvers import secant_star
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid
from curvrefl.curvrefl_addon.renderer.device.cubes import cube_texture
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.vertices.solution import statistics
from curvrefl.curvrefl_addon.renderer.vertices.solve import Reflector, solve_vertices
from scenes.radial_maps import SURFACES, radial_map, vertices_around
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.mark.parametrize("orthographic", [False, True], ids=["perspective", "orthographic"])
@pytest.mark.parametrize("name", SURFACES)
def test_shader_follows_the_reference(name: str, orthographic: bool) -> None:
    faces = radial_map(SURFACES[name])
    surface = CubeMapSurface(faces)
    vertices = vertices_around(SURFACES[name], 8000)
    # The reflector stands turned and away from the origin: the map's frame is not the world's.
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    place = np.array([3.0, -2.0, 5.0])
    view = look_at(place + np.array([2.3, -2.9, 1.8]), place, 640, 480, np.radians(40), orthographic=orthographic)
    world_to_map = np.eye(4)
    world_to_map[:3, :3], world_to_map[:3, 3] = turn, -turn @ place
    world = (vertices @ turn + place).astype(np.float32)

    positions = record_texture(np.column_stack([world, np.ones(len(world))]))
    reflector = Reflector(world_to_map, surface.bound, {"radial": cube_texture(faces)})
    solution = solve_vertices("secant_star", view, reflector, positions, len(world))
    points, code, iterations, virtual = solution.read()

    eye = world_to_map @ view.eye
    reference = secant_star.solve(surface, Screen(eye, view.focal_pixels), vertices)
    assert (code == reference.status).mean() > 0.998
    both = (code == status.REFLECTED) & (reference.status == status.REFLECTED)
    assert both.mean() > 0.5
    expected = reference.at.position @ turn + place
    error = np.linalg.norm(view.project(points) - view.project(expected), axis=1)[both]
    assert np.median(error) < 0.02
    assert np.percentile(error, 99) < 0.25
    assert abs(iterations[both].mean() - reference.iterations[both].mean()) < 0.5

    # A reflected vertex seems to be behind its reflection point, on the same line of sight.
    same_pixel = np.linalg.norm(view.project(virtual[:, :3]) - view.project(points), axis=1)[both]
    assert same_pixel.max() < 0.05
    np.testing.assert_allclose(virtual[both, 3], np.linalg.norm(world - points, axis=1)[both], rtol=1e-4, atol=1e-5)
    counts = statistics([solution])
    assert counts["reflected"] + counts["hidden"] + counts["unconverged"] == counts["vertices"] == len(world)


@pytest.mark.parametrize("method", ["secant_star", "newton"])
def test_broken_vertices_are_marked(method: str) -> None:
    faces = radial_map(Ellipsoid())
    places = np.array([[np.nan, 0, 0], [np.inf, 0, 0], [0, 0, 2], [0, 0, 0]], np.float32)
    view = look_at(np.array([0.0, -4.0, 1.0]), np.zeros(3), 320, 240, np.radians(40))
    solution = solve_vertices(
        method,
        view,
        Reflector(np.eye(4), 1.0, {"radial": cube_texture(faces)}),
        record_texture(np.column_stack([places, np.ones(4)])),
        4,
    )
    points, code, _, virtual = solution.read()
    assert code.tolist() == [status.INVALID, status.INVALID, status.REFLECTED, status.HIDDEN]
    assert np.isfinite(points).all() and np.isfinite(virtual).all()


def test_same_input_same_bits() -> None:
    reflector = Reflector(np.eye(4), 1.15, {"radial": cube_texture(radial_map(Bumpy(0.15)))})
    vertices = vertices_around(Bumpy(0.15), 3000)
    positions = record_texture(np.column_stack([vertices, np.ones(len(vertices))]))
    view = look_at(np.array([0.0, -4.0, 1.0]), np.zeros(3), 320, 240, np.radians(40))
    first, second = (solve_vertices("secant_star", view, reflector, positions, len(vertices)).read() for _ in range(2))
    for one, other in zip(first, second, strict=True):
        assert np.array_equal(one, other)
