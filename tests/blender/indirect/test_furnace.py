# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes where light is the same everywhere, whatever stands in them: what there is can be said beforehand."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object
from curvrefl.curvrefl_addon.demo.shapes import ball
from indirect.places import (
    Shown,
    add_box,
    add_mirror,
    at_rest,
    gray,
    matte,
    moving,
    read,
    rendered,
    start,
    without_bounces,
    world_of,
)

pytestmark = pytest.mark.usefixtures("gpu")


def means(shown: Shown) -> tuple[float, float]:
    """Over the mirror, and over all else."""
    return float(shown.picture[shown.is_mirror].mean()), float(shown.picture[shown.is_thing].mean())


def closed_box(size: float, albedo: float, bounces: int) -> None:
    """All of it shines as strongly, a block in it and a mirror ball."""
    start(bounces)
    shining = matte(gray(albedo), gray(1.0))
    half = 0.5 * size
    add_box("room", [-half] * 3, [half] * 3, shining, inward=True)
    add_box("block", [0.1 * size, 0.1 * size, -half], [0.3 * size, 0.3 * size, -0.2 * size], shining)
    add_mirror(size / 10.0)
    add_camera((0.0, -0.45 * size, 0.0), (0.0, 0.0, 0.0), 28.0, clip=(size / 1000.0, 10.0 * size))


@pytest.mark.parametrize("size", [0.04, 4.0, 400.0])
@pytest.mark.parametrize(("albedo", "bounces"), [(0.5, 1), (0.5, 4)])
def test_closed_box_shines_as_the_series_says(size: float, albedo: float, bounces: int) -> None:
    """Each bounce adds one term; what the last one meets is still lit."""
    closed_box(size, albedo, bounces)
    expected = sum(albedo**k for k in range(bounces + 2))
    in_mirror, outside = means(at_rest())
    assert in_mirror == pytest.approx(expected, rel=0.01)
    assert outside == pytest.approx(expected, rel=0.01)


def test_light_box_of_many_bounces() -> None:
    closed_box(4.0, 0.8, 8)
    expected = sum(0.8**k for k in range(10))
    in_mirror, outside = means(at_rest())
    assert in_mirror == pytest.approx(expected, rel=0.01)
    assert outside == pytest.approx(expected, rel=0.01)


def test_closed_box_while_the_view_moves() -> None:
    """Patches have the same light; the last bounce is theirs."""
    closed_box(4.0, 0.5, 4)
    in_mirror, outside = means(moving(*read()))
    assert in_mirror == pytest.approx(1.96875, rel=0.02)
    assert outside == pytest.approx(1.96875, rel=0.02)


def even_light(size: float = 1.0) -> None:
    """What a surface does not send on of an even world's light it has of its own: all is white, in all corners. An
    open box of colored walls, a block, a ball and a mirror."""
    start(4)
    world_of(gray(1.0))

    def made(*color: float) -> object:
        return matte((color[0], color[1], color[2]), (1.0 - color[0], 1.0 - color[1], 1.0 - color[2]))

    walls = [
        ("floor", (-2, -2, -0.1), (2, 2, 0), made(0.3, 0.3, 0.3)),
        ("left", (-2.1, -2, 0), (-2, 2, 3), made(0.5, 0.1, 0.1)),
        ("right", (2, -2, 0), (2.1, 2, 3), made(0.1, 0.5, 0.1)),
        ("back", (-2, 2, 0), (2, 2.1, 3), made(0.4, 0.4, 0.1)),
        ("block", (0.8, -0.8, 0), (1.6, 0, 1.2), made(0.2, 0.3, 0.5)),
    ]
    for name, low, high, material in walls:
        add_box(name, size * np.array(low), size * np.array(high), material)  # type: ignore[arg-type]
    place = size * np.array([-1.0, -0.8, 0.4])
    add_object("ball", ball(0.4 * size, 32), made(0.0, 0.4, 0.4), True, place.tolist())  # type: ignore[arg-type]
    add_mirror(0.7 * size, (0.0, 0.6 * size, 0.7 * size))
    add_camera((0.0, -5.0 * size, 1.6 * size), (0.0, 0.0, 1.0 * size), 40.0, clip=(0.01 * size, 100.0 * size))


def test_even_light_has_no_corners() -> None:
    """Of the whole picture and of each part: what a corner is short of or has too much would be seen."""
    even_light()
    shown = at_rest(64)
    assert shown.picture[shown.is_mirror].mean() == pytest.approx(1.0, rel=0.01)
    assert shown.picture[shown.is_thing].mean() == pytest.approx(1.0, rel=0.01)
    height, width = shown.is_thing.shape
    blocks = shown.picture.reshape(height // 12, 12, width // 12, 12, 3).mean(axis=(1, 3))
    assert np.abs(blocks - 1.0).max() < 0.04


def test_even_light_while_the_view_moves() -> None:
    even_light()
    shown = moving(*read())
    assert shown.picture[shown.is_thing].mean() == pytest.approx(1.0, rel=0.02)
    assert shown.picture[shown.is_mirror].mean() == pytest.approx(1.0, rel=0.02)


def test_ball_alone_under_an_even_world_is_as_without_bounces() -> None:
    """There is nothing that it could send light to."""
    start(4)
    world_of(gray(1.0))
    add_object("ball", ball(1.0, 64), matte(gray(0.7)), True)
    add_mirror(0.1, (3.0, 0.0, 0.0))
    add_camera((0.0, -5.0, 0.0), (0.0, 0.0, 0.0), 50.0)
    arrays, view = read()
    bare, lit = rendered(without_bounces(arrays), view), rendered(arrays, view)
    middle = lit.is_thing & (np.linalg.norm(lit.position[..., [0, 2]], axis=-1) < 0.9)
    assert lit.mean(middle) == pytest.approx(0.7, rel=0.01)
    assert lit.mean(middle) == pytest.approx(bare.mean(middle), rel=0.01)
