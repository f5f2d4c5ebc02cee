# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors from bytes, attributes, nodes, lamps and the sky are Cycles' in every working space of a file."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.renderer import Renderer
from curvrefl.curvrefl_addon.report.cycles_reference import render_reference
from curvrefl.curvrefl_addon.scene.extract import extract_scene
from curvrefl.curvrefl_addon.scene.materials.color_spaces import luminance_weights, rec709_to_scene, scene_to_rec709
from curvrefl.curvrefl_addon.scene.opened.blend_file import find_reflectors, view_of_camera
from curvrefl.curvrefl_addon.settings_table import Settings
from scenes.file_settings.colored_cards import CARDS, build_cards

pytestmark = pytest.mark.usefixtures("gpu")

WIDTH, HEIGHT = 96, 32


@pytest.mark.parametrize("space", ["Linear Rec.709", "Linear Rec.2020", "ACEScg"])
def test_cards_under_sun_and_sky_are_those_of_cycles(space: str) -> None:
    scene = build_cards(space)
    expected = render_reference(scene, bpy.context.view_layer, WIDTH, HEIGHT, 32).pixels
    arrays = extract_scene(bpy.context.evaluated_depsgraph_get(), scene, find_reflectors(scene, ["mirror"]))
    renderer = Renderer(arrays, Settings(method="exact", samples=4))
    found = renderer.render(view_of_camera(scene, scene.camera, WIDTH, HEIGHT)).color()
    renderer.free()
    step = WIDTH // len(CARDS)
    for number, card in enumerate(CARDS):
        middle = np.s_[HEIGHT // 2 - 3 : HEIGHT // 2 + 3, number * step + 5 : number * step + step - 5, :3]
        one, other = found[middle].mean(axis=(0, 1)), expected[middle].mean(axis=(0, 1))
        assert one == pytest.approx(other, rel=0.02), card
    assert found[1, :, :3].mean(axis=0) == pytest.approx(expected[1, :, :3].mean(axis=0), rel=1e-3), "sky"


def test_the_way_to_rec709_and_back() -> None:
    colors = np.random.default_rng(2).uniform(0.0, 3.0, (5, 4, 4)).astype(np.float32)
    build_cards("Linear Rec.709")
    assert rec709_to_scene(colors) is colors and scene_to_rec709(colors) is colors
    build_cards("ACEScg")
    there = rec709_to_scene(colors)
    assert np.abs(there - colors)[..., :3].max() > 0.1
    assert np.array_equal(there[..., 3], colors[..., 3])
    assert scene_to_rec709(there) == pytest.approx(colors, abs=2e-5)
    # Luminance does not depend on the space that a color is written in.
    assert there[..., :3] @ luminance_weights() == pytest.approx(colors[..., :3] @ [0.2126, 0.7152, 0.0722], abs=1e-3)
