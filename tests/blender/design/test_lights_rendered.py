# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights placed by a pixel do there in pictures what was asked for: by rays, and in Cycles."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon import registration
from curvrefl.curvrefl_addon.demo.data_blocks import add_camera, add_object, set_world_color, start_empty_scene
from curvrefl.curvrefl_addon.demo.kettle import add_kettle
from curvrefl.curvrefl_addon.demo.materials import matte
from curvrefl.curvrefl_addon.demo.shapes import ball, plane
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.scene.extract import extract_scene
from curvrefl.curvrefl_addon.scene.opened.blend_file import view_of_camera

pytestmark = pytest.mark.usefixtures("gpu")

WIDTH, HEIGHT = 160, 120
RADIUS = 0.05
CENTER = np.array((0.16, 0.02, RADIUS))
"""Of the matt ball on the table"""


@pytest.fixture(scope="module")
def lamp(gpu: None) -> Iterator[Any]:
    """A small ball of light, active, in the dark with the demo's kettle, a matt ball and the table that they are on."""
    scene: Any = start_empty_scene()
    registration.register()
    set_world_color((0.0, 0.0, 0.0))
    add_kettle().curvrefl.is_mirror = True
    gray = matte("Gray", (0.6, 0.6, 0.6), roughness=1.0)
    add_object("Table", plane((2.0, 2.0)), gray)
    add_object("Ball", ball(RADIUS, 64), gray, smooth=True, location=tuple(CENTER.tolist()))
    add_camera(eye=(0.33, -0.63, 0.3), target=(0.04, 0.0, 0.07), lens=60)
    light: Any = bpy.data.lights.new("Lamp", "POINT")
    light.energy, light.use_soft_falloff = 0.2, False
    lamp = bpy.data.objects.new("Lamp", light)
    scene.collection.objects.link(lamp)
    bpy.context.view_layer.objects.active = lamp
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    yield lamp
    registration.unregister()


def pictures(view: View) -> dict[str, np.ndarray]:
    """Radiance (h, w), row 0 at the bottom."""
    scene = extract_scene(bpy.context.evaluated_depsgraph_get(), bpy.context.scene, [bpy.data.objects["Kettle"]])
    renderer = Renderer(scene, Settings(method="exact", samples=16))
    ours = renderer.render(view).color()
    renderer.free()
    cycles = render_reference(bpy.context.scene, bpy.context.view_layer, WIDTH, HEIGHT, 16).pixels
    return {name: picture[..., :3].mean(axis=-1) for name, picture in (("exact", ours), ("cycles", cycles))}


def placed(lamp: Any, mode: str, pixel: tuple[float, float], radius: float, distance: float, **more: Any) -> View:
    lamp.data.shadow_soft_size = radius
    assert bpy.ops.curvrefl.place_light(mode=mode, pixel=pixel, keep_distance=False, distance=distance, **more) == {
        "FINISHED"
    }
    bpy.context.view_layer.update()
    return view_of_camera(bpy.context.scene, bpy.context.scene.camera, WIDTH, HEIGHT)


@pytest.mark.parametrize("pixel", [(60.5, 62.5), (92.5, 55.5)])
def test_its_reflection_is_at_the_pixel(lamp: Any, pixel: tuple[float, float]) -> None:
    view = placed(lamp, "REFLECTION", pixel, radius=0.02, distance=0.5)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    for name, picture in pictures(view).items():
        near = np.where(np.hypot(x - pixel[0], y - pixel[1]) < 8.0, picture, 0.0)
        lit = np.where(near > 0.05 * near.max(), near, 0.0)
        assert near.max() > 20.0 * np.median(picture) and near.max() > 1.0, name
        center = np.array([(x * lit).sum(), (y * lit).sum()]) / lit.sum()
        assert np.linalg.norm(center - pixel) < 0.5, f"{name}: {center}"


def test_its_light_is_strongest_at_the_pixel(lamp: Any) -> None:
    looking = view_of_camera(bpy.context.scene, bpy.context.scene.camera, WIDTH, HEIGHT)
    column, row = np.floor(looking.project(np.array([[0.12, -0.17, 0.0]]))[0])
    pixel = (column + 0.5, row + 0.5)
    view = placed(lamp, "ILLUMINATION", pixel, radius=0.0005, distance=0.03)
    for name, picture in pictures(view).items():
        row, column = np.unravel_index(picture.argmax(), picture.shape)
        assert np.hypot(column + 0.5 - pixel[0], row + 0.5 - pixel[1]) <= 1.0, name


def test_the_edge_is_brightest_and_dark_inside(lamp: Any) -> None:
    pixel = (134.5, 60.5)
    view = placed(lamp, "RIM", pixel, radius=0.001, distance=0.3, rim_width=0.4)
    rows, columns = np.mgrid[0:HEIGHT, 0:WIDTH]
    lines = [view.line_of_sight(x + 0.5, y + 0.5) for x, y in zip(columns.ravel(), rows.ravel(), strict=True)]
    origin, direction = (np.array(part).reshape(HEIGHT, WIDTH, 3) for part in zip(*lines, strict=True))
    away = np.linalg.norm(np.cross(CENTER - origin, direction), axis=-1) / RADIUS
    """From the ball's middle: 1 on its edge"""
    inside = away < 0.97
    middle = view.project(CENTER[None])[0]
    for name, picture in pictures(view).items():
        brightest = np.unravel_index(np.where(inside, picture, 0.0).argmax(), picture.shape)
        assert away[brightest] > 0.9, name
        # Its light ends where the normal is 0.4 from the edge's.
        assert picture[away < np.cos(0.45)].max() < 0.02 * picture[brightest], name
        # The crescent is even about the way from the middle to the cursor.
        weights = np.where(away < 1.0, picture, 0.0)
        along = np.array([(weights * (columns + 0.5 - middle[0])).sum(), (weights * (rows + 0.5 - middle[1])).sum()])
        asked = np.array(pixel) - middle
        assert along @ asked > 0.98 * np.linalg.norm(along) * np.linalg.norm(asked), name
