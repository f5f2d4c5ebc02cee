# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The float64 optics against closed forms and against each other."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import fermat, status
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.solvers import descent, secant_star
from curvrefl.curvrefl_addon.optics.solvers.pierce import pierce
from curvrefl.curvrefl_addon.optics.surfaces import sphere
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, RadialSurface, unit
from hypothesis import example, given, settings
from hypothesis import strategies as st

SURFACES = {"sphere": Ellipsoid(), "ellipsoid": Ellipsoid(1.0, 0.5, 0.25), "bumpy": Bumpy(0.15)}
FOCAL = 660.0
"""Pixels: 480 rows at a 40 degree view"""


def directions(count: int, seed: int) -> np.ndarray:
    return unit(np.random.default_rng(seed).normal(size=(count, 3)))


def around(surface: RadialSurface, count: int, seed: int, nearest: float = 1e-2) -> np.ndarray:
    """Vertices from contact to ten radii off the surface."""
    rng = np.random.default_rng(seed)
    u = unit(rng.normal(size=(count, 3)))
    return u * (surface.radius(u)[0] + 10 ** rng.uniform(np.log10(nearest), 1, count))[:, None]


def eye_at(distance: float, seed: int) -> np.ndarray:
    return np.append(distance * directions(1, seed)[0], 1.0)


@pytest.mark.parametrize("name", SURFACES)
def test_gradient_of_radius_is_the_derivative(name: str) -> None:
    surface, u = SURFACES[name], directions(500, 1)
    first, second = descent.tangent_frame(u)
    _, gradient = surface.radius(u)
    for tangent in (first, second):
        step = 1e-6
        difference = (surface.radius(unit(u + step * tangent))[0] - surface.radius(unit(u - step * tangent))[0]) / (
            2 * step
        )
        np.testing.assert_allclose((gradient * tangent).sum(1), difference, atol=1e-8)


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("w", [1.0, 0.0])
def test_path_gradient_is_the_derivative_of_the_path(name: str, w: float) -> None:
    surface, u, vertices = SURFACES[name], directions(500, 2), around(SURFACES[name], 500, 3)
    eye = eye_at(4.0, 4) if w else np.append(unit(np.array([1.0, 2.0, 3.0])), 0.0)
    gradient = fermat.path_gradient(eye, vertices, u, fermat.sample(surface, u))
    for tangent in descent.tangent_frame(u):
        step = 1e-5
        ahead, behind = (fermat.sample(surface, unit(u + sign * step * tangent)).position for sign in (1, -1))
        difference = descent.path_change(eye, vertices, behind, ahead) / (2 * step)
        np.testing.assert_allclose((gradient * tangent).sum(1), difference, rtol=1e-5, atol=2e-4)


def test_path_change_equals_the_difference_of_lengths() -> None:
    eye, vertices = eye_at(5.0, 1), around(Ellipsoid(), 100, 2)
    start, end = directions(100, 3), directions(100, 4)

    def length(p: np.ndarray) -> np.ndarray:
        return np.linalg.norm(eye[:3] - p, axis=1) + np.linalg.norm(vertices - p, axis=1)

    np.testing.assert_allclose(descent.path_change(eye, vertices, start, end), length(end) - length(start), atol=1e-12)


@given(distance=st.floats(1.01, 100.0), scale=st.floats(1e-3, 1e3), seed=st.integers(0, 10_000))
@settings(max_examples=40, deadline=None)
def test_quartic_reflects(distance: float, scale: float, seed: int) -> None:
    """Its points lie on the sphere, obey the mirror law, and exist exactly for vertices that are not hidden."""
    eye = scale * distance * directions(1, seed)[0]
    vertices = scale * around(Ellipsoid(), 200, seed + 1, 1e-4)
    points = sphere.reflection_points(eye, vertices, scale)
    found = np.isfinite(points[:, 0])
    p = points[found]
    np.testing.assert_allclose(np.linalg.norm(p, axis=1), scale, rtol=1e-9)
    to_eye, to_vertex, normal = unit(eye - p), unit(vertices[found] - p), p / scale
    np.testing.assert_allclose((to_eye * normal).sum(1), (to_vertex * normal).sum(1), atol=1e-6)
    # The tangent cone of the eye: the segment misses the sphere exactly where there is a reflection.
    segment = vertices - eye
    along = np.clip(-(segment @ eye) / (segment**2).sum(1), 0.0, 1.0)
    closest = np.linalg.norm(eye + along[:, None] * segment, axis=1) / scale
    assert (found == (closest > 1.0))[np.abs(closest - 1.0) > 1e-6].all()


