# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Regions of a mirror by the signs of its curvature."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.fermat import sample
from curvrefl.curvrefl_addon.optics.solvers.newton_region import is_way_free
from curvrefl.curvrefl_addon.optics.surfaces.cube_map import CubeMapSurface, texel_directions
from curvrefl.curvrefl_addon.optics.surfaces.curvature_regions import (
    CONVEX,
    HOLLOW,
    SADDLE,
    curvature_kinds,
    curvature_regions,
)
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid, RadialSurface, unit
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import STUDIES, Saddle


def mapped(surface: RadialSurface, texels: int = 128) -> CubeMapSurface:
    at = sample(surface, texel_directions(texels).reshape(-1, 3))
    return CubeMapSurface(np.column_stack([at.radius, at.gradient]).reshape(6, texels, texels, 4).astype(np.float32))


@pytest.mark.parametrize("surface", [Ellipsoid(), Ellipsoid(1.0, 0.5, 0.25), STUDIES["bumpy"].surface])
def test_a_convex_mirror_is_one_region(surface: RadialSurface) -> None:
    regions = curvature_regions(mapped(surface))
    assert regions.kinds == (CONVEX,)
    assert (regions.masks == 1).all()


def test_signs_of_curvature() -> None:
    """r = 1 + a (x^2 - y^2) along z, where r = 1: the curvatures are 1 - 2 a along x and 1 + 2 a along y."""
    z = np.array([[0.0, 0.0, 1.0]])
    assert curvature_kinds(Saddle(0.7), z) == [SADDLE]
    assert curvature_kinds(Saddle(0.3), z) == [CONVEX]
    assert curvature_kinds(Ellipsoid(), unit(np.random.default_rng(0).normal(size=(20, 3)))).tolist() == [CONVEX] * 20


@pytest.mark.parametrize(
    ("name", "kinds"),
    [("kettle", [CONVEX, CONVEX, SADDLE]), ("saddle", [CONVEX, CONVEX, SADDLE, HOLLOW, HOLLOW])],
)
def test_connected_parts(name: str, kinds: list[int]) -> None:
    exact, from_map = (curvature_regions(s) for s in (STUDIES[name].surface, mapped(STUDIES[name].surface)))
    assert sorted(exact.kinds) == sorted(from_map.kinds) == kinds
    for region in range(len(exact)):
        assert exact.holds(region, exact.seeds[region]).all()
    # Every direction is in some region, specks aside.
    assert (exact.masks > 0).mean() > 0.99


def test_the_way_is_blocked_by_another_part() -> None:
    points = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])
    ways = np.array([[0.0, 0.0, 5.0], [3.0, 0.0, 0.001], [0.3, 0.0, -3.0]])
    assert is_way_free(Ellipsoid(), points, ways).tolist() == [True, True, False]
