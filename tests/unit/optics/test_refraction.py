# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Snell's law, refraction points in closed form, and the search for them: each against what it was made from."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import fermat, status
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.snell import is_refraction_side, refracted, transmittance
from curvrefl.curvrefl_addon.optics.solvers import newton_refraction, refraction_start
from curvrefl.curvrefl_addon.optics.solvers.descent import path_change, second_derivative, tangent_frame
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, RadialSurface, unit
from curvrefl.curvrefl_addon.optics.surfaces.refraction import plane_points, sphere_points
from hypothesis import given, settings
from hypothesis import strategies as st

SHAPES = {
    "sphere": lambda scale: Ellipsoid(scale, scale, scale),
    "ellipsoid": lambda scale: Ellipsoid(scale, 0.6 * scale, 0.4 * scale),
    "bumpy": lambda scale: Bumpy(0.1, scale),
}
EYE = np.array([2.3, -2.9, 1.8])
INDICES = (1.01, 1.33, 1.5, 2.4, 3.0, 1.0 / 1.01, 1.0 / 1.5, 1.0 / 3.0)


def made(
    surface: RadialSurface,
    eye: np.ndarray,
    index: float,
    side: float,
    count: int,
    seed: int,
    least_cosine: float = 1e-3,
) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) on refracted lines of sight, a thousandth to ten radii beyond, and the points (n, 3) there."""
    random = np.random.default_rng(seed)
    at = fermat.sample(surface, unit(random.normal(size=(count, 3))))
    to_eye, normal = fermat.towards_eye(eye, at.position), side * at.normal
    ray = refracted(to_eye, normal, index)
    kept = (np.einsum("ij,ij->i", to_eye, normal) > least_cosine) & np.isfinite(ray[:, 0])
    distance = surface.bound * 10 ** random.uniform(-3, 1, count)
    return (at.position + distance[:, None] * ray)[kept], at.position[kept]


@pytest.mark.parametrize("index", INDICES)
def test_snells_law(index: float) -> None:
    random = np.random.default_rng(0)
    normal, to_eye = unit(random.normal(size=(2, 2000, 3)))
    to_eye *= np.sign(np.einsum("ij,ij->i", normal, to_eye))[:, None]
    ray = refracted(to_eye, normal, index)
    sine = np.linalg.norm(np.cross(normal, to_eye), axis=1)
    passes = sine < index
    np.testing.assert_array_equal(np.isfinite(ray).all(axis=1), passes)
    ray, normal, to_eye = ray[passes], normal[passes], to_eye[passes]
    np.testing.assert_allclose(np.linalg.norm(ray, axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(index * np.cross(normal, ray), -np.cross(normal, to_eye), atol=1e-12)
    assert (np.einsum("ij,ij->i", normal, ray) <= 0.0).all()
    # The way back is the same way.
    back = refracted(ray, -normal, 1.0 / index)
    steep = np.einsum("ij,ij->i", normal, to_eye) > 1e-3
    np.testing.assert_allclose(back[steep], to_eye[steep], atol=1e-9)


def test_transmittance_is_what_reflection_leaves() -> None:
    assert transmittance(np.array([1.0]), 1.5)[0] == pytest.approx(0.96)
    np.testing.assert_allclose(transmittance(np.array([1.0, 0.5, 0.1, 0.0]), 1.0), [1.0, 1.0, 1.0, 0.0], atol=1e-12)
    # As much goes in as comes out, and nothing beyond the critical angle.
    outside = np.linspace(0.01, 1.0, 50)
    inside = np.sqrt(1.0 - (1.0 - outside**2) / 1.5**2)
    np.testing.assert_allclose(transmittance(outside, 1.5), transmittance(inside, 1.0 / 1.5), rtol=1e-9)
    assert (transmittance(np.linspace(0.0, np.sqrt(1.0 - 1.0 / 1.5**2) - 1e-9, 20), 1.0 / 1.5) == 0.0).all()


def test_points_on_a_plane_are_those_the_vertices_are_made_from() -> None:
    random = np.random.default_rng(1)
    count = 20_000
    points = np.column_stack([random.normal(size=(count, 2)), np.zeros(count)])
    eyes = np.column_stack([random.normal(size=(count, 2)), 10 ** random.uniform(-2, 2, count), np.ones(count)])
    at_infinity = random.random(count) < 0.2
    eyes[at_infinity, :3] = unit(eyes[at_infinity, :3])
    eyes[at_infinity, 3] = 0.0
    index = 3.0 ** random.uniform(-1.0, 1.0, count)
    up = np.tile([0.0, 0.0, 1.0], (count, 1))
    ray = refracted(fermat.towards_eye(eyes, points), up, index[:, None])
    passes = np.isfinite(ray[:, 0])
    vertices = points + 10 ** random.uniform(-3, 1, count)[:, None] * ray
    found = plane_points(eyes[passes], vertices[passes], index[passes])
    size = np.linalg.norm(vertices, axis=1)[passes] + 1.0
    assert (np.linalg.norm(found - points[passes], axis=1) / size).max() < 1e-11
    assert np.isnan(plane_points(eyes[0], -vertices[passes][:5], 1.5)).all()


@pytest.mark.parametrize("side", [1.0, -1.0], ids=["eye outside", "eye inside"])
def test_points_on_a_sphere_are_those_the_vertices_are_made_from(side: float) -> None:
    random = np.random.default_rng(2)
    for index in INDICES:
        for radius in (1e-3, 1.0, 1e3):
            direction = unit(random.normal(size=(1, 3)))[0]
            height = 10 ** random.uniform(-2, 2) if side > 0.0 else -random.uniform(0.02, 1.0)
            for eye in (np.append(radius * (1.0 + height) * direction, 1.0), np.append(direction, 0.0)):
                if side < 0.0 and eye[3] == 0.0:
                    continue
                vertices, points = made(Ellipsoid(radius, radius, radius), eye, index, side, 500, 3)
                if len(vertices) == 0:
                    continue
                found = sphere_points(eye, vertices, radius, index, side)
                off = np.linalg.norm(found - points[:, None], axis=2)
                assert np.nanmin(off, axis=1).max() < 1e-9 * radius
                # All of them obey Snell's law, and are no copies.
                rows, number = np.nonzero(np.isfinite(found[..., 0]))
                at = fermat.sample(Ellipsoid(radius, radius, radius), unit(found[rows, number]))
                assert is_refraction_side(eye, vertices[rows], at, side).all()
                g = fermat.path_gradient(eye, vertices[rows], unit(found[rows, number]), at, index)
                assert np.linalg.norm(g, axis=1).max() < 1e-8 * radius * (1.0 + index)


def test_a_vertex_at_the_center_or_on_the_axis_is_seen_straight() -> None:
    eye = np.array([0.0, 0.0, 3.0, 1.0])
    found = sphere_points(eye, np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.3], [0.0, 0.0, -0.9]]), 1.0, 1.5)
    np.testing.assert_allclose(found[:, 0], np.tile([0.0, 0.0, 1.0], (3, 1)), atol=1e-12)
    assert np.isnan(found[:, 1:]).all()


def test_the_focus_parts_shortest_paths_from_longest_ones() -> None:
    """On the axis: 1 / s1 + n / s2 over (n - 1) / R before the focus, and under it behind (docs/methods.md)."""
    surface, index = Ellipsoid(), 1.5
    top = np.array([[0.0, 0.0, 1.0]])
    for s1 in (0.5, 2.0, 10.0):
        eye = np.array([0.0, 0.0, 1.0 + s1, 1.0])
        for s2 in (0.3, 1.9, 2.5, 4.0, 20.0):
            vertex = np.array([[0.0, 0.0, 1.0 - s2]])
            at = fermat.sample(surface, top)
            xx, xy, yy = second_derivative(surface, eye, vertex, top, at, tangent_frame(top), index)
            expected = 1.0 / s1 + index / s2 - (index - 1.0)
            np.testing.assert_allclose([xx[0], yy[0]], expected, rtol=1e-3)
            assert abs(xy[0]) < 1e-9


@pytest.mark.parametrize("index", [1.0 / 1.5, 1.5, 3.0])
def test_derivatives_are_those_of_the_path(index: float) -> None:
    surface = Bumpy(0.2)
    eye = np.append(EYE, 1.0)
    random = np.random.default_rng(4)
    u, vertices = unit(random.normal(size=(200, 3))), random.normal(size=(200, 3))
    at = fermat.sample(surface, u)
    frame = tangent_frame(u)
    g = fermat.path_gradient(eye, vertices, u, at, index)
    xx, _, _ = second_derivative(surface, eye, vertices, u, at, frame, index)
    step = 1e-5
    moved = [unit(u + sign * step * frame[0]) for sign in (1.0, -1.0)]
    there = [fermat.sample(surface, here) for here in moved]
    change = path_change(eye, vertices, there[1].position, there[0].position, index) / (2.0 * step)
    np.testing.assert_allclose(change, np.einsum("ij,ij->i", g, frame[0]), atol=1e-8)
    slopes = [
        np.einsum("ij,ij->i", fermat.path_gradient(eye, vertices, here, point, index), frame[0])
        for here, point in zip(moved, there, strict=True)
    ]
    # The method's own second derivative has that of the radius from a longer difference.
    np.testing.assert_allclose((slopes[0] - slopes[1]) / (2.0 * step), xx, atol=0.03 * (1.0 + index))


@given(
    index=st.floats(1.01, 3.0),
    inverse=st.booleans(),
    scale=st.sampled_from([1e-3, 1.0, 1e3]),
    shape=st.sampled_from(sorted(SHAPES)),
    inside=st.booleans(),
    seed=st.integers(0, 10_000),
)
@settings(max_examples=30, deadline=None)
def test_what_is_made_is_found(index: float, inverse: bool, scale: float, shape: str, inside: bool, seed: int) -> None:
    """Whatever is found obeys Snell's law, and next to nothing is not found."""
    surface = SHAPES[shape](scale)
    index = 1.0 / index if inverse else index
    side = -1.0 if inside else 1.0
    eye = np.append(scale * (np.array([0.1, -0.05, 0.08]) if inside else EYE), 1.0)
    vertices, _ = made(surface, eye, index, side, 600, seed, least_cosine=0.05)
    if len(vertices) == 0:
        return
    screen = Screen(eye, 800.0)
    solution, _ = newton_refraction.solve(surface, screen, vertices, index, side=side)
    found = solution.status == status.REFLECTED
    # On the thin ellipsoid some vertices far behind the focus are lost.
    assert (~found).mean() <= 0.02, (~found).mean()
    at = fermat.SurfaceSample(
        solution.at.position[found], solution.at.normal[found], solution.at.radius[found], solution.at.gradient[found]
    )
    assert is_refraction_side(eye, vertices[found], at, side).all()
    # A Newton step of the reference from there is under the tolerance.
    again, _ = newton_refraction.solve(surface, screen, vertices[found], index, solution.u[found], 1e-3, side)
    off = np.linalg.norm(screen.pixels(at.position, again.at.position - at.position), axis=1)
    assert np.percentile(off, 99) < 0.05


