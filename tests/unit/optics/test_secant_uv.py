# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The secant search in parameters: against the quartic on a sphere, and against points found by construction."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.solvers import secant_uv
from curvrefl.curvrefl_addon.optics.surfaces import sphere
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import texel_directions
from curvrefl.curvrefl_addon.optics.surfaces.parametric_surfaces import (
    EllipsoidMap,
    ParametricSample,
    ParametricSurface,
    SampledMap,
    TorusSection,
)
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Float64Array, unit

FOCAL = 660.0
"""Pixels: 480 rows at a 40 degree view"""
EYE = np.array([2.3, -2.9, 1.8, 1.0])
SURFACES = {"sphere": EllipsoidMap(), "ellipsoid": EllipsoidMap(1.0, 0.7, 0.5), "torus section": TorusSection()}


@dataclass
class Paraboloid:
    """z = -(x^2 + 2 y^2) over the unit square about the origin; keeps the parameters it was asked for."""

    asked: list[Float64Array] = field(default_factory=list)

    wraps = (False, False)
    is_open = True
    solid = None

    def sample(self, uv: Float64Array) -> ParametricSample:
        self.asked.append(uv.copy())
        x, y = (uv - 0.5).T
        zero, one = np.zeros_like(x), np.ones_like(x)
        du, dv = np.column_stack([one, zero, -2.0 * x]), np.column_stack([zero, one, -4.0 * y])
        return ParametricSample(np.column_stack([x, y, -(x**2) - 2.0 * y**2]), du, dv, unit(np.cross(du, dv)))

    def uv_of_direction(self, directions: Float64Array) -> Float64Array:
        return np.clip(0.5 + 0.4 * directions[:, :2], 0.0, 1.0)


def parameters(count: int, seed: int, margin: float = 0.2) -> np.ndarray:
    """Away from poles and borders."""
    return np.random.default_rng(seed).uniform(margin, 1.0 - margin, (count, 2))


def vertices_around(count: int, nearest: float, seed: int = 1) -> np.ndarray:
    """From `nearest` to ten radii off the unit sphere."""
    rng = np.random.default_rng(seed)
    return unit(rng.normal(size=(count, 3))) * (1.0 + 10 ** rng.uniform(np.log10(nearest), 1.0, count))[:, None]


def sampled(surface: ParametricSurface, size: int, flags: int) -> SampledMap:
    centers = (np.arange(size) + 0.5) / size
    v, u = np.meshgrid(centers, centers, indexing="ij")
    at = surface.sample(np.column_stack([u.ravel(), v.ravel()]))

    def packed(vectors: np.ndarray, component: int) -> np.ndarray:
        return np.column_stack([vectors, at.normal[:, component]]).reshape(size, size, 4).astype(np.float32)

    directions = texel_directions(64)
    uv = surface.uv_of_direction(directions.reshape(-1, 3))
    radius = np.zeros(len(uv)) if surface.solid is None else surface.solid.radius(directions.reshape(-1, 3))[0]
    cube = np.column_stack([radius, uv, np.full(len(uv), flags)]).reshape(6, 64, 64, 4).astype(np.float32)
    return SampledMap(packed(at.position, 0), packed(at.du, 1), packed(at.dv, 2), cube)


@pytest.mark.parametrize("name", SURFACES)
def test_tangents_are_the_derivatives(name: str) -> None:
    surface, uv, step = SURFACES[name], parameters(300, 2, 0.01), 1e-6
    at = surface.sample(uv)
    for tangent, offset in ((at.du, [step, 0.0]), (at.dv, [0.0, step])):
        difference = (surface.sample(uv + offset).position - surface.sample(uv - offset).position) / (2.0 * step)
        np.testing.assert_allclose(tangent, difference, atol=1e-8)
        np.testing.assert_allclose((tangent * at.normal).sum(axis=1), 0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(at.normal, axis=1), 1.0)


