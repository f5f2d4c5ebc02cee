# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The oracle for glass against closed forms on sphere and plane, and against vertices made from refracted rays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.fermat import sample
from curvrefl.curvrefl_addon.optics.snell import snell_error
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, Float64Array, tangential, unit
from curvrefl.curvrefl_addon.optics.surfaces.refraction import plane_points, sphere_points
from curvrefl.curvrefl_addon.study.solvers.reflection_points import MAXIMUM, MINIMUM, SADDLE
from curvrefl.curvrefl_addon.study.solvers.refraction_cases import REFRACTION_REGIMES, make_refraction_cases
from curvrefl.curvrefl_addon.study.solvers.refraction_oracle import RefractionOracle
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import GLASS_STUDIES


@dataclass(frozen=True)
class Slab:
    """The plane z = 1 from below, far out turned down to close it."""

    bound: float = 20.0

    def radius(self, u: Float64Array) -> tuple[Float64Array, Float64Array]:
        z = u[:, 2]
        height = np.where(z > 0.05, np.maximum(z, 0.05), 0.05)
        slope = np.where(z > 0.05, -1.0 / height**2, 0.0)
        return 1.0 / height, slope[:, None] * tangential(np.tile([0.0, 0.0, 1.0], (len(u), 1)), u)


@pytest.mark.parametrize("side", [1.0, -1.0], ids=["eye outside", "eye inside"])
@pytest.mark.parametrize("index", [1.01, 1.5, 3.0, 1.0 / 1.5])
def test_all_points_of_a_sphere(index: float, side: float) -> None:
    random = np.random.default_rng(0)
    count = 600
    eyes = np.ones((count, 4))
    height = 1.0 + 10 ** random.uniform(-2, 2, count) if side > 0.0 else random.uniform(0.0, 0.99, count)
    eyes[:, :3] = unit(random.normal(size=(count, 3))) * height[:, None]
    reach = 10 ** random.uniform(-1, 1, count)
    vertices = unit(random.normal(size=(count, 3))) * (reach if side > 0.0 else 1.0 + reach)[:, None]
    expected = sphere_points(eyes, vertices, 1.0, index, side)
    counts = np.isfinite(expected[..., 0]).sum(axis=1)
    found = RefractionOracle(Ellipsoid(), index, 32, side).reflection_points(eyes, vertices)
    # One of a pair about to merge may be missed.
    assert (found.counts(count) != counts).sum() <= 1
    assert (counts > 0).mean() > 0.1
    off = np.nanmin(np.linalg.norm(expected[found.vertex] - found.point[:, None], axis=2), axis=1)
    assert off.max() < 1e-9
    if index > 1.0 and side > 0.0:
        assert set(found.signature) >= {MINIMUM, SADDLE}
        assert counts.max() >= 2


def test_longest_paths_are_behind_the_focus() -> None:
    cases = make_refraction_cases(GLASS_STUDIES["glass sphere"], "far", 100)
    found = GLASS_STUDIES["glass sphere"].oracle().reflection_points(cases.eye, cases.vertices)
    assert (found.signature == MAXIMUM).all()


@pytest.mark.parametrize("index", [1.0 / 1.5, 1.33, 2.4])
def test_the_only_point_of_a_plane(index: float) -> None:
    random = np.random.default_rng(1)
    count = 300
    vertices = np.column_stack([random.uniform(-2, 2, (count, 2)), 1.0 - 10 ** random.uniform(-3, 0.3, count)])
    eye = np.array([0.5, -0.8, 3.0, 1.0])
    up = np.array([0.0, 0.0, 1.0])
    plane = up + plane_points(eye - np.append(up, 0.0), vertices - up, index)
    found = RefractionOracle(Slab(), index, 32).reflection_points(eye, vertices)
    on_top = np.abs(found.point[:, 2] - 1.0) < 1e-9
    assert np.bincount(found.vertex[on_top], minlength=count).tolist() == [1] * count
    np.testing.assert_allclose(found.point[on_top], plane[found.vertex[on_top]], atol=1e-9)


@pytest.mark.parametrize("name", GLASS_STUDIES)
def test_constructed_points_are_found(name: str) -> None:
    study = GLASS_STUDIES[name]
    oracle = study.oracle()
    regimes = 0
    for regime in REFRACTION_REGIMES:
        cases = make_refraction_cases(study, regime, 40)
        if len(cases.vertices) == 0:
            continue
        regimes += 1
        found = oracle.reflection_points(cases.eye, cases.vertices)
        counts = found.counts(len(cases.vertices))
        if regime == "hidden":
            assert (counts == 0).all()
            continue
        at = sample(study.surface, unit(cases.points))
        assert snell_error(cases.eye, cases.vertices, at, study.index, study.side).max() < 1e-6
        error = np.linalg.norm(found.nearest_to(cases.points) - cases.points, axis=1)
        lost = (~(error < 1e-6)).mean()
        assert lost <= (0.08 if regime in ("caustic", "eye close") else 0.03), (regime, lost)
        if regime == "two or three images":
            assert (counts >= 2).mean() > 0.95
    assert regimes >= 5


def test_what_is_not_finite_has_no_refraction() -> None:
    vertices = np.array([[np.nan, 0.0, 0.0], [0.0, np.inf, 0.0], [0.1, 0.0, 0.2]])
    found = RefractionOracle(Ellipsoid(), 1.5).reflection_points(np.array([3.0, 0.0, 1.0, 1.0]), vertices)
    assert found.vertex.tolist() == [2]
