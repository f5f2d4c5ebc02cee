# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Face layout and seamless sampling of cube maps, and filling their holes."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.cube_holes import fill_holes
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import (
    CubeMapSurface,
    face_coordinates,
    nearest_texel,
    sample_cube,
    texel_directions,
)
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, RadialSurface, unit

# Of the OpenGL 4.6 specification, table 8.19: face, major axis, sc, tc as signed axes (1 = +x, -3 = -z).
SPECIFICATION = [(0, 1, -3, -2), (1, -1, 3, -2), (2, 2, 1, 3), (3, -2, 1, -3), (4, 3, 1, -2), (5, -3, -1, -2)]


def along(direction: np.ndarray, signed_axis: int) -> np.ndarray:
    return np.sign(signed_axis) * direction[..., abs(signed_axis) - 1]


def random_directions(count: int, seed: int = 1) -> np.ndarray:
    return unit(np.random.default_rng(seed).normal(size=(count, 3)))


def near_seams(count: int) -> np.ndarray:
    """Directions within a hundredth of a face's width of an edge, and some as near to a corner."""
    directions = random_directions(count, seed=2)
    directions /= np.abs(directions).max(axis=1, keepdims=True)
    rng = np.random.default_rng(3)
    edge = np.argsort(np.abs(directions), axis=1)[:, 1:]
    edge[: count // 4] = 0
    directions[np.arange(count)[:, None], edge] = np.sign(directions[np.arange(count)[:, None], edge])
    corner = slice(0, count // 4)
    directions[corner] = rng.choice([-1.0, 1.0], size=(count // 4, 3))
    return directions + rng.uniform(-0.01, 0.01, directions.shape)


def radial_map(surface: RadialSurface, resolution: int) -> np.ndarray:
    u = texel_directions(resolution).reshape(-1, 3)
    r, gradient = surface.radius(u)
    return np.column_stack([r, gradient]).reshape(6, resolution, resolution, 4)


def test_faces_are_those_of_opengl() -> None:
    n = 5
    centers = (2.0 * np.arange(n) + 1.0) / n - 1.0
    directions = texel_directions(n)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=-1), 1.0)
    for face, major, sc, tc in SPECIFICATION:
        of_face = directions[face]
        depth = along(of_face, major)
        assert (depth > 0.5).all()
        np.testing.assert_allclose(along(of_face, sc) / depth, np.tile(centers, (n, 1)), atol=1e-15)
        np.testing.assert_allclose(along(of_face, tc) / depth, np.tile(centers[:, None], (1, n)), atol=1e-15)


@pytest.mark.parametrize("resolution", [1, 2, 7, 64])
def test_a_texel_is_nearest_to_its_own_direction(resolution: int) -> None:
    found = nearest_texel(resolution, 3.0 * texel_directions(resolution).reshape(-1, 3))
    expected = np.indices((6, resolution, resolution)).reshape(3, -1)
    np.testing.assert_array_equal(found, expected)


def test_face_coordinates_lie_on_the_face() -> None:
    face, s, t = face_coordinates(np.array([[2.0, 1.0, -0.5], [0.1, -4.0, 1.0], [0.0, 0.0, -1.0]]))
    np.testing.assert_array_equal(face, [0, 3, 5])
    np.testing.assert_allclose(s, [0.25, 0.025, 0.0])
    np.testing.assert_allclose(t, [-0.5, -0.25, 0.0])


def test_sampling_at_texel_centers_gives_the_texels() -> None:
    faces = np.random.default_rng(0).normal(size=(6, 8, 8, 3))
    sampled = sample_cube(faces, texel_directions(8).reshape(-1, 3))
    np.testing.assert_allclose(sampled.reshape(faces.shape), faces, atol=1e-12)


def test_sampling_is_continuous_over_edges_and_corners() -> None:
    """Two directions 1e-7 apart, often on two faces or three, give nearly the same of random texels."""
    faces = np.random.default_rng(0).normal(size=(6, 8, 8, 1))
    directions = near_seams(20000)
    # Onto the seam exactly, then a little to either side of it.
    directions = np.where(np.abs(directions) > 0.98, np.sign(directions), directions)
    step = 1e-7 * np.random.default_rng(4).normal(size=directions.shape)
    one, other = directions + step, directions - step
    changed = face_coordinates(one)[0] != face_coordinates(other)[0]
    assert changed.mean() > 0.3
    np.testing.assert_allclose(sample_cube(faces, one), sample_cube(faces, other), atol=1e-4)


def test_sampling_a_smooth_function_gets_better_with_resolution() -> None:
    """Of second order inside the faces; of first order within half a texel of an edge, where the neighbor's texels
    are up to half a texel out of line with the face's own, as on a GPU.
    """
    inside = random_directions(5000)
    inside = inside[np.sort(np.abs(inside), axis=1)[:, 1] < 0.95 * np.abs(inside).max(axis=1)]

    def largest_error(resolution: int, directions: np.ndarray) -> float:
        faces = texel_directions(resolution)[..., :1] ** 3
        return float(np.abs(sample_cube(faces, directions) - directions[:, :1] ** 3).max())

    assert largest_error(64, inside) < 1e-3
    assert largest_error(128, inside) < 0.3 * largest_error(64, inside)
    seams = unit(near_seams(5000))
    assert largest_error(64, seams) < 4e-3
    assert largest_error(128, seams) < 0.6 * largest_error(64, seams)


@pytest.mark.parametrize("surface", [Ellipsoid(), Ellipsoid(2.0, 1.0, 0.5), Bumpy(0.3)], ids=["ball", "oval", "bumpy"])
def test_a_map_stands_for_its_surface(surface: RadialSurface) -> None:
    baked = CubeMapSurface(radial_map(surface, 128))
    u = random_directions(5000)
    r, gradient = baked.radius(u)
    true_r, true_gradient = surface.radius(u)
    np.testing.assert_allclose(r, true_r, rtol=2e-3)
    np.testing.assert_allclose(gradient, true_gradient, atol=1e-2 * surface.bound)
    np.testing.assert_allclose(np.einsum("ij,ij->i", gradient, u), 0.0, atol=1e-12)
    assert baked.bound <= surface.bound * (1.0 + 1e-12)


def test_filled_holes_go_on_smoothly_and_leave_the_rest() -> None:
    surface = Bumpy(0.3)
    faces = radial_map(surface, 64)
    directions = texel_directions(64)
    # Two caps: one over the middle of a face, one over a corner of three.
    hit = (directions[..., 0] < 0.95) & (directions @ unit(np.array([-1.0, 1.0, -1.0])) < 0.97)
    assert 0.02 < (~hit).mean() < 0.1
    spoilt = np.where(hit[..., None], faces, np.nan)
    filled = fill_holes(spoilt, hit)
    np.testing.assert_array_equal(filled[hit], faces[hit])
    assert np.isfinite(filled).all()
    rim_low, rim_high = faces[..., 0].min(), faces[..., 0].max()
    assert (filled[..., 0] >= rim_low).all() and (filled[..., 0] <= rim_high).all()
    # The hole's middle lies between its rim's extremes; a smooth surface is not far from its own rim.
    np.testing.assert_allclose(filled[..., 0], faces[..., 0], atol=0.1)


def test_the_gradient_in_a_hole_is_that_of_its_radius() -> None:
    faces = radial_map(Bumpy(0.3), 128)
    directions = texel_directions(128)
    filled = fill_holes(faces, directions[..., 2] < 0.9)
    deep = directions[4, :, :, 2] > 0.93
    for axis in (0, 1):
        here, there = np.take(filled[4], range(127), axis), np.take(filled[4], range(1, 128), axis)
        u, v = np.take(directions[4], range(127), axis), np.take(directions[4], range(1, 128), axis)
        inside = np.take(deep, range(127), axis) & np.take(deep, range(1, 128), axis)
        step = 0.5 * np.einsum("ijk,ijk->ij", here[..., 1:] + there[..., 1:], v - u)
        change = there[..., 0] - here[..., 0]
        assert np.abs(change[inside]).max() > 1e-4
        np.testing.assert_allclose(step[inside], change[inside], atol=0.02 * np.abs(change[inside]).max())


def test_a_hole_in_a_ball_is_filled_with_the_ball() -> None:
    faces = radial_map(Ellipsoid(3.0, 3.0, 3.0), 16)
    filled = fill_holes(faces, texel_directions(16)[..., 1] < 0.5)
    np.testing.assert_allclose(filled[..., 0], 3.0)
    np.testing.assert_allclose(filled[..., 1:], 0.0, atol=1e-9)
