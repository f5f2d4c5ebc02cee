# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shader is held to its float64 reference, and on a sphere to the quartic."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.solvers import secant_uv
from curvrefl.curvrefl_addon.optics.surfaces import sphere
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.mirrors.parametric_map import ParametricMap
from curvrefl.curvrefl_addon.renderer.vertices.solution import VertexSolution
from curvrefl.curvrefl_addon.renderer.vertices.solve import SAMPLERS, Reflector, solve_vertices
from curvrefl.curvrefl_addon.scene.camera.view import View
from mirrors.uv_meshes import SHAPES, bake, rigid, uv_sphere
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

EYE = np.array([2.3, -2.9, 1.8])


def solve(
    baked: ParametricMap, view: View, vertices: np.ndarray, world_to_map: np.ndarray, steps: int = 0
) -> VertexSolution:
    reflector = Reflector(world_to_map, 2.0, baked.samplers())
    records = np.column_stack([vertices, np.ones(len(vertices))]).astype(np.float32)
    return solve_vertices("secant_uv", view, reflector, record_texture(records), len(vertices), steps)


def vertices_around(count: int, nearest: float = 1e-2) -> np.ndarray:
    rng = np.random.default_rng(7)
    u = unit(rng.normal(size=(count, 3)))
    return (u * (1.0 + 10 ** rng.uniform(np.log10(nearest), 1, count))[:, None]).astype(np.float32).astype(np.float64)


def test_textures_are_those_the_solver_binds() -> None:
    baked = bake(uv_sphere(16, 8))
    assert set(baked.samplers()) == {name for _, name in SAMPLERS["parametric"]}
    assert baked.samplers() is baked.samplers()


@pytest.mark.parametrize("orthographic", [False, True], ids=["perspective", "orthographic"])
@pytest.mark.parametrize("name", ["uv sphere", *SHAPES])
def test_shader_follows_the_reference(name: str, orthographic: bool) -> None:
    baked = bake(uv_sphere() if name == "uv sphere" else SHAPES[name][0]())
    vertices = vertices_around(6000)
    # The reflector stands turned and away from the origin: the map's frame is not the world's.
    world_to_map = rigid(3, (3.0, -2.0, 5.0))
    to_world = np.linalg.inv(world_to_map)
    place = to_world[:3, 3]
    world = (vertices @ to_world[:3, :3].T + place).astype(np.float32)
    view = look_at(place + EYE, place, 640, 480, np.radians(40), orthographic=orthographic)
    points, code, iterations, virtual = solve(baked, view, world, world_to_map).read()
    eye = world_to_map @ view.eye
    in_map = world.astype(np.float64) @ world_to_map[:3, :3].T + world_to_map[:3, 3]
    reference = secant_uv.solve(baked.surface, Screen(eye, view.focal_pixels), in_map, tolerance=0.05)
    assert (code == reference.status).mean() > 0.995
    both = (code == status.REFLECTED) & (reference.status == status.REFLECTED)
    assert both.mean() > 0.15
    expected = reference.position @ to_world[:3, :3].T + place
    error = np.linalg.norm(view.project(points) - view.project(expected), axis=1)[both]
    assert np.median(error) < 0.02
    # A search that has not converged after five steps turns on the last bits.
    assert np.percentile(error, 98) < 0.25
    assert abs(iterations[both].mean() - reference.iterations[both].mean()) < 0.1
    hidden = (code == status.HIDDEN) & (reference.status == status.HIDDEN)
    assert hidden.mean() > 0.05
    assert np.percentile(np.linalg.norm(points - expected, axis=1)[hidden], 95) < 1e-3
    # A hidden vertex is its mirror image in the tangent plane.
    normal = reference.normal @ to_world[:3, :3].T
    image = world - 2.0 * ((world - expected) * normal).sum(axis=1, keepdims=True) * normal
    assert np.percentile(np.linalg.norm(virtual[:, :3] - image, axis=1)[hidden], 95) < 0.01
    # A reflected vertex seems to be behind its reflection point, on the same line of sight.
    same_pixel = np.linalg.norm(view.project(virtual[:, :3]) - view.project(points), axis=1)[both]
    assert same_pixel.max() < 0.05


def test_sphere_against_the_quartic() -> None:
    baked, vertices = bake(uv_sphere()), vertices_around(4000, 0.3)
    view = look_at(EYE, np.zeros(3), 640, 480, np.radians(40))
    truth = sphere.reflection_points(EYE, vertices, 1.0)
    reflects = np.isfinite(truth[:, 0])
    for steps, lost, p95 in ((0, 0.1, 2.0), (12, 0.07, 0.3)):
        points, code, iterations, _ = solve(baked, view, vertices, np.eye(4), steps).read()
        assert iterations.max() == (steps or 5)
        both = reflects & (code == status.REFLECTED)
        assert (reflects & ~both).sum() < lost * reflects.sum()
        error = np.linalg.norm(view.project(points) - view.project(truth), axis=1)[both]
        assert np.percentile(error, 95) < p95
        # On the horizon the mesh, whose faces lie inside the sphere, reflects a little more.
        assert (~reflects & (code == status.REFLECTED)).mean() < 0.005


def test_broken_vertices_are_marked() -> None:
    places = np.array([[np.nan, 0, 0], [np.inf, 0, 0], [0.6, -1.5, 1.0], [0, 0, 0], EYE], np.float32)
    view = look_at(EYE, np.zeros(3), 320, 240, np.radians(40))
    points, code, _, virtual = solve(bake(uv_sphere()), view, places, np.eye(4)).read()
    assert code[:4].tolist() == [status.INVALID, status.INVALID, status.REFLECTED, status.HIDDEN]
    assert np.isfinite(points).all() and np.isfinite(virtual).all()


def test_same_input_same_bits() -> None:
    baked, vertices = bake(uv_sphere(32, 16)), vertices_around(3000)
    view = look_at(EYE, np.zeros(3), 320, 240, np.radians(40))
    first, second = (solve(baked, view, vertices, np.eye(4)).read() for _ in range(2))
    for one, other in zip(first, second, strict=True):
        assert np.array_equal(one, other)
