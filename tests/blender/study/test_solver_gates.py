# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""No method gets worse unnoticed: errors, losses and operation counts on a small fixed solver table. Never time."""

from __future__ import annotations

import pytest
from curvrefl.curvrefl_addon.optics.catalog import solvers
from curvrefl.curvrefl_addon.study.solvers.solver_table import Row, solver_table
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import STUDIES
from curvrefl.curvrefl_addon.study.stability.fuzz import fuzz
from curvrefl.curvrefl_addon.study.stability.motion import measure_motion

pytestmark = pytest.mark.usefixtures("gpu")

USUAL = ("far", "near", "contact", "grazing", "axis, corner, pole")


@pytest.fixture(scope="module")
def rows() -> dict[tuple[str, str, str], Row]:
    table, refusals = solver_table(
        200, ("sphere", "ellipsoid", "bumpy", "bowl"), (*USUAL, "hidden"), timed=False, only_defaults=True
    )
    assert not refusals
    return {(row.reflector, row.regime, row.method): row for row in table}


@pytest.mark.parametrize("reflector", ["sphere", "ellipsoid", "bumpy"])
def test_secant_star(rows: dict[tuple[str, str, str], Row], reflector: str) -> None:
    here = [rows[reflector, regime, "secant_star"] for regime in USUAL]
    assert max(row.unconverged for row in here) <= 0.01
    assert max(row.error_p95_px for row in here) < 0.15
    assert max(row.off for row in here) == 0.0
    assert max(row.misclassified for row in here) <= 0.01
    # The paper's 5 to 10 steps.
    assert 5.0 <= sum(row.iterations_mean for row in here) / len(here) <= 10.0
    assert max(row.iterations_max for row in here) <= 40
    hidden = rows[reflector, "hidden", "secant_star"]
    assert hidden.misclassified == 0.0


@pytest.mark.parametrize("reflector", ["sphere", "ellipsoid", "bumpy"])
def test_newton(rows: dict[tuple[str, str, str], Row], reflector: str) -> None:
    here = [rows[reflector, regime, "newton"] for regime in USUAL]
    assert max(row.unconverged for row in here) == 0.0
    assert max(row.error_p99_px for row in here) < 0.15
    assert max(row.off for row in here) == 0.0
    assert max(row.misclassified for row in here) == 0.0
    mean = sum(row.iterations_mean for row in here) / len(here)
    assert mean < {"sphere": 1.3, "ellipsoid": 4.5, "bumpy": 2.5}[reflector]
    assert max(row.iterations_max for row in here) <= 40
    hidden = rows[reflector, "hidden", "newton"]
    assert (hidden.misclassified, hidden.unconverged) == (0.0, 0.0)


def test_newton_in_a_hollow_mirror(rows: dict[tuple[str, str, str], Row]) -> None:
    here = [rows["bowl", regime, "newton"] for regime in ("far", "near", "contact")]
    assert max(row.error_p95_px for row in here[:2]) < 0.1
    # Its map does not know where the bowl is open: some vertices that touch the wall are reflected up there.
    assert here[2].off <= 0.35
    assert max(row.misclassified + row.unconverged for row in here) <= 0.1


def test_secant_star_in_a_hollow_mirror(rows: dict[tuple[str, str, str], Row]) -> None:
    here = [rows["bowl", regime, "secant_star"] for regime in ("far", "near", "contact")]
    assert max(row.error_p95_px for row in here) < 0.1
    assert max(row.misclassified + row.unconverged for row in here) <= 0.1


BOUNDS = {
    # method: (median px far, off near, unconverged far, mean iterations far)
    "secant_uv": (0.1, 0.2, 0.2, 5.0),
    "bisector_cube": (0.05, 0.05, 0.01, 9.0),
    "bisector_grid": (8.0, 1.0, 0.01, 18.0),
    "bisector_screen": (0.6, 0.35, 0.01, 250.0),
}


@pytest.mark.parametrize("method", BOUNDS)
def test_other_methods_on_the_sphere(rows: dict[tuple[str, str, str], Row], method: str) -> None:
    median, off, unconverged, iterations = BOUNDS[method]
    far, near = rows["sphere", "far", method], rows["sphere", "near", method]
    assert far.error_median_px < median
    assert near.off <= off
    assert far.unconverged < unconverged
    assert far.iterations_mean <= iterations
    assert rows["sphere", "hidden", method].misclassified == 0.0


