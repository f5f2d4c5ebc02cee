# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where lights belong: what is known of spheres and planes without our code."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.design.lights.goals import (
    aimed,
    background,
    illumination,
    outward,
    reflection,
    rim,
    upright,
)
from curvrefl.curvrefl_addon.design.lights.paths import MirrorPath, limited
from curvrefl.curvrefl_addon.optics.ray import reflect_ray
from curvrefl.curvrefl_addon.optics.shading_normal import reflecting_outward
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import unit
from curvrefl.curvrefl_addon.optics.surfaces.sphere import reflection_points


def periscope(length: float = np.inf) -> MirrorPath:
    """A line of sight along +X that two mirrors 2 m apart turn up and then back along -X."""
    first = reflect_ray(np.array([1.0, 0, 0]), np.zeros(3), np.array([-1.0, 0, 1]))
    second = reflect_ray(first.direction, np.array([0.0, 0, 2]), np.array([-1.0, 0, -1]))
    return MirrorPath((first, second), length, "wall" if np.isfinite(length) else "")


def test_distances_go_on_over_the_next_mirror() -> None:
    near, far = reflection(periscope(), 1.5), reflection(periscope(), 5.0)
    np.testing.assert_allclose(near.place, [0, 0, 1.5], atol=1e-12)
    np.testing.assert_allclose(far.place, [-3, 0, 2], atol=1e-12)
    np.testing.assert_allclose(near.shines, [0, 0, -1], atol=1e-12)
    np.testing.assert_allclose(far.shines, [1, 0, 0], atol=1e-12)
    assert (near.mirrors, far.mirrors) == (1, 2)
    np.testing.assert_allclose(background(periscope()).shines, [1, 0, 0], atol=1e-12)


def test_what_is_placed_stays_in_front() -> None:
    path = periscope(4.0)
    assert path.reach == pytest.approx(6.0)
    assert limited(3.0, path.reach, 0.5) == 3.0
    assert limited(9.0, path.reach, 0.5) == pytest.approx(0.95 * 6.0 - 0.5)
    assert limited(9.0, path.reach, 50.0) == 3.0
    assert limited(9.0, np.inf, 50.0) == 9.0


def test_a_sphere_shows_it_where_it_was_asked_for() -> None:
    eye, rng = np.array([0.4, -3.0, 0.7]), np.random.default_rng(5)
    for _ in range(50):
        point = unit(rng.normal(size=3))
        if (eye - point) @ point < 0.05:
            continue
        path = MirrorPath((reflect_ray(point - eye, point, point),), np.inf)
        goal = reflection(path, rng.uniform(0.05, 9.0))
        np.testing.assert_allclose(reflection_points(eye, goal.place[None], 1.0)[0], point, atol=1e-6)
        np.testing.assert_allclose(goal.place + goal.distance * goal.shines, point, atol=1e-12)


def test_light_over_a_plane_is_strongest_at_its_foot() -> None:
    goal = illumination(np.array([0.3, -0.2, 0.0]), np.array([0.0, 0, 1]), 0.7)
    grid = np.stack(np.meshgrid(*[np.linspace(-1, 1, 201)] * 2), -1).reshape(-1, 2)
    away = goal.place - np.column_stack([grid, np.zeros(len(grid))])
    light = away[:, 2] / np.linalg.norm(away, axis=1) ** 3
    np.testing.assert_allclose(grid[light.argmax()], [0.3, -0.2], atol=1e-9)


@pytest.mark.parametrize("width", [0.1, 0.3, 0.7])
def test_a_rim_is_brightest_at_the_edge_and_as_wide_as_asked_for(width: float) -> None:
    """On a unit sphere under parallel light, seen in parallel: the normal at an angle from the edge is known."""
    sight = np.array([0.0, 1, 0])
    goal = rim(np.array([1.0, 0, 0]), sight, np.array([0.9, -0.4, 0.1]), width, 1e3)
    across = outward(sight, np.array([0.9, -0.4, 0.1]))
    np.testing.assert_allclose(across, unit(np.array([0.9, 0, 0.1])), atol=1e-12)
    angles = np.linspace(0.0, 1.2, 121)
    normals = np.cos(angles)[:, None] * across - np.sin(angles)[:, None] * sight
    light = np.maximum(normals @ -goal.shines, 0.0)
    assert light.argmax() == 0 and light[0] == pytest.approx(np.sin(width))
    assert (light[angles > width + 1e-9] < 1e-9).all() and (light[angles < width - 0.011] > 0.0).all()
    mirrored = reflect_ray(sight, np.zeros(3), np.cos(0.5 * width) * across - np.sin(0.5 * width) * sight)
    np.testing.assert_allclose(mirrored.direction, -goal.shines, atol=1e-12)


def test_head_on_there_is_no_nearest_edge() -> None:
    with pytest.raises(ValueError, match="faces the eye"):
        outward(np.array([0.0, 1, 0]), np.array([0.0, -1, 0]))


def test_aiming_keeps_how_a_lamp_is_turned_against_the_vertical() -> None:
    rng = np.random.default_rng(3)
    for shines in unit(rng.normal(size=(20, 3))):
        turned = aimed(upright(unit(rng.normal(size=3))), shines)
        np.testing.assert_allclose(turned[:, 2], -shines, atol=1e-12)
        np.testing.assert_allclose(turned.T @ turned, np.eye(3), atol=1e-12)
        assert turned[2, 0] == pytest.approx(0.0, abs=1e-12) and turned[2, 1] >= 0.0
    roll = np.array([[np.cos(0.4), -np.sin(0.4), 0], [np.sin(0.4), np.cos(0.4), 0], [0, 0, 1.0]])
    start = upright(unit(np.array([1.0, 2, 0.5]))) @ roll
    np.testing.assert_allclose(aimed(start, -start[:, 2]), start, atol=1e-12)
    np.testing.assert_allclose(upright(np.array([0.0, 0, 1])), np.eye(3), atol=1e-12)


def test_raised_normals_mirror_out_of_the_facet() -> None:
    """And no others are changed."""
    rng = np.random.default_rng(8)
    facing = np.tile([0.0, 0, 1], (500, 1))
    to_eye = unit(rng.normal(size=(500, 3)) * (1, 1, 0.1)) * (1, 1, 1)
    to_eye[:, 2] = np.abs(to_eye[:, 2]) + 1e-3
    to_eye = unit(to_eye)
    bent = unit(facing + 0.9 * rng.normal(size=(500, 3)) * (1, 1, 0))
    raised = reflecting_outward(facing, to_eye, bent)
    np.testing.assert_allclose(np.linalg.norm(raised, axis=1), 1.0, atol=1e-9)

    def mirrored_height(normals: np.ndarray) -> np.ndarray:
        return (2.0 * np.einsum("ij,ij->i", normals, to_eye)[:, None] * normals - to_eye)[:, 2]

    least = np.minimum(0.9 * to_eye[:, 2], 0.01)
    was_fine = mirrored_height(bent) >= least
    assert was_fine.any() and not was_fine.all()
    assert (raised[was_fine] == bent[was_fine]).all()
    np.testing.assert_allclose(mirrored_height(raised)[~was_fine], least[~was_fine], atol=1e-9)
    # Only as far as needed, in the plane of the facet's normal and the bent one.
    across = np.einsum("ij,ij->i", np.cross(facing, bent), raised)
    np.testing.assert_allclose(across, 0.0, atol=1e-9)
