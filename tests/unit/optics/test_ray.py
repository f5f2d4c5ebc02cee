# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The ray and its way back: what is placed on a reflected ray is found by the solver at the same point."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.ray import reflect_ray
from curvrefl.curvrefl_addon.optics.surfaces.sphere import reflection_points


def test_head_on_goes_back() -> None:
    ray = reflect_ray(np.array([0.0, 2.0, 0.0]), np.array([1.0, 2.0, 3.0]), np.array([0.0, 5.0, 0.0]))
    np.testing.assert_allclose(ray.direction, [0, -1, 0])
    np.testing.assert_allclose(ray.normal, [0, -1, 0])
    assert ray.incidence == 0.0
    np.testing.assert_allclose(ray.at(2.0), [1, 0, 3])


def test_angles_are_equal() -> None:
    rng = np.random.default_rng(1)
    for incoming, normal in rng.normal(size=(50, 2, 3)):
        ray = reflect_ray(incoming, np.zeros(3), normal)
        assert np.linalg.norm(ray.direction) == pytest.approx(1.0)
        assert ray.direction @ ray.normal == pytest.approx(np.cos(ray.incidence))
        assert -incoming @ ray.normal / np.linalg.norm(incoming) == pytest.approx(np.cos(ray.incidence))
        assert np.linalg.det([incoming, ray.direction, ray.normal]) == pytest.approx(0.0, abs=1e-12)


def test_a_vertex_on_the_reflected_ray_is_reflected_there() -> None:
    rng = np.random.default_rng(2)
    eye = np.array([0.5, -3.0, 1.0])
    for _ in range(50):
        # A point of the unit sphere on the side of the eye.
        point = rng.normal(size=3)
        point /= np.linalg.norm(point)
        if (eye - point) @ point < 0.05:
            continue
        vertex = reflect_ray(point - eye, point, point).at(rng.uniform(0.01, 20.0))
        np.testing.assert_allclose(reflection_points(eye, vertex[None], 1.0)[0], point, atol=1e-6)


@pytest.mark.parametrize(
    ("incoming", "normal"), [([0, 0, 0], [0, 0, 1]), ([1, 0, 0], [0, 0, 0]), ([np.nan, 0, 0], [0, 0, 1])]
)
def test_no_direction_is_an_error(incoming: list[float], normal: list[float]) -> None:
    with pytest.raises(ValueError, match="direction"):
        reflect_ray(np.array(incoming, float), np.zeros(3), np.array(normal, float))
