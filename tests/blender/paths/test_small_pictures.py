# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A small sample of what tools/measure/paths measures: rough, layered, glassy and leafy surfaces against Cycles."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from curvrefl.curvrefl_addon.report.metrics import flip_in_mask, missing_flip
from scenes.paths import SCENES
from scenes.paths.alpha import emitting_leaves
from scenes.paths.furnace import FURNACE_WORLD
from scenes.paths.judged import Opened, cycles_picture, inner, judged_numbers, judged_pixels, layered_picture, read_open
from scenes.paths.one_sample import centers, wrong_pixels
from scenes.paths.registry import OBJECT

pytestmark = pytest.mark.usefixtures("gpu")
SIZE = (80, 60)
REFERENCE_SAMPLES = 192


def small(build: Callable[[], None], mirrors: tuple[str, ...], size: tuple[int, int] = SIZE) -> Opened:
    """Builds the scene and reads it, so large."""
    build()
    scene: Any = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = size
    return read_open(mirrors)


# Bounds are of 16 sub-frames: FLIP a third above what is found; the mean color a hundredth off, or what noise makes of
# the darkest channel and of glints of the sun.
@pytest.mark.parametrize(
    ("name", "most", "most_off"),
    [
        ("metal_03", 0.05, 0.01),
        ("metal_05", 0.047, 0.01),
        ("brushed_03", 0.053, 0.01),
        ("gltf", 0.056, 0.03),
        ("glass_ball", 0.088, 0.025),
        ("window_thin", 0.036, 0.01),
        ("absorbing_block", 0.048, 0.025),
        ("leaves_hashed", 0.05, 0.01),
        ("foil_mixed", 0.03, 0.01),
    ],
)
def test_pictures_are_those_of_cycles(name: str, most: float, most_off: float) -> None:
    if missing := missing_flip():
        pytest.skip(missing)
    scene = SCENES[name]
    opened = small(scene.build, scene.mirrors)
    shoot = layered_picture if scene.layered else cycles_picture
    truth, mask = shoot(REFERENCE_SAMPLES, 1), judged_pixels(scene.judged)
    ours, warnings = opened.picture(16)
    assert not [warning for warning in warnings if "not shown" in warning]
    means = ours[mask][:, :3].mean(0) / truth[mask][:, :3].mean(0)
    assert np.abs(means - 1.0).max() < most_off
    flip = flip_in_mask(ours, truth, mask)
    assert flip is not None and flip < most


def test_leaves_by_clip_are_where_cycles_has_them() -> None:
    opened = small(emitting_leaves, (OBJECT,), (144, 112))
    wrong = wrong_pixels(opened.picture(1)[0], centers())
    assert wrong.sum() == 0


@pytest.mark.parametrize("name", ["furnace_metallic", "furnace_glass"])
def test_white_furnaces_stay_white(name: str) -> None:
    scene = SCENES[name]
    scene.build()
    opened = read_open(scene.mirrors)
    ours, _ = opened.picture(64)
    numbers = judged_numbers(scene.mirrors)
    for number, thing in enumerate(scene.mirrors, 1):
        share = ours[inner(numbers == number)][:, :3].mean() / FURNACE_WORLD
        assert abs(share - 1.0) < 0.005, f"{thing}: {share:.4f}"


@pytest.mark.parametrize("name", ["metal_03", "glass_ball"])
def test_a_picture_is_the_same_bits_again(name: str) -> None:
    opened = small(SCENES[name].build, SCENES[name].mirrors, (40, 30))
    first, second = opened.picture(4)[0], opened.picture(4)[0]
    assert np.isfinite(first).all() and (first == second).all()
