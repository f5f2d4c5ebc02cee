# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shaders of `newton` are held to their float64 reference; warm starts, the list of stragglers, frames at rest."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics import status
from curvrefl.curvrefl_addon.optics.screen import Screen
from curvrefl.curvrefl_addon.optics.solvers import newton
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import RadialSurface, unit
from curvrefl.curvrefl_addon.renderer.device.cubes import cube_texture
from curvrefl.curvrefl_addon.renderer.device.records import record_texture
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.vertices.solution import VertexSolution
from curvrefl.curvrefl_addon.renderer.vertices.solve import MOST_STRAGGLERS_AT_ONCE, Reflector, solve_vertices
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.study.solvers.regimes import make_cases
from curvrefl.curvrefl_addon.study.solvers.solver_table import study_view
from curvrefl.curvrefl_addon.study.solvers.study_reflector import StudyReflector
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import STUDIES
from curvrefl.curvrefl_addon.study.stability.scenes import trials
from scenes.radial_maps import SURFACES, radial_map, vertices_around
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")

EYE = np.array([2.3, -2.9, 1.8])
ORIGIN = np.zeros(3)


class Placed:
    """A reflector that stands turned and away from the origin, and vertices around it."""

    def __init__(self, surface: RadialSurface, count: int, resolution: int = 128) -> None:
        faces = radial_map(surface, resolution)
        self.surface = CubeMapSurface(faces)
        self.vertices = vertices_around(surface, count, 1e-3)
        turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
        self.turn = turn * np.sign(np.linalg.det(turn))
        self.place = np.array([3.0, -2.0, 5.0])
        self.world_to_map = np.eye(4)
        self.world_to_map[:3, :3] = self.turn
        self.world_to_map[:3, 3] = -self.turn @ self.place
        world = (self.vertices @ self.turn + self.place).astype(np.float32)
        self.positions = record_texture(np.column_stack([world, np.ones(count)]))
        self.reflector = Reflector(self.world_to_map, self.surface.bound, {"radial": cube_texture(faces)})

    def view(self, eye: np.ndarray = EYE, orthographic: bool = False) -> View:
        return look_at(self.place + eye, self.place, 640, 480, np.radians(40), orthographic=orthographic)

    def solve(self, view: View, previous: VertexSolution | None = None, **options: int) -> VertexSolution:
        return solve_vertices(
            "newton", view, self.reflector, self.positions, len(self.vertices), previous=previous, **options
        )

    def reference(self, view: View, **options: int) -> newton.Solution:
        eye = self.world_to_map @ view.eye
        return newton.solve(self.surface, Screen(eye, view.focal_pixels), self.vertices, **options)[0]

    def error(self, view: View, points: np.ndarray, expected: np.ndarray) -> np.ndarray:
        """(n,) pixels between world points and points of the map frame."""
        return np.linalg.norm(view.project(points) - view.project(expected @ self.turn + self.place), axis=1)


@pytest.mark.parametrize("orthographic", [False, True], ids=["perspective", "orthographic"])
@pytest.mark.parametrize("name", SURFACES)
def test_shader_follows_the_reference(name: str, orthographic: bool) -> None:
    placed = Placed(SURFACES[name], 8000)
    view = placed.view(orthographic=orthographic)
    points, code, iterations, virtual = placed.solve(view).read()
    reference = placed.reference(view)
    assert (code == reference.status).mean() > 0.998
    assert (code != status.UNSOLVED).all()
    both = (code == status.REFLECTED) & (reference.status == status.REFLECTED)
    assert both.mean() > 0.4
    error = placed.error(view, points, reference.at.position)[both]
    assert np.median(error) < 0.02
    assert np.percentile(error, 99) < 0.1
    assert abs(iterations[both].mean() - reference.iterations[both].mean()) < 0.3
    assert np.linalg.norm(view.project(virtual[:, :3]) - view.project(points), axis=1)[both].max() < 0.05


