# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sphere map's mapping and its inverse, and the finite-radius correction."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.environment import (
    axis_frame,
    environment_radius,
    parallax_directions,
    sphere_map_directions,
    sphere_map_places,
    texel_solid_angles,
)
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import texel_directions
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit


def random_directions(count: int, seed: int = 1) -> np.ndarray:
    return unit(np.random.default_rng(seed).normal(size=(count, 3)))


def test_sphere_map_there_and_back() -> None:
    directions = random_directions(20000)
    places = sphere_map_places(directions)
    assert (np.linalg.norm(places, axis=1) <= 1.0).all()
    np.testing.assert_allclose(sphere_map_directions(places), directions, atol=1e-12)
    rng = np.random.default_rng(2)
    radius, turn = np.sqrt(rng.uniform(0.0, 0.999, 20000)), rng.uniform(0.0, 2.0 * np.pi, 20000)
    inside = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1)
    np.testing.assert_allclose(sphere_map_places(sphere_map_directions(inside)), inside, atol=1e-11)


def test_sphere_map_is_the_picture_of_a_mirror_ball() -> None:
    """Of a ball's point (s, t, sqrt(1 - s^2 - t^2)), seen along the z axis: r = 2 (n . v) n - v."""
    grid = np.linspace(-0.9, 0.9, 19)
    places = np.stack(np.meshgrid(grid, grid), -1).reshape(-1, 2)
    places = places[(places**2).sum(1) < 1.0]
    normals = np.column_stack([places, np.sqrt(1.0 - (places**2).sum(1))])
    viewer = np.array([0.0, 0.0, 1.0])
    reflected = 2.0 * (normals @ viewer)[:, None] * normals - viewer
    np.testing.assert_allclose(sphere_map_directions(places), reflected, atol=1e-15)
    np.testing.assert_allclose(sphere_map_places(reflected), places, atol=1e-15)


@pytest.mark.parametrize(
    ("direction", "place"),
    [
        ((0.0, 0.0, 1.0), (0.0, 0.0)),
        ((1.0, 0.0, 0.0), (np.sqrt(0.5), 0.0)),
        ((0.0, -1.0, 0.0), (0.0, -np.sqrt(0.5))),
        ((0.0, 0.0, -1.0), (1.0, 0.0)),
    ],
)
def test_known_places(direction: tuple[float, ...], place: tuple[float, ...]) -> None:
    np.testing.assert_allclose(sphere_map_places(np.array([direction])), [place], atol=1e-15)


def test_all_of_the_rim_and_beyond_is_the_direction_away_from_the_eye() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 37)
    for radius in (1.0, 1.2, 1.41):
        places = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        np.testing.assert_allclose(sphere_map_directions(places), np.tile([0.0, 0.0, -1.0], (37, 1)), atol=1e-7)
    # A step off that direction goes to the rim where the step goes: the map is torn open there.
    step = 1e-3
    beside = unit(np.column_stack([step * np.cos(turn), step * np.sin(turn), np.full(37, -1.0)]))
    np.testing.assert_allclose(sphere_map_places(beside), np.stack([np.cos(turn), np.sin(turn)], 1), atol=1e-6)


def test_axis_frames_are_right_handed_about_their_axis() -> None:
    for axis in (*random_directions(200), np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])):
        frame = axis_frame(axis)
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(frame) == pytest.approx(1.0)
        np.testing.assert_array_equal(frame[2], axis)


@pytest.mark.parametrize("radius", [1.0, 3.7, 1e4])
def test_a_point_on_the_ball_is_found_exactly(radius: float) -> None:
    """From points inside of a ball towards known points on it."""
    rng = np.random.default_rng(3)
    on_ball = radius * random_directions(5000, 4)
    inside = radius * rng.uniform(0.0, 1.0, (5000, 1)) ** (1 / 3) * random_directions(5000, 5)
    found = parallax_directions(inside, unit(on_ball - inside), radius)
    np.testing.assert_allclose(found, on_ball, atol=1e-11 * radius)


def test_from_the_center_and_of_an_endless_ball_it_is_the_plain_lookup() -> None:
    rays = random_directions(100)
    np.testing.assert_allclose(parallax_directions(np.zeros((100, 3)), rays, 2.5), 2.5 * rays, atol=1e-14)
    points = random_directions(100, 7)
    np.testing.assert_allclose(unit(parallax_directions(points, rays, 1e9)), rays, atol=1e-8)


def test_from_a_point_on_the_ball_outward_it_is_the_point() -> None:
    points = random_directions(100)
    np.testing.assert_allclose(parallax_directions(points, points, 1.0), points, atol=1e-7)


def test_solid_angles_fill_the_sphere() -> None:
    n = 64
    angles = texel_solid_angles(n) * (2.0 / n) ** 2
    assert 6.0 * angles.sum() == pytest.approx(4.0 * np.pi, rel=1e-4)
    assert angles.max() / angles.min() == pytest.approx(3.0**1.5, rel=0.1)


def test_radius_is_the_median_by_solid_angle() -> None:
    """Not by texels, of which corners of the faces have more for the same angle."""
    center = np.array([3.0, -1.0, 0.5])
    u = texel_directions(64)
    for cosine, expected in ((-0.05, 2.0), (0.05, 8.0)):
        distance = np.where(u @ unit(np.array([1.0, 2.0, -0.5])) > cosine, 2.0, 8.0)
        faces = np.concatenate([center + distance[..., None] * u, np.ones((*distance.shape, 1))], axis=-1)
        assert environment_radius(faces, center, 0.5) == pytest.approx(expected)
    # The middles of all faces: 60 percent of the angles, 44 of the texels.
    middle = np.abs(u).max(axis=-1) > 0.8
    assert middle.mean() < 0.45
    distance = np.where(middle, 2.0, 8.0)
    faces = np.concatenate([distance[..., None] * u, np.ones((*distance.shape, 1))], axis=-1)
    assert environment_radius(faces, np.zeros(3), 0.5) == pytest.approx(2.0)


def test_radius_holds_the_mirror_and_skips_the_background() -> None:
    u = texel_directions(16)
    faces = np.concatenate([5.0 * u, np.ones((6, 16, 16, 1))], axis=-1)
    assert environment_radius(faces, np.zeros(3), 7.0) == 7.0
    faces[1:, ..., 3] = 0.0
    faces[1:, ..., :3] = 0.0
    assert environment_radius(faces, np.zeros(3), 0.5) == pytest.approx(5.0)
    assert environment_radius(np.zeros((6, 16, 16, 4)), np.zeros(3), 0.5) == 0.0
