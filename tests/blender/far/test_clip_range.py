# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a camera sees does not depend on how far apart the ends of its range are, and it ends where it says."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.frame import Frame
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from scenes import placed_room

pytestmark = pytest.mark.usefixtures("gpu")
CASES = (("exact", False), ("exact", True), ("newton", True), ("environment_cube_vertex", True))
"""Method, and whether the eye is within an object's box"""
LAYER = 0.001
"""Meters between the layers of a wall ten meters away"""


def rendered(
    start: float, end: float, method: str = "exact", orthographic: bool = False, eye_in_box: bool = False
) -> Frame:
    ball = placed_room.build()
    camera = bpy.data.cameras["Eye"]
    camera.clip_start, camera.clip_end = start, end
    if orthographic:
        camera.type, camera.ortho_scale = "ORTHO", 12.0
    for number, color in enumerate(((0.9, 0.1, 0.1), (0.1, 0.9, 0.1))):
        # Two boards, one close behind the other as the eye sees them.
        bpy.ops.mesh.primitive_plane_add(size=3.0, rotation=(np.pi / 2.0, 0.0, 0.0))
        placed_room.placed_object(
            (-4.0, -0.5 + LAYER * number, 4.0), placed_room.material(f"Board {number}", color), "Board"
        )
    if eye_in_box:
        # A net around the eye, so that no box is away from it.
        bpy.ops.mesh.primitive_cube_add(size=40.0)
        placed_room.placed_object((0.0, 0.0, 10.0), placed_room.material("Hall", (0.3, 0.3, 0.3)), "Hall")
    scene, view = placed_room.read(ball)
    return Renderer(scene, Settings(method=method, samples=1)).render(view)


def share_off(one: Frame, other: Frame) -> float:
    return float((np.abs(one.color() - other.color()).max(axis=-1) > 0.02).mean())


@pytest.fixture(scope="module")
def ordinary(gpu: None) -> Iterator[dict[tuple[str, bool], Frame]]:
    yield {(method, inside): rendered(1.0, 60.0, method, eye_in_box=inside) for method, inside in CASES}


@pytest.mark.parametrize(("method", "eye_in_box"), CASES)
def test_any_range_gives_the_same_picture(
    method: str, eye_in_box: bool, ordinary: dict[tuple[str, bool], Frame]
) -> None:
    frame = rendered(1e-6, 1e7, method, eye_in_box=eye_in_box)
    assert share_off(frame, ordinary[method, eye_in_box]) <= 0.002
    assert (frame.reflection.view.linear_depth > 0.0) == eye_in_box


def test_parallel_views_are_as_exact() -> None:
    assert share_off(rendered(1e-6, 1e7, orthographic=True), rendered(1.0, 60.0, orthographic=True)) <= 0.002


@pytest.mark.parametrize("eye_in_box", [False, True])
@pytest.mark.parametrize(("start", "end"), [(9.0, 60.0), (1.0, 11.0)])
def test_it_ends_where_it_says(
    start: float, end: float, eye_in_box: bool, ordinary: dict[tuple[str, bool], Frame]
) -> None:
    """The same with the other end as far as can be, and nothing is seen beyond either."""
    plain = rendered(start, end, eye_in_box=eye_in_box)
    deep = rendered(start if start > 1.0 else 1e-6, end if end < 60.0 else 1e8, eye_in_box=eye_in_box)
    assert share_off(plain, deep) <= 0.002
    view = deep.view
    position = deep.surfaces["seen_position"]
    seen = position[..., 3] > 0.0
    assert seen.mean() > 0.05
    ahead = -(position[seen][:, :3] @ view.world_to_view[2, :3] + view.world_to_view[2, 3])
    assert start - 1e-3 <= ahead.min() and ahead.max() <= end + 1e-3
    # Something was cut off.
    assert share_off(deep, ordinary["exact", eye_in_box]) > 0.01


def test_an_ordinary_range_is_left_as_it_is() -> None:
    for near, far in ((0.1, 1000.0), (0.01, 1000.0)):
        assert rendered(near, far).reflection.view.linear_depth == 0.0