@given(distance=st.floats(1.05, 50.0), seed=st.integers(0, 10_000))
@example(distance=1.05078125, seed=2989)
@settings(max_examples=25, deadline=None)
def test_secant_star_finds_the_quartics_point(distance: float, seed: int) -> None:
    eye = eye_at(distance, seed)
    # The mirror is 200 pixels in radius whatever the distance, as a user would frame it.
    screen = Screen(eye, 200.0 * distance)
    vertices = around(Ellipsoid(), 400, seed + 1)
    truth = sphere.reflection_points(eye[:3], vertices, 1.0)
    solution = secant_star.solve(Ellipsoid(), screen, vertices)
    reflected = solution.status == status.REFLECTED
    expected = np.isfinite(truth[:, 0])
    assert not (reflected & ~expected).any(), "a hidden vertex was called reflected"
    assert (expected & ~reflected).mean() <= 0.01
    both = reflected & expected
    error = np.linalg.norm(screen.pixels(truth[both], solution.at.position[both] - truth[both]), axis=1)
    assert error.max() < 0.1


@pytest.mark.parametrize("name", ["ellipsoid", "bumpy"])
@pytest.mark.parametrize("distance", [1.3, 4.0, 30.0])
def test_secant_star_converges(name: str, distance: float) -> None:
    """At most 1 percent unconverged; what it calls reflected obeys the mirror law."""
    surface = SURFACES[name]
    eye = eye_at(distance, 5)
    screen = Screen(eye, 200.0 * distance)
    solution = secant_star.solve(surface, screen, around(surface, 5000, 6))
    assert (solution.status == status.UNSOLVED).mean() <= 0.005
    reflected = solution.status == status.REFLECTED
    assert reflected.mean() > 0.3
    at = fermat.sample(surface, solution.u[reflected])
    vertices = around(surface, 5000, 6)[reflected]
    assert fermat.is_reflection_side(eye, vertices, at).all()
    error = fermat.mirror_error(eye, vertices, at)
    assert np.median(error) < 1e-5
    assert np.percentile(error, 99) < 2e-3
    assert solution.iterations[reflected].mean() < 13


def test_orthographic_eye_is_the_limit_of_a_far_one() -> None:
    surface, vertices = SURFACES["ellipsoid"], around(SURFACES["ellipsoid"], 1000, 8)
    axis = unit(np.array([1.0, -2.0, 0.7]))
    far = secant_star.solve(surface, Screen(np.append(1e6 * axis, 1.0), 2e8), vertices)
    infinite = secant_star.solve(surface, Screen(np.append(axis, 0.0), 200.0), vertices)
    assert (far.status == infinite.status).mean() > 0.998
    both = (far.status == status.REFLECTED) & (infinite.status == status.REFLECTED)
    assert np.linalg.norm(far.at.position - infinite.at.position, axis=1)[both].max() < 1e-3


@pytest.mark.parametrize("name", SURFACES)
def test_vertices_on_the_axis_and_at_special_directions(name: str) -> None:
    """Vertex straight ahead of the eye, straight behind, at poles, cube-map corners and edges."""
    surface = SURFACES[name]
    eye = np.array([0.0, 0.0, 4.0, 1.0])
    u = unit(np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [1, 1, 1], [1, 1, 0], [-1, 1, -1], [0, 1e-9, 1]], float))
    vertices = 2.0 * u
    solution = secant_star.solve(surface, Screen(eye, 800.0), vertices)
    assert np.isfinite(solution.at.position).all()
    assert solution.status[1] == status.HIDDEN
    assert (solution.status != status.UNSOLVED).all()
    if name == "sphere":
        np.testing.assert_allclose(solution.at.position[0], [0, 0, 1], atol=1e-4)


def test_pierce_finds_the_near_side() -> None:
    found, point = pierce(Ellipsoid(), np.array([0.0, 0.0, 5.0, 1.0]), np.array([[0.0, 0.0, -3.0], [0.0, 3.0, 0.0]]))
    assert found.tolist() == [True, False]
    np.testing.assert_allclose(point[0], [0, 0, 1], atol=1e-4)


def test_eye_at_infinity_pierces() -> None:
    found, point = pierce(Ellipsoid(), np.array([0.0, 0.0, 1.0, 0.0]), np.array([[0.3, 0.0, -3.0], [1.5, 0.0, -3.0]]))
    assert found.tolist() == [True, False]
    np.testing.assert_allclose(point[0], [0.3, 0, np.sqrt(1 - 0.09)], atol=1e-4)


@given(scale=st.sampled_from([1e-4, 1.0, 1e4]), seed=st.integers(0, 1000))
@settings(max_examples=10, deadline=None)
def test_scale_does_not_matter(scale: float, seed: int) -> None:
    vertices, eye = around(Ellipsoid(1, 0.5, 0.25), 300, seed), eye_at(4.0, seed)
    one = secant_star.solve(Ellipsoid(1, 0.5, 0.25), Screen(eye, FOCAL), vertices)
    scaled_eye = np.append(scale * eye[:3], 1.0)
    scaled_surface = Ellipsoid(scale, 0.5 * scale, 0.25 * scale)
    other = secant_star.solve(scaled_surface, Screen(scaled_eye, FOCAL), scale * vertices)
    assert (one.status == other.status).mean() > 0.99
    both = (one.status == status.REFLECTED) & (other.status == status.REFLECTED)
    error = np.linalg.norm(one.at.position - other.at.position / scale, axis=1)[both]
    assert np.percentile(error, 99) < 1e-3
