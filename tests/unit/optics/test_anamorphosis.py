# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed forms of anamorphoses: the shortest ways of light, and what others have published."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.anamorphosis import Turned, off_cone, off_cylinder, to_floor, to_wall
from curvrefl.curvrefl_addon.scene.arrays import Float64Array

EYE = np.array([0.2, -3.0, 2.5])
RADIUS, HEIGHT = 0.5, 1.2


def on_cylinder(turn: Float64Array, z: Float64Array) -> Float64Array:
    return np.stack([RADIUS * np.cos(turn), RADIUS * np.sin(turn), z], axis=-1)


def on_cone(turn: Float64Array, z: Float64Array) -> Float64Array:
    across = RADIUS * (1.0 - z / HEIGHT)
    return np.stack([across * np.cos(turn), across * np.sin(turn), z], axis=-1)


def seen(turned: Turned) -> int:
    return int(np.isfinite(turned[0][:, 0]).sum())


@pytest.mark.parametrize(
    ("surface", "reflect"),
    [
        (on_cylinder, lambda ways: off_cylinder(EYE, ways, RADIUS, HEIGHT)),
        (on_cone, lambda ways: off_cone(EYE, ways, RADIUS, HEIGHT)),
    ],
)
@pytest.mark.parametrize("end", [to_floor, lambda turned: to_wall(turned, 4.0)])
def test_light_takes_a_way_whose_length_is_stationary(
    surface: Callable[[Float64Array, Float64Array], Float64Array],
    reflect: Callable[[Float64Array], Turned],
    end: Callable[[Turned], Float64Array],
) -> None:
    """Fermat's principle, along both coordinates of the mirror about the point that was found."""
    turn, z = (item.ravel() for item in np.meshgrid(np.linspace(-2.2, -0.9, 12), np.linspace(0.1, 1.0, 9)))
    points = surface(turn, z)
    turned = reflect(points - EYE)
    np.testing.assert_allclose(turned[0], points, atol=1e-12)
    ends = end(turned)
    ends = ends[np.isfinite(ends[:, 0])]
    assert len(ends) > 12
    kept = np.isfinite(end(turned)[:, 0])
    turn, z = turn[kept], z[kept]

    def length(turn: Float64Array, z: Float64Array) -> Float64Array:
        point = surface(turn, z)
        return np.linalg.norm(point - EYE, axis=1) + np.linalg.norm(point - ends, axis=1)

    step = 1e-5
    for slope in (length(turn + step, z) - length(turn - step, z), length(turn, z + step) - length(turn, z - step)):
        np.testing.assert_allclose(slope / (2.0 * step), 0.0, atol=1e-7)


def test_cone_in_a_wall_seen_from_far_above() -> None:
    """E. Mahieu's formula for a cone of radius 1 in a cylinder (Wolfram Community 2018), whose eye is endlessly far."""
    height, wall = 1.57, 1.4
    random = np.random.default_rng(3)
    for x, y in random.uniform(-0.65, 0.65, (40, 2)).tolist():
        across = np.hypot(x, y)
        expected = [wall * x / across, wall * y / across]
        expected.append(height - height * across + (across - wall) / np.tan(2.0 * np.arctan(1.0 / height)))
        turned = off_cone(np.array([x, y, 9.0]), np.array([[0.0, 0.0, -1.0]]), 1.0, height)
        np.testing.assert_allclose(to_wall(turned, wall)[0], expected, atol=1e-12)


def test_in_its_middle_a_cylinder_is_a_plane_mirror() -> None:
    eye = np.array([0.0, -3.0, 2.0])
    ways = np.column_stack([np.zeros(20), np.full(20, 3.0), np.linspace(-1.9, -1.0, 20)])
    found = to_floor(off_cylinder(eye, ways, RADIUS))
    # (The image of the eye is as far behind the plane y = -RADIUS.)
    image = np.array([0.0, -2.0 * RADIUS + 3.0, 2.0])
    share = -image[2] / ways[:, 2]
    np.testing.assert_allclose(found, image + share[:, None] * (ways * [1.0, -1.0, 1.0]), atol=1e-12)


def test_what_misses_the_mirror_is_no_number() -> None:
    ways = np.array([[0.0, 1.0, 3.0], [3.0, 1.0, 0.0], [0.0, -1.0, 0.0]])
    for turned in (off_cylinder(EYE, ways, RADIUS, HEIGHT), off_cone(EYE, ways, RADIUS, HEIGHT)):
        assert seen(turned) == 0 and np.isnan(turned[1]).all()
        assert np.isnan(to_floor(turned)).all() and np.isnan(to_wall(turned, 4.0)).all()
    up = off_cylinder(np.array([0.0, -3.0, 0.5]), np.array([[0.0, 3.0, 0.2]]), RADIUS)
    assert seen(up) == 1 and np.isnan(to_floor(up)).all()
