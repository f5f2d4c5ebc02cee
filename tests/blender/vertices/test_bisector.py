# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bisector searches: the shader against its float64 reference, grids, and the search on the screen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.solvers import bisector
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, unit
from curvrefl.curvrefl_addon.renderer.device.cubes import cube_texture
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.vertices.bounding_grid import bounding_grid
from curvrefl.curvrefl_addon.renderer.vertices.mirror_solver import MirrorSolver
from curvrefl.curvrefl_addon.renderer.vertices.solve import Reflector, solve_vertices
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import STUDIES
from scenes.mirror_room import Room
from scenes.radial_maps import SURFACES, radial_map, vertices_around
from scenes.views import look_at

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


def pixel_rays(view: View) -> tuple[np.ndarray, np.ndarray]:
    """The eye (3,) and unit directions (h, w, 3)."""
    y, x = np.mgrid[0 : view.height, 0 : view.width]
    clip = np.stack(
        [(2 * x + 1) / view.width - 1, (2 * y + 1) / view.height - 1, np.ones(x.shape), np.ones(x.shape)], -1
    )
    far = clip @ np.linalg.inv(view.world_to_clip).T
    return view.eye[:3], unit(far[..., :3] / far[..., 3:] - view.eye[:3])


def shown_in_half_ball(room: Room, view: View, hollow: bool) -> tuple[np.ndarray, np.ndarray]:
    """Per pixel whether it shows the wanted side of the mirror, and the object_id that a ray finds there."""
    eye, direction = pixel_rays(view)
    along = direction @ eye
    root = along**2 - eye @ eye + 1.0
    distance = -along + (1.0 if hollow else -1.0) * np.sqrt(np.maximum(root, 0.0))
    point = eye + distance[..., None] * direction
    # Pixels at the rim and at the silhouette may show either.
    cosine = np.abs((direction * point).sum(-1))
    _, cover = room.cast(np.broadcast_to(eye, direction.shape), direction)
    on_mirror = (root > 0.0) & (point[..., 2] < -0.05) & (distance < cover) & (cosine > 0.2)
    ray = direction - 2.0 * (direction * point).sum(-1, keepdims=True) * point
    return on_mirror, room.cast(point, ray)[0]


@pytest.mark.parametrize("method", ["bisector_cube", "bisector_screen"])
@pytest.mark.parametrize("hollow", [False, True], ids=["outside", "inside"])
def test_open_mirrors_by_their_closed_companion(hollow: bool, method: str) -> None:
    """A bowl from outside, a convex piece, and from above, a concave one with a thing before its focus."""
    room = Room()
    room.add_half_ball()
    if hollow:
        room.add_ball((0.25, 0.1, -0.72), 0.12)
        eye = np.array([0.3, -0.8, 3.0])
    else:
        room.add_ball((0.4, -1.6, -0.4), 0.3)
        room.add_ball((-1.5, -1.2, -0.9), 0.4)
        eye = np.array([0.8, -4.0, -0.6])
    view = look_at(eye, np.array([0.0, 0.0, -0.4]), 240, 180, np.radians(36))
    shares = {}
    for name in (method, "environment_cube"):
        renderer = Renderer(room.arrays(), Settings(method=name, samples=1))
        frame = renderer.render(view)
        on_mirror, expected = shown_in_half_ball(room, view, hollow)
        on_mirror &= frame.mask() > 0
        assert on_mirror.mean() > 0.1 and 0.02 < (expected > 0)[on_mirror].mean() < 0.9
        shares[name] = float((frame.reflected_object() != expected)[on_mirror].mean())
        renderer.free()
    # Inside a thing has up to three images, of which one is shown.
    assert shares[method] < (0.08 if hollow else 0.02)
    assert shares[method] < (0.7 if hollow else 0.3) * shares["environment_cube"]


def test_the_secant_search_still_refuses_open_mirrors() -> None:
    room = Room()
    room.add_half_ball()
    room.add_ball((0.25, 0.1, -0.72), 0.12)
    with pytest.raises(InputError, match="is open or not star-shaped"):
        Renderer(room.arrays(), Settings(method="secant_star"))


