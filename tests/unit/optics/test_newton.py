# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The method `newton` in float64: right or unsolved, in few steps, from any start of its ladder."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import fermat, status
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.solvers import descent, newton
from curvrefl.curvrefl_addon.optics.solvers.pierce import pierce
from curvrefl.curvrefl_addon.optics.surfaces import sphere
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface, texel_directions
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, RadialSurface, unit
from curvrefl.curvrefl_addon.study.solvers.regimes import make_cases
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import STUDIES
from hypothesis import given, settings
from hypothesis import strategies as st

SURFACES = {
    "sphere": Ellipsoid(),
    "flat ellipsoid": Ellipsoid(1.0, 0.5, 0.25),
    "ellipsoid": Ellipsoid(1.0, 0.6, 0.4),
    "mild bumps": Bumpy(0.03),
}


def around(surface: RadialSurface, count: int, seed: int, nearest: float = 1e-3) -> np.ndarray:
    """Vertices from contact to ten radii off the surface."""
    random = np.random.default_rng(seed)
    u = unit(random.normal(size=(count, 3)))
    return u * (surface.radius(u)[0] + surface.bound * 10 ** random.uniform(np.log10(nearest), 1, count))[:, None]


def eye_over(surface: RadialSurface, height: float, seed: int) -> np.ndarray:
    """An eye `height` bounding radii over a random point."""
    u = unit(np.random.default_rng(seed).normal(size=(1, 3)))
    return np.append((surface.radius(u)[0][0] + height * surface.bound) * u[0], 1.0)


def coarse_map(surface: RadialSurface, texels: int) -> CubeMapSurface:
    at = fermat.sample(surface, texel_directions(texels).reshape(-1, 3))
    return CubeMapSurface(np.column_stack([at.radius, at.gradient]).reshape(6, texels, texels, 4))


@given(height=st.floats(1e-2, 50.0), scale=st.sampled_from([1e-4, 1.0, 1e4]), seed=st.integers(0, 10_000))
@settings(max_examples=30, deadline=None)
def test_finds_the_quartics_point(height: float, scale: float, seed: int) -> None:
    surface = Ellipsoid(scale, scale, scale)
    eye = eye_over(surface, height, seed)
    screen = Screen(eye, 200.0 * max(height, 0.1))
    vertices = around(surface, 400, seed + 1)
    truth = sphere.reflection_points(eye[:3], vertices, scale)
    solution, _ = newton.solve(surface, screen, vertices)
    expected = np.isfinite(truth[:, 0])
    reflected = solution.status == status.REFLECTED
    assert (solution.status != status.UNSOLVED).all()
    # On the horizon itself both answers are right, with the point in its place.
    at = solution.at
    cosine = np.einsum("ij,ij->i", at.normal, fermat.towards_eye(eye, at.position))
    assert (reflected == expected)[np.abs(cosine) > 1e-2].all()
    both = expected
    assert np.linalg.norm(screen.pixels(truth[both], at.position[both] - truth[both]), axis=1).max() < 0.05
    assert solution.iterations[both].mean() < 1.5


@pytest.mark.parametrize("height", [0.03, 3.0, 30.0])
@pytest.mark.parametrize("name", SURFACES)
def test_convex_mirrors_in_few_steps(name: str, height: float) -> None:
    surface = SURFACES[name]
    eye = eye_over(surface, height, 3)
    vertices = around(surface, 4000, 4)
    solution, _ = newton.solve(surface, Screen(eye, 660.0), vertices)
    reflected = solution.status == status.REFLECTED
    assert (solution.status != status.UNSOLVED).all()
    assert reflected.mean() > 0.05
    at = fermat.sample(surface, solution.u[reflected])
    assert fermat.is_reflection_side(eye, vertices[reflected], at).all()
    # On a convex mirror a vertex is hidden exactly where the segment to it pierces.
    hidden = solution.status == status.HIDDEN
    assert (pierce(surface, eye, vertices)[0] == hidden).mean() > 0.998
    assert solution.iterations[reflected].mean() < 5.0

    if height > 0.1:
        turned = eye.copy()
        turned[:2] += 0.009 * np.linalg.norm(eye[:3]) / np.linalg.norm(eye[:2]) * np.array([-eye[1], eye[0]])
        before = np.where(reflected[:, None], solution.u, np.nan)
        warm, _ = newton.solve(surface, Screen(turned, 660.0), vertices, before)
        both = reflected & (warm.status == status.REFLECTED)
        assert warm.iterations[both].mean() < 1.5
        cold, _ = newton.solve(surface, Screen(turned, 660.0), vertices)
        assert (cold.status == warm.status).mean() > 0.999
        same = both & (cold.status == status.REFLECTED)
        error = Screen(turned, 660.0).pixels(cold.at.position[same], (warm.at.position - cold.at.position)[same])
        assert np.percentile(np.linalg.norm(error, axis=1), 99) < 0.05


