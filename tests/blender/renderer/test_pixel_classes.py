# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Classes of pixels out of surface buffers, pictures of mirrors alone, and shaders of what a scene is lit by."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid
from curvrefl.curvrefl_addon.renderer.device.textures import read_texture, texture_2d
from curvrefl.curvrefl_addon.renderer.lighting.lighting import FEATURES
from curvrefl.curvrefl_addon.renderer.renderer import Renderer, union
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas
from curvrefl.curvrefl_addon.renderer.surfaces.pixel_classes import CLASS_COUNT, PixelClass, PixelClasses
from curvrefl.curvrefl_addon.scene.arrays import LightArrays, SceneArrays, WorldArrays
from scenes.mirror_room import Room
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
VIEW = look_at(np.array([0.0, -4.5, 2.0]), np.zeros(3), 96, 72, np.radians(40))


def buffer(object_id: float, shown: float) -> Any:
    """A surface buffer of one pixel; `shown`: alpha of its color."""

    def pixel(*values: float) -> Any:
        return texture_2d(np.array([[values]], np.float32))

    return SimpleNamespace(
        position=pixel(0.0, 0.0, 0.0, object_id),
        color=pixel(1.0, 1.0, 1.0, shown),
    )


BACKGROUND = (0.0, 0.0)
FLOOR = (3.0, -1.0)
HOLDOUT = (3.0, -2.0)
MIRROR = (4.0, 1.0)


@pytest.mark.parametrize(
    ("seen", "reflected", "expected"),
    [
        (BACKGROUND, BACKGROUND, PixelClass.BACKGROUND),
        (FLOOR, BACKGROUND, PixelClass.SURFACE),
        (HOLDOUT, BACKGROUND, PixelClass.NOTHING),
        (MIRROR, BACKGROUND, PixelClass.MIRROR),
        (MIRROR, FLOOR, PixelClass.MIRROR_OF_SURFACE),
        (MIRROR, None, PixelClass.MIRROR),
    ],
)
def test_finds_the_class(seen: tuple[float, ...], reflected: tuple[float, ...] | None, expected: PixelClass) -> None:
    classes = PixelClasses(1, 1)
    classes.sort(buffer(*seen), None if reflected is None else buffer(*reflected))
    with classes.frame_buffer.bind():
        depth = classes.frame_buffer.read_depth(0, 0, 1, 1)
    assert depth.to_list()[0][0] == expected / CLASS_COUNT


def room() -> SceneArrays:
    made = Room()
    made.add_mirror(Ellipsoid(0.8, 0.6, 0.7), 48)
    made.add_ball((1.3, -1.0, 0.2), 0.4)
    made.add_rectangle((0.0, 0.0, -0.9), (6.0, 0.0, 0.0), (0.0, 6.0, 0.0))
    return replace(made.arrays(), lights=(lamp("SUN"),), world=WorldArrays(color=(0.5, 0.6, 0.7)))


def lamp(kind: str) -> LightArrays:
    matrix = np.eye(4)
    matrix[:3, 3] = (0.5, -0.5, 4.0)
    strength = 3.0 if kind == "SUN" else 300.0
    return LightArrays(kind, kind, (strength,) * 3, matrix, radius=0.2, size=(0.5, 0.5), angle=0.02, spot_angle=1.5)


def picture(renderer: Renderer, mirrors_only: bool) -> np.ndarray:
    """(h, w, 4) of one sub-frame, over -1 where nothing is added."""
    canvas = Canvas.of_size(VIEW.width, VIEW.height)
    renderer.add_sub_frame(canvas, renderer.reflect(VIEW), 0, 1.0, mirrors_only=mirrors_only)
    return read_texture(canvas.texture)


@pytest.mark.parametrize("method", ["secant_star", "environment_cube"])
def test_mirrors_alone_are_those_of_the_whole_picture(method: str) -> None:
    """In their window only, after a whole picture has left other pixels there."""
    renderer = Renderer(room(), Settings(method=method, samples=1, environment_resolution=32))
    whole = picture(renderer, False)
    mirrors = picture(renderer, True)
    mask = renderer.render(VIEW).mask() > 0
    assert 0.05 < mask.mean() < 0.6
    assert (whole[..., 3] == 1.0).all()
    assert np.array_equal(mirrors[..., 3] == 1.0, mask)
    assert np.array_equal(mirrors[mask], whole[mask])
    assert (mirrors[~mask] == 0.0).all()
    renderer.free()


@pytest.mark.parametrize("kinds", [(), ("SUN",), ("POINT",), ("SPOT", "SUN"), ("AREA",)])
@pytest.mark.parametrize("world", [(0.0, 0.0, 0.0), (0.5, 0.6, 0.7)])
def test_shaders_of_the_scene_draw_what_shaders_of_all_scenes_do(
    kinds: tuple[str, ...], world: tuple[float, float, float]
) -> None:
    scene = replace(room(), lights=tuple(lamp(kind) for kind in kinds), world=WorldArrays(color=world))
    renderer = Renderer(scene, Settings(samples=1))
    lighting = renderer._appearance.lighting
    assert lighting.features < FEATURES
    assert {f"LIGHTING_{kind}" for kind in kinds} <= lighting.features
    assert ("LIGHTING_WORLD" in lighting.features) == (max(world) > 0.0)
    own = picture(renderer, False)
    assert (own[..., :3].max() > 0.0) == bool(kinds or max(world) > 0.0)
    lighting.features = FEATURES
    # (A sky of one color is written out, not looked up.)
    assert np.allclose(picture(renderer, False), own, rtol=1e-6, atol=1e-6)
    renderer.free()


def test_union_of_windows() -> None:
    assert union([]) == (0, 0, 0, 0)
    assert union([(5, 5, 0, 3)]) == (0, 0, 0, 0)
    assert union([(5, 6, 2, 3), (1, 20, 3, 4), (0, 0, 0, 9)]) == (1, 6, 6, 18)