@pytest.mark.parametrize("w", [1.0, 0.0], ids=["perspective", "orthographic"])
def test_gradient_is_the_derivative_of_the_path(w: float) -> None:
    surface, uv, vertices, step = EllipsoidMap(1.0, 0.7, 0.5), parameters(300, 3), vertices_around(300, 0.1), 1e-6
    eye = EYE if w else np.append(unit(EYE[:3]), 0.0)

    def length(parameters_: np.ndarray) -> np.ndarray:
        p = surface.sample(parameters_).position
        to_eye = np.linalg.norm(eye[:3] - p, axis=1) if w else -p @ eye[:3]
        return to_eye + np.linalg.norm(vertices - p, axis=1)

    gradient = secant_uv.path_gradient(eye, vertices, surface.sample(uv))
    for axis in (0, 1):
        offset = step * np.eye(2)[axis]
        difference = (length(uv + offset) - length(uv - offset)) / (2.0 * step)
        np.testing.assert_allclose(gradient[:, axis], difference, atol=1e-7)


def test_directions_lead_to_their_points() -> None:
    directions = unit(np.random.default_rng(4).normal(size=(500, 3)))
    surface = EllipsoidMap(2.0, 1.0, 0.5)
    uv = surface.uv_of_direction(directions)
    assert (uv >= 0.0).all() and (uv <= 1.0).all()
    np.testing.assert_allclose(unit(surface.sample(uv).position), directions, atol=1e-12)


def test_sphere_against_the_quartic() -> None:
    """Free vertices and a camera that is not over a pole: five steps are good for a pixel or two, twelve for more."""
    vertices, screen = vertices_around(6000, 0.3), Screen(EYE, FOCAL)
    truth = sphere.reflection_points(EYE[:3], vertices, 1.0)
    reflects = np.isfinite(truth[:, 0])
    for steps, lost, median, p95 in ((5, 0.09, 1e-3, 2.0), (12, 0.06, 1e-5, 0.1)):
        found = secant_uv.solve(EllipsoidMap(), screen, vertices, steps)
        assert not (~reflects & (found.status == status.REFLECTED)).any()
        assert (found.status[~reflects] == status.HIDDEN).all()
        assert (found.status[reflects] != status.REFLECTED).mean() < lost
        both = reflects & (found.status == status.REFLECTED)
        error = np.linalg.norm(screen.pixels(truth[both], found.position[both] - truth[both]), axis=1)
        assert np.median(error) < median and np.percentile(error, 95) < p95
        assert found.iterations.max() <= steps
        np.testing.assert_allclose(np.linalg.norm(found.position, axis=1)[both], 1.0, atol=1e-12)


@pytest.mark.parametrize(("name", "least"), [("sphere", 0.95), ("ellipsoid", 0.8), ("torus section", 0.7)])
@pytest.mark.parametrize("w", [1.0, 0.0], ids=["perspective", "orthographic"])
def test_points_by_construction(name: str, least: float, w: float) -> None:
    """P is chosen, V laid on the reflected ray. On a torus the same vertex has other reflections: those count too."""
    surface = SURFACES[name]
    eye = EYE if w else np.append(unit(EYE[:3]), 0.0)
    at = surface.sample(parameters(4000, 5))
    to_eye = unit(eye[:3] - w * at.position)
    cosine = (to_eye * at.normal).sum(axis=1)
    seen = cosine > 0.3
    reflected = 2.0 * cosine[:, None] * at.normal - to_eye
    distance = np.random.default_rng(6).uniform(0.5, 5.0, len(seen))
    expected, vertices = at.position[seen], (at.position + distance[:, None] * reflected)[seen]
    screen = Screen(eye, FOCAL if w else FOCAL / 4.0)
    found = secant_uv.solve(surface, screen, vertices, 12)
    assert seen.sum() > 300
    solved = found.status == status.REFLECTED
    assert solved.mean() > least
    error = np.linalg.norm(screen.pixels(expected, found.position - expected), axis=1)
    if name == "torus section":
        h = unit(eye[:3] - w * found.position) + unit(vertices - found.position)
        sine = np.linalg.norm(np.cross(unit(h), found.normal), axis=1)
        assert np.percentile(sine[solved], 90) < 1e-3
        assert (error[solved] < 0.5).mean() > 0.5
    else:
        assert np.percentile(error[solved], 95) < 0.2


