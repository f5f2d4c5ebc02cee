# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Caustics wherever they are seen, of all lamps, through glass, and as the scene changes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from caustics.stage import CHROME_THING, GLASS_THING, WHITE_THING, Stage, drawn, irradiance, round_mesh
from curvrefl.curvrefl_addon.optics.caustics import RoundMirror
from curvrefl.curvrefl_addon.renderer.lighting.lighting import CAUSTICS
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.renderer.settings import Settings
from curvrefl.curvrefl_addon.scene.arrays import LightArrays
from curvrefl.curvrefl_addon.scene.meshes.made import quad_mesh
from scenes.views import look_at

pytestmark = pytest.mark.usefixtures("gpu")
DISH = RoundMirror("PARABOLOID", 4.0, 1.0)
PLANE = 0.8
SIDE_VIEW = look_at(np.array([0.0, -6.0, -0.4]), np.array([0.0, 0.0, 0.4]), 96, 72, 0.5)
SQUARE = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])


def dish_stage(*lights: LightArrays) -> Stage:
    """A dish that throws light on the lower side of a screen."""
    stage = Stage(lights) if lights else Stage()
    stage.add(round_mesh(DISH, 48, 96), CHROME_THING, visible_camera=False, visible_glossy=False)
    stage.add_screen(PLANE, 0.8)
    return stage


def test_seen_in_a_mirror() -> None:
    """What a flat mirror shows of a screen is as bright as the screen."""
    stage = dish_stage()
    upright = SQUARE[:, [0, 2, 1]] * (3.0, 1.0, 3.0)
    stage.add(quad_mesh("wall", upright, (0.0, -1.0, 0.0)), CHROME_THING, (0.0, 2.5, 0.0), visible_diffuse=False)
    frame = drawn(stage.arrays(), SIDE_VIEW)
    shown = (frame.reflected_object() == 2) & (frame.mask() > 0)
    place = frame.reflected_position()[shown]
    radius = np.linalg.norm(place[:, :2], axis=1).astype(np.float64)
    lit = (radius < 0.58) & (radius > 0.05)
    assert lit.sum() > 20
    found = np.pi * frame.color()[..., 0][shown][lit]
    np.testing.assert_allclose(found, DISH.irradiance(radius[lit], PLANE), rtol=0.02)
    assert found.min() > 1.5


def test_point_lamp() -> None:
    """A flat mirror shows a lamp as if it stood behind it."""
    lamp = np.eye(4)
    lamp[:3, 3] = 0.0, 0.0, 1.0
    stage = Stage((LightArrays("lamp", "POINT", (40.0, 40.0, 40.0), lamp),))
    stage.add(quad_mesh("flat", 0.5 * SQUARE, (0.0, 0.0, 1.0)), CHROME_THING, visible_camera=False)
    stage.add_screen(2.0, 1.5)
    frame = drawn(stage.arrays(), look_at(np.array([0.0, -1e-3, -2.0]), np.array([0.0, 0.0, 2.0]), 96, 96, 0.7))
    place = frame.surfaces["seen_position"].astype(np.float64)[..., :3]
    intensity = 40.0 / (4.0 * np.pi)
    # Without the mirror the lamp itself lights the screen: from 1 m below it; its image is 3 m below.
    away = np.stack([np.linalg.norm(place - (0.0, 0.0, z), axis=2) for z in (1.0, -1.0)])
    direct, thrown = intensity * np.array([1.0, 3.0])[:, None, None] / away**3
    inside = np.abs(place[..., :2]).max(axis=2) < 1.4
    np.testing.assert_allclose(irradiance(frame)[inside], (direct + thrown)[inside], rtol=0.01)
    assert inside.sum() > 500


