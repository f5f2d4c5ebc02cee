# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Views: where they begin and end, and the same view of a world that has been moved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curvrefl.curvrefl_addon.scene.camera.view import View, with_depths
from scenes.views import look_at

EYE, TARGET = np.array([1.0, -5.0, 2.0]), np.zeros(3)


def view(orthographic: bool = False, near: float = 0.1, far: float = 100.0) -> View:
    return look_at(EYE, TARGET, 64, 48, 0.8, near, far, orthographic)


@pytest.mark.parametrize("orthographic", [False, True])
def test_a_projection_tells_its_range(orthographic: bool) -> None:
    assert view(orthographic).clip_range == pytest.approx((0.1, 100.0))
    other = replace(view(orthographic), view_to_clip=with_depths(view(orthographic).view_to_clip, 2.0, 30.0))
    assert other.clip_range == pytest.approx((2.0, 30.0))
    assert other.focal_pixels == view(orthographic).focal_pixels


def test_a_range_may_be_endless() -> None:
    endless = replace(view(), view_to_clip=with_depths(view().view_to_clip, 0.5, np.inf))
    assert endless.clip_range == (0.5, np.inf)


def test_what_is_exact_goes_before_what_the_projection_says() -> None:
    assert replace(view(), clip=(1e-6, 1e7)).clip_range == (1e-6, 1e7)


def test_an_ordinary_view_is_left_as_it_is() -> None:
    for plain in (view(), view(near=0.01, far=1000.0), view(True)):
        assert plain.fitted(1.0, 20.0) is plain


def test_a_deep_view_is_fitted_to_what_is_there() -> None:
    deep = view(near=1e-6, far=1e7).fitted(1.0, 20.0)
    assert deep.linear_depth == 0.0
    near, far = (np.linalg.inv(deep.view_to_clip) @ [0.0, 0.0, z, 1.0] for z in (-1.0, 1.0))
    assert (-near[2] / near[3], -far[2] / far[3]) == pytest.approx((1.0, 20.0))
    assert deep.clip_range == pytest.approx((1e-6, 1e7), rel=1e-2)


def test_amid_things_depths_are_linear() -> None:
    deep = view(near=1e-6, far=1e7).fitted(0.0, 20.0)
    assert deep.linear_depth == 20.0 and deep.clip_range[0] == pytest.approx(1e-6)
    # What is nearer than its projection's near end is not outside of the view.
    point = np.linalg.inv(deep.world_to_view) @ [0.0, 0.0, -1e-5, 1.0]
    clip = deep.world_to_volume @ point
    assert (np.abs(clip[:3]) <= clip[3]).all()
    clip = deep.world_to_clip @ point
    assert clip[2] < -clip[3]


def test_an_empty_range_still_makes_a_projection() -> None:
    assert np.isfinite(np.linalg.inv(view(near=1e-6, far=1e7).fitted(50.0, 20.0).world_to_clip)).all()


@pytest.mark.parametrize("orthographic", [False, True])
def test_a_moved_world_is_seen_alike(orthographic: bool) -> None:
    origin = np.array([1e7, -3e5, 12.5])
    here = view(orthographic)
    there = here.about(-origin)
    points = np.random.default_rng(1).normal(size=(20, 3))
    assert np.abs(there.project(points + origin) - here.project(points)).max() < 1e-4
    assert np.abs(there.about(origin).world_to_view - here.world_to_view).max() < 1e-8
    assert np.abs(there.place - origin - here.place).max() < 1e-8
    assert here.about(np.zeros(3)) is here


def test_lines_of_sight_begin_at_the_near_end() -> None:
    start = view(near=0.5).start
    assert np.linalg.norm(start[:3] - EYE) == pytest.approx(0.5)
    assert np.linalg.norm(np.cross(start[:3] - EYE, TARGET - EYE)) < 1e-12
    assert (start[:3] - EYE) @ (TARGET - EYE) > 0.0


@pytest.mark.parametrize("orthographic", [False, True])
def test_a_line_of_sight_is_seen_where_it_was_asked_for(orthographic: bool) -> None:
    looking = view(orthographic)
    for place in ((0.5, 0.5), (40.25, 7.5), (63.5, 47.5)):
        origin, direction = looking.line_of_sight(*place)
        assert np.linalg.norm(direction) == pytest.approx(1.0)
        seen = looking.project(np.array([origin, origin + 3.0 * direction, origin + 50.0 * direction]))
        np.testing.assert_allclose(seen, [place] * 3, atol=1e-6)
        assert -(looking.world_to_view @ [*origin, 1.0])[2] == pytest.approx(0.1)
