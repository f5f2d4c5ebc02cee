# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The oracle against the quartic, and against vertices made from reflection points."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces import sphere
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, unit
from curvrefl.curvrefl_addon.study.solvers.oracle import Oracle
from curvrefl.curvrefl_addon.study.solvers.reflection_points import MAXIMUM, MINIMUM, SADDLE
from curvrefl.curvrefl_addon.study.solvers.regimes import BLOCK, REGIMES, _first, make_cases
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import STUDIES


def test_a_hundred_thousand_cases_on_the_sphere() -> None:
    """Contact down to 1e-4 R, eyes down to 1.01 R."""
    random = np.random.default_rng(0)
    count = 100_000
    eyes = np.ones((count, 4))
    eyes[:, :3] = unit(random.normal(size=(count, 3))) * (1.0 + 10 ** random.uniform(-2, 2, count))[:, None]
    vertices = unit(random.normal(size=(count, 3))) * (1.0 + 10 ** random.uniform(-4, 2, count))[:, None]
    expected = sphere.reflection_points(eyes[:, :3], vertices, 1.0)
    found = Oracle(Ellipsoid()).reflection_points(eyes, vertices)
    shown = np.isfinite(expected[:, 0])
    assert 0.3 < shown.mean() < 0.7
    # Vertices on the horizon itself to the last digit may fall to either side.
    assert (shown != (found.counts(count) > 0)).sum() <= 2
    assert found.counts(count).max() == 1 and found.visible.all() and (found.signature == MINIMUM).all()
    first = found.first(count)
    both = shown & np.isfinite(first[:, 0])
    assert np.linalg.norm(first[both] - expected[both], axis=1).max() < 1e-9


@pytest.mark.parametrize("name", STUDIES)
def test_constructed_points_are_found(name: str) -> None:
    study = STUDIES[name]
    oracle = study.oracle()
    for regime in REGIMES:
        if regime == "silhouette" and name == "torus section":
            continue
        cases = make_cases(study, regime, 60)
        if len(cases.vertices) == 0:
            continue
        found = oracle.reflection_points(cases.eye, cases.vertices)
        counts = found.counts(len(cases.vertices))
        if regime == "hidden":
            assert (counts == 0).all()
            continue
        error = np.linalg.norm(found.nearest_to(cases.points) - cases.points, axis=1)
        # Where images are about to merge one of a pair may be missed.
        lost = (~(error < 1e-7)).mean()
        hard = regime in ("caustic", "two or three images", "eye close") or study.mixed
        assert lost <= (0.08 if hard else 0.0), (regime, lost)
        if regime == "two or three images":
            assert (counts >= 2).mean() > 0.95


def test_a_hollow_mirror_shows_up_to_three_images_of_all_kinds() -> None:
    study = STUDIES["bowl"]
    cases = make_cases(study, "near", 300)
    found = study.oracle().reflection_points(cases.eye, cases.vertices)
    assert found.counts(300).max() >= 3
    assert set(found.signature) == {MINIMUM, SADDLE, MAXIMUM}


def test_an_open_mirror_reflects_nowhere_but_on_itself() -> None:
    study = STUDIES["bowl"]
    random = np.random.default_rng(0)
    vertices = unit(random.normal(size=(500, 3))) * random.uniform(0.1, 3.0, (500, 1))
    eye = np.array([*study.eye, 1.0])
    found = study.oracle().reflection_points(eye, vertices)
    assert len(found.u) > 500
    assert study.cover(found.u).all()
    closed = Oracle(study.surface, 64, study.side).reflection_points(eye, vertices)
    assert not study.cover(closed.u).all()


def test_what_is_not_finite_has_no_reflection() -> None:
    vertices = np.array([[np.nan, 0.0, 2.0], [0.0, np.inf, 0.0], [0.0, 0.0, 2.0]])
    found = Oracle(Ellipsoid()).reflection_points(np.array([3.0, 0.0, 1.0, 1.0]), vertices)
    assert found.vertex.tolist() == [2]
    assert Oracle(Ellipsoid()).reflection_points(np.array([3.0, 0.0, 1.0, 1.0]), vertices[:0]).vertex.size == 0


def test_an_eye_at_infinity_is_the_limit_of_a_far_one() -> None:
    vertices = make_cases(STUDIES["bumpy"], "near", 50).vertices
    axis = unit(np.array([[2.3, -2.9, 1.8]]))[0]
    oracle = Oracle(STUDIES["bumpy"].surface)
    far = oracle.reflection_points(np.append(1e8 * axis, 1.0), vertices).first(50)
    infinite = oracle.reflection_points(np.append(axis, 0.0), vertices).first(50)
    both = np.isfinite(far[:, 0]) & np.isfinite(infinite[:, 0])
    assert both.sum() > 20
    np.testing.assert_allclose(far[both], infinite[both], atol=1e-6)


@pytest.mark.parametrize("name", STUDIES)
def test_gradients_are_those_of_the_radius(name: str) -> None:
    surface = STUDIES[name].surface
    u = unit(np.random.default_rng(0).normal(size=(500, 3)))
    radius, gradient = surface.radius(u)
    assert (radius <= surface.bound * (1 + 1e-9)).all() and (radius > 0.0).all()
    direction = unit(np.cross(u, [0.3, -0.7, 0.2]))
    step = 1e-6
    change = (surface.radius(unit(u + step * direction))[0] - surface.radius(unit(u - step * direction))[0]) / (
        2 * step
    )
    # The torus is cut off where a ray leaves its tube twice: a step of a thousandth there.
    assert np.percentile(np.abs(change - np.einsum("ij,ij->i", gradient, direction)), 90) < 1e-6


@pytest.mark.parametrize("name", ["ellipsoid", "saddle", "bowl"])
def test_one_eye_is_as_the_same_eye_for_each_vertex(name: str) -> None:
    study = STUDIES[name]
    cases = make_cases(study, "near", 150)
    oracle = study.oracle()
    one = oracle.reflection_points(cases.eye, cases.vertices)
    each = oracle.reflection_points(np.tile(cases.eye, (len(cases.vertices), 1)), cases.vertices)
    assert np.array_equal(one.vertex, each.vertex)
    assert np.array_equal(one.visible, each.visible)
    assert np.abs(one.point - each.point).max() < 1e-9


def test_the_first_that_hold_are_chosen() -> None:
    asked: list[int] = []

    def holds(rows: np.ndarray) -> np.ndarray:
        asked.extend(rows.tolist())
        return rows % 3 == 0

    assert _first(5, 10_000, holds).tolist() == [0, 3, 6, 9, 12]
    assert len(asked) == BLOCK
    assert _first(5, 7, holds).tolist() == [0, 3, 6]
    assert _first(5, 0, holds).tolist() == []


@pytest.mark.parametrize(("name", "regime"), [("torus section", "caustic"), ("bowl", "eye close"), ("saddle", "far")])
def test_a_finer_grid_finds_no_more(name: str, regime: str) -> None:
    study = STUDIES[name]
    cases = make_cases(study, regime, 150)
    found = study.oracle().reflection_points(cases.eye, cases.vertices)
    finer = Oracle(study.surface, 96, study.side, study.cover if study.rim < 1.0 else None)
    expected = finer.reflection_points(cases.eye, cases.vertices)
    assert found.visible.sum() >= 0.99 * expected.visible.sum()