@pytest.mark.parametrize(
    "lamp",
    [
        LightArrays("spot", "SPOT", (90.0, 60.0, 30.0), np.eye(4), radius=0.1, spot_angle=1.2, spot_blend=0.5),
        LightArrays("area", "AREA", (90.0, 60.0, 30.0), np.eye(4), size=(0.6, 0.3)),
    ],
)
def test_soft_lamps(lamp: LightArrays) -> None:
    """Over a flat mirror, which they shine down on, they light a screen above as from behind it."""
    lamp = replace(lamp, visible_camera=False)
    above, behind = np.eye(4), np.diag([1.0, -1.0, -1.0, 1.0])
    above[2, 3], behind[2, 3] = 1.0, -1.0
    view = look_at(np.array([0.0, -1e-3, -2.0]), np.array([0.0, 0.0, 2.0]), 64, 64, 0.6)
    thrown = Stage((replace(lamp, matrix=above),))
    thrown.add(quad_mesh("flat", 4.0 * SQUARE, (0.0, 0.0, 1.0)), CHROME_THING, visible_camera=False)
    direct = Stage((replace(lamp, matrix=behind),))
    for stage in (thrown, direct):
        stage.add_screen(2.0, 2.0)
    found, expected = (
        drawn(stage.arrays(), view, samples=16, caustic_patches=8192).color() for stage in (thrown, direct)
    )
    # (Over blocks of as many pixels as a patch lights.)
    found, expected = (part[..., :3].reshape(8, 8, 8, 8, 3).mean(axis=(1, 3)) for part in (found, expected))
    assert expected.min() > 0.005
    np.testing.assert_allclose(found, expected, rtol=0.03)


def test_through_glass() -> None:
    """Under a pane of glass as much light arrives as two interfaces let through, where there was shadow."""
    stage = Stage()
    for height, up in ((1.0, 1.0), (0.9, -1.0)):
        corners = SQUARE if up > 0.0 else SQUARE[::-1]
        stage.add(
            quad_mesh("face", corners * 3.0, (0.0, 0.0, up)), GLASS_THING, (0.0, 0.0, height), visible_camera=False
        )
    stage.add(quad_mesh("floor", SQUARE * 3.0, (0.0, 0.0, 1.0)), WHITE_THING)
    view = look_at(np.array([0.0, -1.0, 0.8]), np.zeros(3), 64, 48, 0.6)
    frame = drawn(stage.arrays(), view, samples=16, caustic_patches=4096)
    # (1 - F) / (1 + F) with F = 0.04, all that goes back and forth in the pane counted
    assert irradiance(frame).mean() == pytest.approx(0.96 / 1.04, rel=0.015)


def test_follows_the_scene() -> None:
    scene = dish_stage().arrays()
    renderer = Renderer(scene, Settings(method="exact", samples=1, caustics=True))
    first = renderer.render(SIDE_VIEW).color()
    aside = np.array(scene.instances[0].matrix)
    aside[0, 3] = 0.5
    moved = replace(scene, instances=(replace(scene.instances[0], matrix=aside), *scene.instances[1:]))
    renderer.update(moved)
    there = renderer.render(SIDE_VIEW).color()
    renderer.update(scene)
    np.testing.assert_array_equal(renderer.render(SIDE_VIEW).color(), first)
    lit, lit_there = first[..., 0] > 0.3, there[..., 0] > 0.3
    columns = np.arange(lit.shape[1])
    middles = [(mask.sum(axis=0) * columns).sum() / mask.sum() for mask in (lit, lit_there)]
    assert middles[1] > middles[0] + 4.0
    # Switched off they cost nothing, and leave nothing.
    renderer.configure(Settings(method="exact", samples=1))
    assert CAUSTICS not in renderer._appearance.lighting.features
    dark = renderer.render(SIDE_VIEW)
    assert dark.color()[..., :3].max() == 0.0
    assert "caustics" not in dark.bounced_light
    renderer.free()


def test_viewport_makes_them_by_and_by() -> None:
    """A coarse map first; once all is there the picture is that of a render."""
    scene = dish_stage().arrays()
    settings = Settings(method="exact", samples=1, caustics=True, caustic_patches=4096)
    gradual = Renderer(scene, settings, is_gradual=True)
    gradual.render(SIDE_VIEW)
    steps = 0
    while gradual.is_loading:
        assert gradual.loading in ("caustics", "light between surfaces", "materials and images")
        gradual.load_some(0.0)
        steps += 1
    assert steps > 3
    at_once = Renderer(scene, settings)
    np.testing.assert_array_equal(gradual.render(SIDE_VIEW).color(), at_once.render(SIDE_VIEW).color())
    gradual.free()
    at_once.free()
