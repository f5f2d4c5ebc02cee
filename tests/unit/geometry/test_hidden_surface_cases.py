# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""The hidden-surface scenes say what they show: their two float64 witnesses agree, with a pixel to spare."""

from __future__ import annotations

import numpy as np
import pytest
from scenes.hidden_surfaces import CASES
from scenes.sheet_rays import hit_mirror, mirror_normal, mirror_ray, pixel_ray, trace
from scenes.sheets import SIZE


@pytest.mark.parametrize("name", CASES)
def test_expected_pixels_are_what_rays_find(name: str) -> None:
    case = CASES[name]()
    assert case.pixels
    for pixel in case.pixels:
        for dx, dy in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)):
            seen = trace(case, pixel.column + dx, pixel.row + dy)
            assert (seen.shows, seen.in_mirror) == (pixel.shows, pixel.in_mirror), pixel
            assert np.allclose(seen.color, pixel.color, atol=1e-12), pixel


def test_rays_meet_the_sphere_and_leave_it_at_the_same_angle() -> None:
    case = CASES["wall_behind"]()
    for column, row in ((64, 64), (90, 50), (30, 88)):
        origin, direction = pixel_ray(case, column, row)
        point = origin + hit_mirror(case, origin, direction) * direction
        assert abs(np.linalg.norm(point) - 1.0) < 1e-9
        normal = mirror_normal(case, point)
        assert np.allclose(normal, point, atol=1e-6)
        _, way = mirror_ray(case, column, row)
        assert abs(way @ normal + direction @ normal) < 1e-9


def test_pixel_off_the_mirror_has_no_mirror_ray() -> None:
    with pytest.raises(ValueError, match="does not see the mirror"):
        mirror_ray(CASES["wall_behind"](), SIZE - 1, SIZE - 1)
