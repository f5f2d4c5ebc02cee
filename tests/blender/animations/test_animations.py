# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The papers' animations: each has what is said of it, the same each time, and its camera gets where it should."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.scene.extract import extract_scene  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.blend_file import find_camera, view_of_camera  # noqa: E402
from scenes.animations.films import ANIMATIONS, Animation  # noqa: E402
from scenes.animations.stage import FRAMES, reflected_vertices  # noqa: E402

WIDTH, HEIGHT = 80, 60


@pytest.fixture(scope="module", params=ANIMATIONS)
def film(request: pytest.FixtureRequest, gpu: None) -> Iterator[Animation]:
    """Each of them, built."""
    animation = ANIMATIONS[request.param]
    animation.build()
    yield animation
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


def pixels_of_mirrors(animation: Animation, frame: int) -> dict[str, int]:
    """How many pixels show each mirror."""
    scene: Any = bpy.context.scene
    scene.frame_set(frame)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    arrays = extract_scene(depsgraph, scene, [bpy.data.objects[name] for name in animation.mirrors])
    view = view_of_camera(scene, find_camera(scene), WIDTH, HEIGHT, depsgraph)
    renderer = Renderer(arrays, Settings(method="exact"))
    try:
        seen = renderer.surfaces_of(renderer.reflect(view, solve=False))["seen_color"][..., 3]
        numbers = {mirror.object_name: mirror.number for mirror in renderer.mirrors}
    finally:
        renderer.free()
    return {name: int((np.rint(seen) == numbers[name]).sum()) for name in animation.mirrors}


def test_it_has_the_vertices_and_frames_that_are_said(film: Animation) -> None:
    assert reflected_vertices(film.mirrors) == film.vertices
    scene = bpy.context.scene
    assert (scene.frame_start, scene.frame_end, scene.render.fps) == (1, FRAMES, 24)


def test_its_mirrors_are_in_the_picture_from_the_first_frame_to_the_last(film: Animation) -> None:
    for frame in (1, FRAMES):
        seen = pixels_of_mirrors(film, frame)
        assert min(seen.values()) >= 4, (frame, seen)


def test_the_kitchen_s_pot_fills_the_picture_at_the_end(gpu: None) -> None:
    kitchen = ANIMATIONS["kitchen"]
    kitchen.build()
    assert pixels_of_mirrors(kitchen, 1)["Pot"] < 0.1 * WIDTH * HEIGHT
    assert pixels_of_mirrors(kitchen, FRAMES)["Pot"] > 0.95 * WIDTH * HEIGHT