def test_a_solved_point_stays_where_it_is() -> None:
    surface, eye = SURFACES["flat ellipsoid"], np.array([2.3, -2.9, 1.8, 1.0])
    vertices = around(surface, 3000, 8)
    first, _ = newton.solve(surface, Screen(eye, 660.0), vertices)
    reflected = first.status == status.REFLECTED
    again, _ = newton.solve(surface, Screen(eye, 660.0), vertices, np.where(reflected[:, None], first.u, np.nan))
    stays = (again.u == first.u).all(axis=1)[reflected]
    assert stays.mean() > 0.95
    moved = Screen(eye, 660.0).pixels(first.at.position, again.at.position - first.at.position)
    assert np.linalg.norm(moved[reflected], axis=1).max() < 0.05


def test_every_rung_of_the_ladder_is_reached() -> None:
    """On a coarse map of a flat ellipsoid, where texels meet with kinks, and the eye and most vertices are close."""
    exact = SURFACES["flat ellipsoid"]
    surface = coarse_map(exact, 32)
    reached = np.zeros(len(newton.RUNGS), int)
    for seed in range(4):
        random = np.random.default_rng(seed)
        axis = unit(random.normal(size=(1, 3)))
        eye = np.append(axis[0] * (exact.radius(axis)[0][0] + 10 ** random.uniform(-2, 1)), 1.0)
        u = unit(random.normal(size=(8000, 3)))
        vertices = u * (exact.radius(u)[0] + 10 ** random.uniform(-3, 1, 8000))[:, None]
        screen = Screen(eye, 659.0)
        solution, rung = newton.solve(surface, screen, vertices)
        settled = (solution.status == status.REFLECTED) & (rung >= 0)
        reached += np.bincount(rung[settled], minlength=len(newton.RUNGS))
        at = fermat.sample(surface, solution.u[settled])
        assert fermat.is_reflection_side(eye, vertices[settled], at).all()
        # Newton moves what has been found by less than half a pixel: it is a zero of this map's gradient.
        g = fermat.path_gradient(eye, vertices[settled], solution.u[settled], at)
        frame = descent.tangent_frame(solution.u[settled])
        derivative = descent.second_derivative(surface, eye, vertices[settled], solution.u[settled], at, frame)
        step = descent.newton_step(derivative, g, frame)
        pixels = np.linalg.norm(screen.pixels(at.position, at.radius[:, None] * step), axis=1)
        assert np.percentile(pixels, 99) < 0.5
        assert (solution.status == status.UNSOLVED).mean() < 1e-3
    assert (reached > 0).all(), dict(zip(newton.RUNGS, reached, strict=True))