def test_each_step_replaces_the_farthest_corner() -> None:
    """The same triangle is followed here, one vertex at a time, from the points that the search asks for."""
    surface, eye = Paraboloid(), np.array([0.8, -0.3, 2.0, 1.0])
    vertex = np.array([[-0.4, 0.9, 1.2]])
    secant_uv.secant_search(surface, Screen(eye, FOCAL), vertex, 5, 0.0)
    asked = np.array(surface.asked).reshape(-1, 2)
    assert len(asked) == 3 + 5
    triangle = list(asked[:3])
    for new in asked[3:]:
        gradients = [secant_uv.path_gradient(eye, vertex, surface.sample(uv[None]))[0] for uv in triangle]
        matrix = np.column_stack([gradients[1] - gradients[0], gradients[2] - gradients[0]])
        alpha, beta = np.linalg.solve(matrix, -gradients[0])
        expected = (1.0 - alpha - beta) * triangle[0] + alpha * triangle[1] + beta * triangle[2]
        np.testing.assert_allclose(new, expected, atol=1e-9)
        triangle[int(np.argmax([np.linalg.norm(uv - new) for uv in triangle]))] = new


def test_linear_gradient_is_solved_in_one_step() -> None:
    """Eye and vertex far along the axis: the path's gradient is linear in u and v, and vanishes at the apex."""
    uv, iterations = secant_uv.secant_search(
        Paraboloid(), Screen(np.array([0.0, 0.0, 1.0, 0.0]), 1e4), np.array([[1.0, 2.0, 1e7]]), 1, 0.0
    )
    np.testing.assert_allclose(uv, [[0.5, 0.5]], atol=1e-5)
    assert iterations.tolist() == [1]


def test_small_triangles_end_the_search() -> None:
    eye, vertex = np.array([0.8, -0.3, 2.0, 1.0]), np.array([[-0.4, 0.9, 1.2]])
    coarse = secant_uv.secant_search(Paraboloid(), Screen(eye, FOCAL), vertex, 50, 1.0)[1]
    fine = secant_uv.secant_search(Paraboloid(), Screen(eye, FOCAL), vertex, 50, 1e-3)[1]
    assert 0 < coarse[0] < fine[0] < 20


def test_sheet_reflects_on_the_side_of_the_eye() -> None:
    for side in (1.0, -1.0):
        eye, vertex = np.array([0.3, 0.2, 4.0 * side, 1.0]), np.array([[0.1, -0.2, 3.0 * side]])
        found = secant_uv.solve(Paraboloid(), Screen(eye, FOCAL), vertex, 20)
        assert found.status.tolist() == [status.REFLECTED]
        assert found.normal[0, 2] * side > 0.5


def test_search_goes_over_the_seam() -> None:
    """Eye and vertex on both sides of the meridian where u is 0 and 1: the triangle is small, the point is between."""
    angles = np.radians([-12.0, 10.0])
    places = np.column_stack([np.cos(angles), np.sin(angles), [0.3, 0.2]])
    eye, vertex = np.append(4.0 * places[0], 1.0), 2.5 * places[1:]
    surface = EllipsoidMap()
    triangle = secant_uv.start_triangle(surface, eye, vertex)[0]
    assert np.ptp(triangle, axis=0).max() < 0.1
    found = secant_uv.solve(surface, Screen(eye, FOCAL), vertex, 8)
    np.testing.assert_allclose(found.position, sphere.reflection_points(eye[:3], vertex, 1.0), atol=1e-4)


def test_first_triangles_are_never_flat() -> None:
    vertices = np.concatenate(
        [vertices_around(2000, 0.01), 2.0 * EYE[None, :3], -2.0 * EYE[None, :3], np.zeros((1, 3))]
    )
    for surface in (*SURFACES.values(), sampled(EllipsoidMap(), 64, 1)):
        a, b, c = secant_uv.start_triangle(surface, EYE, vertices).transpose(1, 0, 2)
        (x1, y1), (x2, y2) = (b - a).T, (c - a).T
        # Beside a border that clamps, a corner may be cut off; what is left must still span the plane.
        assert (np.abs(x1 * y2 - x2 * y1) > 1e-5).all()
        assert (a[:, 1] >= 0.0).all() if not surface.wraps[1] else True