@pytest.mark.parametrize("rung", range(len(newton.RUNGS)), ids=newton.RUNGS)
def test_each_rung_alone_is_right(rung: int) -> None:
    """One step of the first pass settles next to nothing; the rungs before this one are left out."""
    placed = Placed(SURFACES["ellipsoid"], 3000)
    view = placed.view()
    points, code, iterations, _ = placed.solve(view, steps=1, first_rung=rung).read()
    reference = placed.reference(view)
    assert (code == reference.status).mean() > 0.99
    both = (code == status.REFLECTED) & (reference.status == status.REFLECTED)
    assert np.percentile(placed.error(view, points, reference.at.position)[both], 99) < 0.1
    # The clean-up pass did it.
    assert (iterations[both] > 1).mean() > 0.8


def test_every_rung_is_reached() -> None:
    """On a coarse map full of kinks: leaving rungs out leaves more unsolved, and takes other steps."""
    placed = Placed(SURFACES["ellipsoid"], 30_000, resolution=24)
    view = placed.view(0.35 * EYE)
    steps = []
    for rung in range(len(newton.RUNGS)):
        _, code, iterations, _ = placed.solve(view, first_rung=rung).read()
        steps.append(iterations)
        if rung == 0:
            assert (code == status.UNSOLVED).mean() < 2e-3
    for one, other in pairwise(steps):
        assert (one != other).any()


def test_any_number_of_stragglers_is_served() -> None:
    count = 3 * MOST_STRAGGLERS_AT_ONCE + 17
    placed = Placed(SURFACES["ellipsoid"], count)
    view = placed.view()
    _, code, iterations, _ = placed.solve(view, steps=1).read()
    left_over = (iterations > 1).sum()
    assert left_over > 1.2 * MOST_STRAGGLERS_AT_ONCE
    assert (code == status.UNSOLVED).sum() <= 2
    _, usual, _, _ = placed.solve(view).read()
    assert (usual == code).mean() > 0.999


def test_a_warm_start_takes_one_step_or_two() -> None:
    placed = Placed(SURFACES["ellipsoid"], 8000)
    turned = EYE + 0.009 * np.linalg.norm(EYE) * unit(np.array([2.9, 2.3, 0.0])[None])[0]
    before, after = placed.view(), placed.view(turned)
    last = placed.solve(before)
    points, code, iterations, _ = placed.solve(after, last).read()
    cold_points, cold_code, cold_iterations, _ = placed.solve(after).read()
    assert (code == cold_code).mean() > 0.999
    was = last.read()[1]
    both = (code == status.REFLECTED) & (cold_code == status.REFLECTED) & (was == status.REFLECTED)
    assert iterations[both].mean() < 1.5 < 2.5 < cold_iterations[both].mean()
    off = np.linalg.norm(after.project(points) - after.project(cold_points), axis=1)[both]
    assert np.percentile(off, 99) < 0.05
    # What was hidden starts as if there were no last frame.
    hidden = was == status.HIDDEN
    assert np.array_equal(iterations[hidden], cold_iterations[hidden])
    assert np.array_equal(points[hidden], cold_points[hidden])


@pytest.mark.parametrize("name", ["sphere", "ellipsoid"])
def test_on_a_convex_mirror_hidden_vertices_start_warm_too(name: str) -> None:
    """From where the way to them entered the mirror, where it enters it now being asked for by no march."""
    placed = Placed(SURFACES[name], 8000)
    before, after = placed.view(), placed.view(EYE + 0.009 * np.array([2.9, 2.3, 0.0]))
    expected, code, _, seeming = placed.solve(after).read()
    placed.reflector = replace(placed.reflector, is_convex=True)
    cold = placed.solve(after).read()
    warm = placed.solve(after, placed.solve(before)).read()
    hidden = code == status.HIDDEN
    assert hidden.mean() > 0.1
    for points, now, iterations, virtual in (cold, warm):
        assert (now == code).mean() > 0.999
        both = hidden & (now == status.HIDDEN)
        off = np.linalg.norm(after.project(points) - after.project(expected), axis=1)[both]
        assert np.percentile(off, 99) < 0.2
        apart = np.linalg.norm(virtual - seeming, axis=1)[both]
        assert np.median(apart / (1e-6 + seeming[both, 3])) < 1e-3
        if now is warm[1]:
            assert iterations[both].mean() < 2.0


