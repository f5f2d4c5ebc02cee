# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflectors are baked against shapes whose radius and normals are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface, texel_directions
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, RadialSurface, unit
from curvrefl.curvrefl_addon.renderer.mirrors.reflector_bake import (
    Limits,
    bake_instance,
    bake_reflector,
    bake_reflectors,
)
from curvrefl.curvrefl_addon.renderer.mirrors.reflector_map import Spread, pixel_error
from mirrors.star_baking import ANYTHING, CAP, ORIGIN, affine, bake, capped_ball, rotation
from scenes.star_meshes import centroids, corner_block, inverted, joined, moved, only, prism, scene_of, star_mesh
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

SURFACES: dict[str, RadialSurface] = {
    "sphere": Ellipsoid(),
    "ellipsoid": Ellipsoid(2.0, 1.0, 0.5),
    "bumpy": Bumpy(0.3),
}


def normal_angles(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    crossed = np.linalg.norm(np.cross(one, other), axis=-1)
    return np.degrees(np.arctan2(crossed, (one * other).sum(axis=-1)))


@pytest.mark.parametrize("name", SURFACES)
def test_radius_and_gradient_are_the_surface_s_own(name: str) -> None:
    surface = SURFACES[name]
    baked = bake(star_mesh(surface, 128), 64, center=ORIGIN)
    u = texel_directions(64).reshape(-1, 3)
    r, gradient = surface.radius(u)
    # Chords of 1.4 degrees lie within (1.4 deg)^2 / 8 = 8e-5 of a sphere, and farther off where it bends more.
    np.testing.assert_allclose(baked.radial[..., 0].ravel(), r, rtol=2e-3)
    np.testing.assert_allclose(baked.radial[..., 1:].reshape(-1, 3), gradient, atol=0.01 * surface.bound)
    true_normals = unit(r[:, None] * u - gradient)
    assert normal_angles(baked.normals[..., :3].reshape(-1, 3).astype(float), true_normals).max() < 0.5
    assert baked.holes == 0.0 and baked.multiple_hits == 0.0 and baked.grazing == 0.0 and not baked.warnings
    assert baked.center_name == "given"
    np.testing.assert_array_equal(baked.world_to_map, np.eye(4))


def test_map_agrees_with_itself() -> None:
    """Positions, normals, radius and gradient say the same; extremes are those of the map."""
    baked = bake(star_mesh(Bumpy(0.3), 48))
    u = texel_directions(64)
    np.testing.assert_allclose(baked.positions[..., :3], baked.radial[..., :1] * u, atol=1e-6)
    assert (baked.positions[..., 3] == 1.0).all() and (baked.normals[..., 3] == 1.0).all()
    np.testing.assert_allclose(np.linalg.norm(baked.normals[..., :3], axis=-1), 1.0, atol=1e-6)
    np.testing.assert_allclose((baked.radial[..., 1:] * u).sum(-1), 0.0, atol=1e-6)
    from_gradient = unit(baked.radial[..., :1] * u - baked.radial[..., 1:].astype(float))
    assert normal_angles(from_gradient, baked.normals[..., :3].astype(float)).max() < 1e-3
    assert baked.r_min == baked.radial[..., 0].min() and baked.r_max == baked.radial[..., 0].max()


MATRICES = {
    "turned": affine(rotation(1), (3.0, -2.0, 5.0)),
    "scaled": affine(rotation(2) * 7.0, (-40.0, 10.0, 0.0)),
    "tiny": affine(rotation(3) * 1e-4, (0.5, 0.0, 0.0)),
    "stretched": affine(rotation(4) @ np.diag([2.0, 1.0, 0.5]), (1.0, 2.0, 3.0)),
    "mirrored": affine(rotation(5) @ np.diag([-1.0, 1.0, 1.0]), (0.0, 1.0, 0.0)),
    "mirrored and stretched": affine(rotation(6) @ np.diag([2.0, -1.0, 0.5]), (0.0, 0.0, -3.0)),
    "turned inside out": affine(-rotation(7), (0.0, 0.0, 0.0)),
    "sheared": affine(rotation(8) @ np.array([[1.0, 0.6, 0.0], [0.0, 1.0, 0.3], [0.0, 0.0, 1.2]]), (5.0, 5.0, 5.0)),
}


@pytest.mark.parametrize("name", MATRICES)
def test_placed_reflectors_are_baked_in_world_units(name: str) -> None:
    """The map's points lie on the placed surface, and its normals are the placed surface's, outwards."""
    surface, matrix = Bumpy(0.15), MATRICES[name]
    baked = bake_reflector(scene_of(star_mesh(surface, 96), matrix), 1, 64)
    map_rotation = baked.world_to_map[:3, :3]
    np.testing.assert_allclose(map_rotation @ map_rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(map_rotation) == pytest.approx(1.0)
    np.testing.assert_allclose((baked.world_to_map @ [*baked.center, 1.0])[:3], 0.0, atol=1e-9)
    assert baked.holes == 0.0 and baked.multiple_hits == 0.0

    size = np.linalg.norm(matrix[:3, :3], 2)
    map_to_world = np.linalg.inv(baked.world_to_map)
    points = baked.positions[..., :3].reshape(-1, 3) @ map_to_world[:3, :3].T + map_to_world[:3, 3]
    in_object = (points - matrix[:3, 3]) @ np.linalg.inv(matrix[:3, :3]).T
    distances = np.linalg.norm(in_object, axis=1)
    u = in_object / distances[:, None]
    r, gradient = surface.radius(u)
    np.testing.assert_allclose(distances, r, rtol=2e-3)
    true_normals = unit((r[:, None] * u - gradient) @ np.linalg.inv(matrix[:3, :3]))
    from_gradient = unit(
        baked.radial[..., :1] * texel_directions(64) - baked.radial[..., 1:].astype(np.float64)
    ).reshape(-1, 3)
    assert normal_angles(from_gradient @ map_to_world[:3, :3].T, true_normals).max() < 1.0
    normals = baked.normals[..., :3].reshape(-1, 3).astype(np.float64)
    assert normal_angles(normals @ map_to_world[:3, :3].T, true_normals).max() < 1.0
    assert baked.r_max <= 1.2 * size


def test_flat_shading_is_baked_flat() -> None:
    """A cube: the normals are those of its sides, the radius is that of planes."""
    corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
    cube = moved(prism(corners, [(0, 1, 2), (0, 2, 3)], 2.0), (0.0, 0.0, -1.0))
    baked = bake(cube, 32, center=ORIGIN)
    u = texel_directions(32)
    np.testing.assert_allclose(baked.radial[..., 0], 1.0 / np.abs(u).max(axis=-1), rtol=1e-6)
    for face, axis, sign in ((0, 0, 1.0), (1, 0, -1.0), (2, 1, 1.0), (3, 1, -1.0), (4, 2, 1.0), (5, 2, -1.0)):
        expected = np.zeros(3)
        expected[axis] = sign
        np.testing.assert_allclose(baked.normals[face, ..., :3], np.broadcast_to(expected, (32, 32, 3)), atol=1e-6)


def test_the_center_is_found_where_the_origin_is_outside() -> None:
    baked = bake(moved(star_mesh(Bumpy(0.3), 48), (30.0, -20.0, 10.0)))
    assert np.linalg.norm(baked.center - [30.0, -20.0, 10.0]) < 0.3
    assert baked.holes == 0.0 and baked.multiple_hits == 0.0


def test_the_center_is_found_where_every_plain_guess_is_outside() -> None:
    turn = affine(rotation(9) @ np.diag([1.0, -3.0, 1.0]), (100.0, 0.0, 0.0))
    baked = bake_reflector(scene_of(moved(corner_block(), (-2.0, -2.0, 0.0)), turn), 1, 64)
    assert baked.holes == 0.0 and baked.multiple_hits == 0.0
    inside = np.linalg.inv(turn) @ [*baked.center, 1.0] + [2.0, 2.0, 0.0, 0.0]
    assert (inside[:3] > 0.1).all() and (inside[:3] < 0.9).all()


def test_a_given_center_is_in_world_space() -> None:
    """A sphere from off its center: r = c.u + sqrt((c.u)^2 + 1 - c.c) for c from the star center to the sphere's."""
    place = np.array([3.0, -2.0, 5.0])
    offset = np.array([0.3, 0.2, -0.1])
    mesh = star_mesh(Ellipsoid(), 96)
    baked = bake_reflector(scene_of(mesh, affine(np.eye(3), tuple(place))), 1, 64, center=place - offset)
    np.testing.assert_allclose(baked.center, place - offset, atol=1e-12)
    along = texel_directions(64) @ offset
    np.testing.assert_allclose(baked.radial[..., 0], along + np.sqrt(along**2 + 1.0 - offset @ offset), rtol=1e-3)


def test_an_inverted_mesh_is_the_same_reflector() -> None:
    mesh = star_mesh(Bumpy(0.3), 48)
    outside, inside = bake(mesh, center=ORIGIN), bake(inverted(mesh), center=ORIGIN)
    np.testing.assert_allclose(inside.radial, outside.radial, atol=1e-5)
    np.testing.assert_allclose(inside.normals, outside.normals, atol=1e-5)
    assert inside.multiple_hits == 0.0


def test_the_inner_wall_of_a_shell_does_not_count() -> None:
    ball = star_mesh(Ellipsoid(), 48)
    baked = bake(joined(ball, inverted(moved(ball, ORIGIN, 0.8))))
    assert baked.multiple_hits == 0.0
    assert baked.r_min > 0.99


def test_the_share_of_multiple_hits_is_measured() -> None:
    baked = bake(capped_ball(), 128, center=ORIGIN, limits=ANYTHING)
    assert baked.multiple_hits == pytest.approx(0.1, abs=0.004)
    assert baked.r_max == pytest.approx(1.5, rel=1e-3)
    assert len(baked.warnings) == 0
    assert "than once): what" in bake(capped_ball(), center=ORIGIN, limits=Limits(0.15, 0.0)).warnings[0]


def test_the_share_of_holes_is_measured_and_holes_are_filled() -> None:
    ball = star_mesh(Ellipsoid(), 96)
    baked = bake(only(ball, centroids(ball)[:, 2] < CAP), 128, center=ORIGIN, limits=ANYTHING)
    assert baked.holes == pytest.approx(0.1, abs=0.004)
    hole = baked.positions[..., 3] == 0.0
    np.testing.assert_array_equal(hole, baked.normals[..., 3] == 0.0)
    assert (texel_directions(128)[hole][:, 2] > CAP - 0.05).all()
    np.testing.assert_allclose(baked.radial[hole][:, 0], 1.0, atol=1e-3)
    np.testing.assert_allclose(baked.radial[hole][:, 1:], 0.0, atol=0.05)
    assert "bridged" in bake(only(ball, centroids(ball)[:, 2] < 0.97), center=ORIGIN).warnings[0]


def test_every_instance_has_its_own_map() -> None:
    matrices = [affine(rotation(1), (1.0, 0.0, 0.0)), affine(rotation(2) * 2.0, (-4.0, 0.0, 0.0))]
    scene = scene_of(star_mesh(Ellipsoid(), 16), *matrices)
    with pytest.raises(InputError, match="2 times"):
        bake_reflector(scene, 1)
    first, second = bake_reflectors(scene, 1, 16)
    np.testing.assert_allclose(first.center, [1.0, 0.0, 0.0], atol=1e-5)
    np.testing.assert_allclose(second.center, [-4.0, 0.0, 0.0], atol=1e-5)
    np.testing.assert_allclose(second.radial[..., 0], 2.0 * first.radial[..., 0], rtol=1e-2)
    np.testing.assert_array_equal(bake_instance(scene, 1, 16).radial, second.radial)
    with pytest.raises(InputError, match="no mesh"):
        bake_reflector(scene, 2)


def test_baking_is_repeatable() -> None:
    mesh = star_mesh(Bumpy(0.3), 48)
    one, other = bake(mesh), bake(mesh)
    np.testing.assert_array_equal(one.radial, other.radial)
    assert one.radius_error == other.radius_error


@pytest.mark.parametrize("seed", range(6))
def test_closed_meshes_have_no_cracks(seed: int) -> None:
    """Rays that graze an edge or a vertex hit one side of it, on every face, at odd resolutions, from odd places."""
    rng = np.random.default_rng(seed)
    mesh = star_mesh(Bumpy(0.1), int(rng.integers(3, 60)))
    matrix = affine(rotation(seed) * 10.0 ** rng.uniform(-3, 3), tuple(rng.normal(size=3)))
    resolution = int(rng.integers(8, 200))
    if seed % 2:
        # Lattice directions: texel centers exactly on edges and vertices.
        matrix, resolution = np.eye(4), 2 * resolution + 1
    baked = bake_reflector(scene_of(mesh, matrix), 1, resolution)
    assert baked.holes == 0.0
    assert baked.multiple_hits == 0.0


def test_the_error_falls_with_the_resolution() -> None:
    mesh = star_mesh(Ellipsoid(2.0, 1.0, 0.5), 200)
    coarse, fine = bake(mesh, 16, center=ORIGIN), bake(mesh, 128, center=ORIGIN)
    assert fine.radius_error.median < 1e-4 < coarse.radius_error.median
    assert fine.radius_error.p95 < 5e-4
    assert fine.normal_error_degrees.p95 < 0.1 < coarse.normal_error_degrees.p95
    assert 0.0 < fine.radius_error.median < fine.radius_error.p95 < fine.radius_error.max


def test_a_needle_asks_for_a_finer_map() -> None:
    mesh = star_mesh(Ellipsoid(40.0, 1.0, 1.0), 128)
    (warning,) = bake(mesh, 32, center=ORIGIN).warnings
    assert '"Ball"' in warning and "resolution" in warning
    assert bake(mesh, 512, center=ORIGIN).warnings == ()


def test_the_error_is_that_of_the_map() -> None:
    """The stored points, looked up again in the map, give the errors that are told."""
    baked = bake(star_mesh(Bumpy(0.3), 96), 32)
    points = baked.error_points[:, :3].astype(np.float64)
    distances = np.linalg.norm(points, axis=1)
    r, _ = CubeMapSurface(baked.radial).radius(points / distances[:, None])
    np.testing.assert_allclose(baked.error_points[:, 3], r, rtol=1e-4)
    assert Spread.of(np.abs(r / distances - 1.0)).median == pytest.approx(baked.radius_error.median, rel=0.02)


def test_error_in_pixels_is_the_distance_on_screen() -> None:
    """A map that is one percent too large all over, in an orthographic view: the silhouette is off the most."""
    place = np.array([10.0, 0.0, 0.0])
    baked = bake_reflector(scene_of(star_mesh(Ellipsoid(), 48), affine(2.0 * np.eye(3), tuple(place))), 1, 64)
    grown = baked.error_points.copy()
    grown[:, 3] = 1.01 * np.linalg.norm(grown[:, :3], axis=1)
    baked = replace(baked, error_points=grown)
    view = look_at(place + np.array([0.0, -20.0, 5.0]), place, 640, 480, np.radians(40), orthographic=True)
    assert pixel_error(baked, view).max == pytest.approx(0.01 * 2.0 * view.focal_pixels, rel=0.01)
    away = look_at(place + np.array([0.0, -20.0, 5.0]), place + np.array([0.0, -40.0, 5.0]), 640, 480, np.radians(40))
    assert pixel_error(baked, away) == Spread()


def test_what_is_told_is_what_was_measured() -> None:
    ball = star_mesh(Ellipsoid(), 32)
    text = "\n".join(bake(moved(ball, (4.0, 0.0, 0.0)), 32).describe())
    assert "Ball: star center (4, " in text and "32 x 32 x 6" in text and "never: 0 %" in text