@pytest.mark.parametrize("index", [1.0, 1.0 + 1e-9])
def test_glass_of_index_1_bends_nothing(index: float) -> None:
    surface = Ellipsoid(1.0, 0.6, 0.4)
    eye = np.append(EYE, 1.0)
    vertices, points = made(surface, eye, index, 1.0, 500, 5, least_cosine=0.05)
    solution, _ = newton_refraction.solve(surface, Screen(eye, 800.0), vertices, index)
    assert (solution.status == status.REFLECTED).all()
    assert np.linalg.norm(solution.at.position - points, axis=1).max() < 1e-3


@pytest.mark.parametrize("index", [0.0, -1.5, 1e-30, 1000.0, 1e30, np.inf])
def test_an_index_out_of_range_is_taken_to_its_end(index: float) -> None:
    """And whatever it is no point is NaN."""
    eye = np.append(EYE, 1.0)
    vertices = np.random.default_rng(6).normal(size=(300, 3))
    solution, _ = newton_refraction.solve(Bumpy(0.1), Screen(eye, 800.0), vertices, index)
    assert np.isfinite(solution.at.position).all()
    assert set(solution.status) <= {status.REFLECTED, status.HIDDEN, status.UNSOLVED}


def test_an_index_that_is_no_number_is_refused() -> None:
    with pytest.raises(ValueError, match="index"):
        newton_refraction.solve(Ellipsoid(), Screen(np.append(EYE, 1.0), 800.0), np.zeros((1, 3)), np.nan)


def test_every_rung_finds_something() -> None:
    """From one step of the first pass on, each rung alone."""
    surface = Ellipsoid(1.0, 0.5, 0.25)
    eye = np.append(EYE, 1.0)
    vertices, _ = made(surface, eye, 2.4, 1.0, 2000, 8)
    settled = set()
    for rung in range(refraction_start.RUNG_COUNT):
        solution, where = newton_refraction.solve(
            surface, Screen(eye, 800.0), vertices, 2.4, first_steps=1, first_rung=rung
        )
        settled |= set(where[solution.status == status.REFLECTED])
    assert settled == {newton_refraction.FIRST_PASS, *range(refraction_start.RUNG_COUNT)}


def test_a_vertex_before_the_glass_is_hidden() -> None:
    eye = np.append(EYE, 1.0)
    vertices = np.array([0.6 * EYE, 0.4 * EYE, 2.0 * EYE])
    solution, _ = newton_refraction.solve(Ellipsoid(), Screen(eye, 800.0), vertices, 1.5)
    assert (solution.status == status.HIDDEN).all()