@pytest.mark.parametrize("share", [0.041, 0.055, 0.096, 0.143])
def test_grids_solve_the_share_of_vertices_that_is_asked_for(share: float) -> None:
    """The shares of Estalella et al. 2005, figure 7, on a mesh of 5000 vertices; cells are close to cubes."""
    points = unit(np.random.default_rng(2).normal(size=(5000, 3))) * [2.0, 1.0, 0.6]
    grid = bounding_grid(points.astype(np.float32), share)
    assert len(grid.corners) == pytest.approx(share * 5000, rel=0.25)
    cell = grid.corners[grid.cell_corners]
    edges = np.ptp(cell, axis=1)
    assert (edges.max(axis=1) / edges.min(axis=1)).max() < 1.6
    # Only cells that hold vertices, whose local coordinates lead back to them.
    assert set(grid.vertex_cell) == set(range(len(grid.cell_corners)))
    low, extent = cell[grid.vertex_cell].min(axis=1), edges[grid.vertex_cell]
    np.testing.assert_allclose(low + grid.local * extent, points, atol=1e-5)


def test_the_screen_search_stays_where_nothing_moves_and_follows_several_mirrors() -> None:
    from scenes.mirror_room import radial_mesh

    room = Room()
    room.add_mirror(Ellipsoid())
    room.add_ball((1.2, -1.6, 0.2), 0.3)
    room.add_rectangle((0.0, 0.0, -1.2), (5, 0, 0), (0, 5, 0))
    second = np.eye(4)
    second[:3, 3] = (-2.4, 0.3, 0.0)
    number = room._add(radial_mesh(Ellipsoid()), second, 1)
    arrays = replace(room.arrays(), reflectors=(1, number))
    renderer = Renderer(arrays, Settings(method="bisector_screen", samples=1))
    view = look_at(np.array([-0.8, -6.0, 1.0]), np.array([-1.2, 0.0, 0.0]), 240, 180, np.radians(40))
    cold = renderer.render(view)
    cold_steps = cold.solve["iterations"]["mean"]
    warm = renderer.render(view, last=cold.reflection)
    first = renderer.reflect(view, last=warm.reflection)
    second = renderer.reflect(view, last=first)
    for a, b in zip(first.solutions, second.solutions, strict=True):
        assert all(np.array_equal(p, q) for p, q in zip(a.read(), b.read(), strict=True))
    again = renderer.render(view, last=second)
    np.testing.assert_array_equal(warm.color(), again.color())
    assert warm.solve["iterations"]["mean"] == 1.0 < 0.1 * cold_steps
    shown = again.reflected_object()
    masks = again.mask()
    for mirror in (1, number):
        assert {2, 3} <= set(np.unique(shown[masks == mirror])), "each mirror shows the ball and the floor"
    renderer.free()


def test_a_wider_frustum_finds_what_a_mirror_shows_past_the_border() -> None:
    """A mirror half out of the picture (2006, section 5.2): searched for in it alone, vertices end at its edge."""
    surface, vertices = Ellipsoid(), vertices_around(Ellipsoid(), 3000)
    eye = np.array([2.3, -2.9, 1.8])
    truth = STUDIES["sphere"].oracle().reflection_points(np.append(eye, 1.0), vertices).first(len(vertices))
    room = Room()
    room.add_mirror(surface)
    room.add_ball((1.4, -1.5, 0.2), 0.3)
    view = look_at(eye, np.array([0.75, 0.55, 0.0]), 240, 180, np.radians(20))
    found = {}
    for frustum in (1.0, 2.5):
        renderer = Renderer(room.arrays(), Settings(method="bisector_screen", frustum=frustum, samples=1))
        mirror = renderer.mirrors[0]
        own = renderer.geometry.of_instance(mirror.index)
        reflector = MirrorSolver(mirror).reflector(view, renderer.settings, own, renderer._appearance.materials)
        records = record_texture(np.column_stack([vertices, np.ones(len(vertices))]).astype(np.float32))
        points, code, _, _ = solve_vertices("bisector_screen", view, reflector, records, len(vertices)).read()
        off = np.linalg.norm(view.project(points.astype(float)) - view.project(truth), axis=1)
        found[frustum] = ((code == status.REFLECTED) & (off < 2.0)).sum()
        renderer.free()
    assert found[2.5] > 1.2 * found[1.0] > 0