@pytest.mark.parametrize("height", [0.03, 3.0])
@pytest.mark.parametrize("name", ["sphere", "flat ellipsoid", "ellipsoid"])
def test_known_to_be_convex_hidden_vertices_are_marched_for_once(
    name: str, height: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The descent ends where the way to them enters the mirror or leaves it; the next frame's starts at the entry."""
    surface = SURFACES[name]
    eye = eye_over(surface, height, 3)
    screen = Screen(eye, 660.0)
    vertices = around(surface, 4000, 4)
    expected, _ = newton.solve(surface, screen, vertices)
    marched = []
    march = newton.pierce
    monkeypatch.setattr(newton, "pierce", lambda *args: marched.append(len(args[2])) or march(*args))
    solution, _ = newton.solve(surface, screen, vertices, convex=True)
    hidden = solution.status == status.HIDDEN
    assert np.array_equal(solution.status, expected.status) and hidden.mean() > 0.02
    off = screen.pixels(expected.at.position[hidden], (solution.at.position - expected.at.position)[hidden])
    assert np.percentile(np.linalg.norm(off, axis=1), 99) < 0.1
    assert marched[0] < 0.8 * hidden.sum()
    marched.clear()
    warm, _ = newton.solve(surface, screen, vertices, previous=solution.u, convex=True)
    assert sum(marched) < 0.01 * hidden.sum()
    assert (warm.status == solution.status).mean() > 0.999
    assert warm.iterations[hidden].mean() < 1.5


@pytest.mark.parametrize("rung", range(len(newton.RUNGS)), ids=newton.RUNGS)
def test_each_rung_alone_is_right(rung: int) -> None:
    """With no step of the first pass allowed to converge, and all rungs before it left out."""
    surface, eye = SURFACES["ellipsoid"], np.array([2.3, -2.9, 1.8, 1.0])
    vertices = around(surface, 1500, 9)
    expected, _ = newton.solve(surface, Screen(eye, 660.0), vertices)
    solution, settled = newton.solve(surface, Screen(eye, 660.0), vertices, first_steps=0, first_rung=rung)
    assert (solution.status == expected.status).mean() > 0.995
    both = (solution.status == status.REFLECTED) & (expected.status == status.REFLECTED)
    assert (settled[both] == rung).mean() > 0.9
    off = Screen(eye, 660.0).pixels(expected.at.position[both], (solution.at.position - expected.at.position)[both])
    assert np.linalg.norm(off, axis=1).max() < 0.1


def test_from_behind_the_way_back_leads_to_the_front() -> None:
    """Seen from inside, the back of a flat mirror is a minimum of the path length too."""
    surface, eye = Ellipsoid(1.0, 1.0, 0.25), np.array([0.3, 0.1, 1.2, 1.0])
    random = np.random.default_rng(1)
    vertices = np.column_stack([random.uniform(-0.5, 0.5, (400, 2)), random.uniform(0.5, 1.5, 400)])
    below = np.tile([0.0, 0.0, -1.0], (400, 1))
    screen = Screen(eye, 660.0)
    u, converged, _ = descent.minimize(surface, screen, vertices, below, newton.STEPS, 0.05)
    wrong = converged & (u[:, 2] < 0.0)
    assert wrong.mean() > 0.3
    u, converged, _ = newton._descend(surface, screen, vertices, below, 0.05, hollow=False, any_kind=False)
    at = fermat.sample(surface, u)
    assert (converged & fermat.is_reflection_side(eye, vertices, at))[wrong].mean() > 0.98


@pytest.mark.parametrize("name", ["sphere", "strongly bumpy", "saddle", "kettle"])
def test_the_shortest_path_is_a_reflection_or_the_segment(name: str) -> None:
    """What the descent rests on, by brute force over a grid of directions."""
    study = STUDIES[name]
    nodes = texel_directions(48).reshape(-1, 3)
    at = fermat.sample(study.surface, nodes)
    eye = np.array([*study.eye, 1.0])
    for vertex in around(study.surface, 60, 5, 1e-2):
        length = np.linalg.norm(at.position - eye[:3], axis=1) + np.linalg.norm(at.position - vertex, axis=1)
        best = int(length.argmin())
        start = nodes[best : best + 1]
        u, _, _ = descent.minimize(study.surface, Screen(eye, 660.0), vertex[None], start, 30, 0.01)
        end = fermat.sample(study.surface, u)
        pierced = pierce(study.surface, eye, vertex[None])[0][0]
        h = np.linalg.norm(fermat.half_vector(eye, vertex[None], end.position))
        if pierced:
            assert h < 0.05
        else:
            # A segment that only just passes the mirror is pierced within the march's step.
            assert fermat.is_reflection_side(eye, vertex[None], end)[0] or h < 0.05


def test_orthographic_eye_is_the_limit_of_a_far_one() -> None:
    surface, vertices = SURFACES["flat ellipsoid"], around(SURFACES["flat ellipsoid"], 1000, 8)
    axis = unit(np.array([1.0, -2.0, 0.7]))
    far, _ = newton.solve(surface, Screen(np.append(1e6 * axis, 1.0), 2e8), vertices)
    infinite, _ = newton.solve(surface, Screen(np.append(axis, 0.0), 200.0), vertices)
    assert (far.status == infinite.status).mean() > 0.998
    both = (far.status == status.REFLECTED) & (infinite.status == status.REFLECTED)
    assert np.linalg.norm(far.at.position - infinite.at.position, axis=1)[both].max() < 1e-3


def test_a_hollow_mirror() -> None:
    study = STUDIES["bowl"]
    cases = make_cases(study, "near", 400)
    screen = Screen(cases.eye, 660.0)
    solution, _ = newton.solve(study.surface, screen, cases.vertices, side=-1.0)
    truth = study.oracle().reflection_points(cases.eye, cases.vertices)
    reflected = solution.status == status.REFLECTED
    assert reflected.mean() > 0.9
    nearest = truth.nearest_to(solution.at.position)
    known = reflected & np.isfinite(nearest[:, 0])
    error = np.linalg.norm(screen.pixels(nearest[known], (solution.at.position - nearest)[known]), axis=1)
    assert np.percentile(error, 95) < 0.1