def test_gradient_in_u_vanishes_at_a_pole() -> None:
    """The paper's artifact is there: over a pole many vertices are lost, but none is shown in a wrong place."""
    pole = EllipsoidMap().sample(np.array([[0.3, 1.0]]))
    gradient = secant_uv.path_gradient(EYE, np.array([[3.0, 1.0, 2.0]]), pole)
    assert abs(gradient[0, 0]) < 1e-12 and abs(gradient[0, 1]) > 0.1
    eye, vertices = np.array([0.3, -0.2, 4.0, 1.0]), vertices_around(3000, 0.3)
    truth = sphere.reflection_points(eye[:3], vertices, 1.0)
    found = secant_uv.solve(EllipsoidMap(), Screen(eye, FOCAL), vertices)
    reflects, solved = np.isfinite(truth[:, 0]), found.status == status.REFLECTED
    assert (reflects & ~solved).sum() > 0.2 * reflects.sum()
    assert np.linalg.norm(found.position - truth, axis=1)[reflects & solved].max() < 0.2
    assert not (solved & ~reflects).any()


def test_hidden_vertices_lie_where_the_sight_enters() -> None:
    behind = -unit(EYE[None, :3]) * np.array([[1.5], [3.0], [8.0]]) + np.array([[0.1, 0.2, 0.0]])
    inside = np.array([[0.2, 0.1, -0.3], [0.0, 0.0, 0.0]])
    vertices = np.concatenate([behind, inside])
    surface = EllipsoidMap()
    for tried in (surface, sampled(surface, 512, 1)):
        found = secant_uv.solve(tried, Screen(EYE, FOCAL), vertices)
        assert (found.status == status.HIDDEN).all()
        along, sight = found.position - EYE[:3], unit(vertices - EYE[:3])
        np.testing.assert_allclose(np.cross(along, sight), 0.0, atol=1e-6)
        np.testing.assert_allclose(found.position, found.normal, atol=2e-3)
        assert ((found.normal * sight).sum(axis=1) < 0.0).all()


def test_sampled_map_is_the_surface() -> None:
    """Between texels and over the seam."""
    uv = np.column_stack([np.linspace(-1.3, 2.1, 500), np.random.default_rng(8).uniform(0.05, 0.95, 500)])
    for surface, flags in ((EllipsoidMap(1.0, 0.7, 0.5), 1), (TorusSection(angle=2.0 * np.pi), 2)):
        textures = sampled(surface, 256, flags)
        asked = uv if flags == 1 else uv[:, ::-1]
        one, other = textures.sample(asked), surface.sample(asked)
        np.testing.assert_allclose(one.position, other.position, atol=1e-3)
        np.testing.assert_allclose(one.du, other.du, atol=1e-2)
        np.testing.assert_allclose(one.dv, other.dv, atol=1e-2)
        np.testing.assert_allclose(one.normal, other.normal, atol=1e-3)
    assert textures.wraps == (False, True) and not textures.is_open and textures.solid is None


def test_any_input_ends_with_a_code_and_finite_points() -> None:
    rng = np.random.default_rng(9)
    vertices = rng.normal(size=(3000, 3)) * 10.0 ** rng.uniform(-9, 9, (3000, 1))
    vertices[0], vertices[1] = 0.0, EYE[:3]
    surfaces = (*SURFACES.values(), EllipsoidMap(1e-3, 1.0, 1e3), sampled(EllipsoidMap(), 64, 1))
    for surface in surfaces:
        for eye in (EYE, np.array([0.0, 0.0, 1.0, 0.0]), np.array([0.0, 0.1, 0.0, 1.0])):
            found = secant_uv.solve(surface, Screen(eye, FOCAL), vertices)
            assert np.isfinite(found.position).all() and np.isfinite(found.normal).all()
            assert set(found.status) <= {status.REFLECTED, status.HIDDEN, status.UNSOLVED}