@pytest.mark.parametrize("name", ["sphere", "bumpy"])
def test_points_at_rest_keep_their_bits(name: str) -> None:
    """Solved from itself, over and over, without the shortcut for what has not changed."""
    placed = Placed(SURFACES[name], 8000)
    placed.reflector = replace(placed.reflector, is_convex=name == "sphere")
    view = placed.view()
    first = placed.solve(view)
    latest = first
    for _ in range(3):
        latest = placed.solve(view, latest)
    assert latest is not first
    (points, code, _, virtual), (now, code_now, _, virtual_now) = first.read(), latest.read()
    assert np.array_equal(code, code_now)
    assert np.array_equal(points, now)
    assert np.array_equal(virtual, virtual_now)


def test_frames_at_rest_are_identical_and_solved_once() -> None:
    trial = trials()[0]
    renderer = Renderer(trial.scene, Settings(method="newton", samples=1))
    try:
        first = renderer.reflect(trial.view)
        again = renderer.reflect(trial.view, last=first)
        assert [one is other for one, other in zip(first.solutions, again.solutions, strict=True)] == [True] * len(
            first.solutions
        )
        # A still does not depend on what was drawn before.
        still, other = (renderer.render(trial.view).color() for _ in range(2))
        assert np.array_equal(still, other)
        # A thing moves: its chunk is solved again, from where it was.
        instances = list(trial.scene.instances)
        matrix = instances[2].matrix.copy()
        matrix[0, 3] += 0.05
        instances[2] = replace(instances[2], matrix=matrix)
        renderer.update(replace(trial.scene, instances=tuple(instances)))
        moved = renderer.reflect(trial.view, last=again)
        assert any(one is not other for one, other in zip(again.solutions, moved.solutions, strict=True))
        counts = [solution.read() for solution in moved.solutions]
        fresh = [solution.read() for solution in renderer.reflect(trial.view).solutions]
        for (points, code, _, _), (cold, cold_code, _, _) in zip(counts, fresh, strict=True):
            assert (code == cold_code).mean() > 0.99
            both = (code == status.REFLECTED) & (cold_code == status.REFLECTED)
            off = np.linalg.norm(trial.view.project(points) - trial.view.project(cold), axis=1)[both]
            assert np.percentile(off, 99) < 0.05
    finally:
        renderer.free()


def test_a_hollow_mirror_and_one_that_bends_both_ways_end_with_a_code() -> None:
    for name in ("bowl", "saddle"):
        study = STUDIES[name]
        placed = Placed(study.surface, 3000)
        placed.reflector = replace(placed.reflector, side=study.side)
        _, code, _, _ = placed.solve(placed.view(placed.turn.T @ np.array(study.eye))).read()
        assert (code == status.REFLECTED).mean() > 0.2
        assert (code == status.UNSOLVED).mean() < 0.02


def test_a_vertex_that_moves_about_its_reflection_point_is_solved_again() -> None:
    study = STUDIES["bumpy"]
    cases = make_cases(study, "near", 2000)
    reflector, view, settings = StudyReflector(study), study_view(cases.eye), Settings(method="newton")
    before = reflector.solve("newton", view, settings, cases.vertices)
    points, code, _, _ = before.read()
    # As far from it as before, half a degree on: for many of them the length is the same to the last bit.
    leg = cases.vertices - points
    across = unit(np.cross(leg, np.random.default_rng(0).normal(size=leg.shape)))
    angle = np.radians(0.5)
    length = np.linalg.norm(leg, axis=1, keepdims=True)
    moved = points + np.cos(angle) * leg + np.sin(angle) * length * across
    warm, warm_code, _, _ = reflector.solve("newton", view, settings, moved, before).read()
    cold, cold_code, _, _ = reflector.solve("newton", view, settings, moved).read()
    both = (code == status.REFLECTED) & (warm_code == status.REFLECTED) & (cold_code == status.REFLECTED)
    assert both.mean() > 0.9
    off = np.linalg.norm(view.project(warm) - view.project(cold), axis=1)[both]
    # A few change to another image.
    assert (off > 0.1).mean() < 0.005