def test_bisector_cube_with_contact_grazing_and_hollow(rows: dict[tuple[str, str, str], Row]) -> None:
    for reflector in ("sphere", "ellipsoid", "bumpy"):
        assert rows[reflector, "contact", "bisector_cube"].unconverged <= 0.05
        assert rows[reflector, "contact", "bisector_cube"].off <= 0.05
        assert rows[reflector, "grazing", "bisector_cube"].off <= 0.2
        assert rows[reflector, "hidden", "bisector_cube"].unconverged <= 0.1
    assert rows["bowl", "contact", "bisector_cube"].off <= 0.05
    assert rows["bowl", "far", "bisector_cube"].off == 0.0


def test_environments_are_right_far_away_and_wrong_nearby(rows: dict[tuple[str, str, str], Row]) -> None:
    assert rows["sphere", "far", "environment_cube"].error_median_px < 2.0
    assert rows["sphere", "contact", "environment_cube"].error_median_px > 20.0
    near, far = (rows["sphere", "near", name].error_median_px for name in ("environment_parallax", "environment_cube"))
    assert near < far


def test_any_input_ends_with_a_code() -> None:
    results = fuzz(100_000, tuple(STUDIES)) + fuzz(20_000, ("bumpy glass", "glass from inside"))
    assert {item.method for item in results} == {name for name, entry in solvers().items() if entry.solves_vertices}
    for item in results:
        assert (item.not_finite, item.wild, item.without_code) == (0, 0, 0), item.method
        assert item.invalid > 0 and item.reflected > 0 and item.hidden > 0


def test_refractions_move_steadily() -> None:
    for item in measure_motion(("glass sphere",), 120):
        assert item.method == "newton_refraction"
        assert item.identical_at_rest
        assert item.jitter_p99_px < 0.1
        assert item.iterations_later < 1.5


def test_reflections_move_steadily() -> None:
    found = {(item.path, item.method): item for item in measure_motion(("ellipsoid",), 300)}
    for item in found.values():
        assert item.identical_at_rest, item.method
    for path in ("eye", "objects"):
        assert found[path, "secant_star"].jitter_p99_px < 0.3
        assert found[path, "secant_star"].worst_pop_px < 1.0
        assert found[path, "newton"].jitter_p99_px < 0.05
        assert found[path, "newton"].worst_pop_px < 0.5
        assert found[path, "newton"].iterations_later < 1.5
        assert found[path, "bisector_cube"].jitter_p99_px < 0.5
        # Estalella et al. 2005, section 5: interpolated vertices move more steadily than a fixed number of steps.
        assert found[path, "bisector_grid"].jitter_p99_px < 0.5
        # A search from texel to texel cannot be steadier than its texels, and starts where it ended.
        assert found[path, "bisector_screen"].jitter_p99_px < 8.0
        assert found[path, "bisector_screen"].iterations_later < 0.2 * found[path, "bisector_screen"].iterations_first


@pytest.fixture(scope="module")
def glass_rows() -> dict[tuple[str, str], Row]:
    table, refusals = solver_table(
        120,
        ("glass sphere", "bumpy glass"),
        ("inside", "behind", "far", "contact", "hidden"),
        timed=False,
        only_defaults=True,
    )
    assert not refusals
    # No method for mirrors is judged by glass.
    assert {row.method for row in table} == {"newton_refraction"}
    return {(row.reflector, row.regime): row for row in table}


@pytest.mark.parametrize("surface", ["glass sphere", "bumpy glass"])
def test_newton_through_glass(glass_rows: dict[tuple[str, str], Row], surface: str) -> None:
    here = [glass_rows[surface, regime] for regime in ("inside", "behind", "far", "contact")]
    assert max(row.error_p95_px for row in here) < 0.15
    assert max(row.off for row in here) <= 0.02
    assert max(row.misclassified + row.unconverged for row in here) <= 0.02
    mean = sum(row.iterations_mean for row in here) / len(here)
    assert mean < {"glass sphere": 1.8, "bumpy glass": 4.5}[surface]
    hidden = glass_rows[surface, "hidden"]
    assert hidden.misclassified == 0.0
    assert hidden.unconverged <= 0.1
