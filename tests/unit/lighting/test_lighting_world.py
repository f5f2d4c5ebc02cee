# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The world as a light, against integrals that are known."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.lighting.suns import split_suns
from curvrefl.curvrefl_addon.renderer.lighting.world import (
    MAP_SIZE,
    ROUGHNESS_LEVELS,
    WORLD_DEFINES,
    _sobol,
    image_directions,
    octahedral_directions,
    world_light,
)
from curvrefl.curvrefl_addon.scene.arrays import WorldArrays


def rotation_about_x(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]], np.float64)


def sky_with_sun(height: int = 128) -> tuple[np.ndarray, np.ndarray]:
    """An image of a dim sky and a small sun, and the sun's direction in the image."""
    directions, _ = image_directions(height, 2 * height)
    sun = np.array([0.6, -0.5, 0.62])
    sun /= np.linalg.norm(sun)
    image = np.where((directions @ sun > np.cos(0.05))[..., None], [300.0, 250.0, 200.0], [0.2, 0.3, 0.5])
    return image.astype(np.float32), sun


def test_equirectangular_axes_are_blenders() -> None:
    directions, solid_angles = image_directions(64, 128)
    assert np.allclose(directions[31:33, 63:65].mean(axis=(0, 1)), [1, 0, 0], atol=0.02)
    assert np.allclose(directions[31:33, 31:33].mean(axis=(0, 1)), [0, 1, 0], atol=0.02)
    assert directions[-1, 0, 2] > 0.99
    assert np.isclose(solid_angles.sum() * 128, 4 * np.pi)


def test_octahedral_border_is_folded_onto_itself() -> None:
    directions = octahedral_directions(MAP_SIZE)
    assert np.allclose(np.linalg.norm(directions, axis=-1), 1.0)
    assert np.allclose(directions[0], directions[0, ::-1], atol=1e-12)
    assert np.allclose(directions[:, -1], directions[::-1, -1], atol=1e-12)
    assert np.allclose(directions[0, 0], [0, 0, -1], atol=1e-12)


@pytest.mark.parametrize("start", range(0, 128, 16))
def test_sobol_runs_are_stratified(start: int) -> None:
    first, second = (axis[start : start + 16] for axis in _sobol(128))
    for power in range(5):
        cells = {(int(a * 2**power), int(b * 2 ** (4 - power))) for a, b in zip(first, second, strict=True)}
        assert len(cells) == 16


def test_even_world_gives_pi_times_its_radiance() -> None:
    light = world_light(WorldArrays((0.2, 0.5, 1.0)), 128)
    assert np.allclose(light.maps[0, ..., :3], np.pi * np.array([0.2, 0.5, 1.0]), rtol=1e-6)
    assert np.allclose(light.weights.sum(axis=0), 4 * np.pi * np.array([0.2, 0.5, 1.0]))
    assert np.allclose(light.maps[2:, ..., :3], [0.2, 0.5, 1.0], rtol=1e-6)


def test_irradiance_of_a_gradient_is_the_closed_form() -> None:
    """Radiance 1 + z gives a normal n the irradiance pi + 2 pi n_z / 3; the rotation turns z into world y."""
    directions, _ = image_directions(128, 256)
    image = np.repeat(1.0 + directions[..., 2:], 3, axis=-1).astype(np.float32)
    rotation = rotation_about_x(np.pi / 2)  # world y is image z
    light = world_light(WorldArrays((1.0, 1.0, 1.0), image, rotation), 128)
    normals = octahedral_directions(MAP_SIZE)
    expected = np.pi + 2 * np.pi / 3 * normals[..., 1]
    assert np.abs(light.maps[0, ..., 0] / expected - 1).max() < 0.01


def test_draws_with_their_ratio_give_the_irradiance_back() -> None:
    image, _ = sky_with_sun()
    light = world_light(WorldArrays((1.0, 1.0, 1.0), image), 128)
    normals = octahedral_directions(MAP_SIZE)
    by_draws = np.maximum(normals @ light.directions[light.draws].T, 0) @ light.weights
    assert np.allclose(by_draws * light.maps[1, ..., :3], light.maps[0, ..., :3], rtol=1e-3)
    ratio = light.maps[1, ..., :3]
    assert 0.9 < np.percentile(ratio, 5) < np.percentile(ratio, 95) < 1.1


def test_a_sun_gets_draws_by_its_power_but_few_maps() -> None:
    image, sun = sky_with_sun()
    light = world_light(WorldArrays((1.0, 1.0, 1.0), image), 128)
    power = light.weights.sum(axis=1)
    near = light.directions[light.draws] @ sun > np.cos(0.1)
    directions, solid_angles = image_directions(*image.shape[:2])
    true_power = (image.sum(axis=-1) * solid_angles[:, None])[directions @ sun > np.cos(0.1)].sum()
    assert np.isclose(power[near].sum(), true_power, rtol=0.1)
    assert np.isclose(near.mean(), power[near].sum() / power.sum(), atol=0.08)
    assert len(set(light.draws[near])) < 0.5 * near.sum()
    # any run of a sub-frame has its share of the sun
    runs = near.reshape(16, 8).mean(axis=1)
    assert np.abs(runs - near.mean()).max() <= 0.2


def test_lobes_widen_with_roughness_and_keep_the_mean() -> None:
    image, sun = sky_with_sun()
    light = world_light(WorldArrays((1.0, 1.0, 1.0), image), 128)
    towards = octahedral_directions(MAP_SIZE) @ sun
    peak = np.unravel_index(np.argmax(towards), towards.shape)
    peaks = [float(lobe[peak][0]) for lobe in light.maps[2:]]
    assert len(peaks) == len(ROUGHNESS_LEVELS)
    assert all(a > b for a, b in pairwise(peaks))
    away = light.maps[2:, ..., 0][:, towards < -0.2]
    assert away.min() > 0.19 and away.max() < 1.2 * 300.0


def test_dark_world_image_has_no_wild_values() -> None:
    light = world_light(WorldArrays((1.0, 1.0, 1.0), np.zeros((8, 16, 3), np.float32)), 32)
    for array in (light.maps, light.weights, light.directions):
        assert np.isfinite(array).all()
    assert np.all(light.weights == 0.0)


def test_a_sun_leaves_the_image_as_a_lamp_and_no_light_is_lost() -> None:
    image, sun = sky_with_sun(256)
    rotation = rotation_about_x(0.7)
    world = WorldArrays((2.0, 1.0, 1.0), image, rotation)
    sky = split_suns(world)
    (lamp,) = sky.suns
    towards = lamp.matrix[:3, 2]
    assert towards @ (sun @ rotation) > np.cos(0.005)
    assert np.isclose(lamp.angle, 2 * 0.05, rtol=0.1)
    assert not lamp.visible_glossy
    assert sky.world.image is not None
    assert (sky.world.image @ np.array([2.0, 1.0, 1.0])).max() <= sky.limit * 1.0001
    _, solid_angles = image_directions(*image.shape[:2])

    def light_of(pixels: np.ndarray) -> np.ndarray:
        return (pixels * solid_angles[:, None, None]).sum(axis=(0, 1), dtype=np.float64) * np.array([2.0, 1.0, 1.0])

    assert np.allclose(light_of(sky.world.image) + lamp.color, light_of(image), rtol=1e-3)
    assert split_suns(world).world is sky.world


def test_skies_without_a_sun_stay_whole() -> None:
    directions, _ = image_directions(64, 128)
    gradient = np.repeat(1.0 + directions[..., 2:], 3, axis=-1).astype(np.float32)
    for world in (WorldArrays((1.0, 1.0, 1.0)), WorldArrays((1.0, 1.0, 1.0), gradient)):
        sky = split_suns(world)
        assert sky.world is world
        assert sky.suns == ()


def test_shader_finds_each_roughness_level_at_its_map() -> None:
    """The shader has the levels as a formula, evenly spaced but for the last."""
    d = {name: float(value) for name, value in WORLD_DEFINES.items()}
    knee = d["LOBE_LAST_BUT_ONE"]
    for index, roughness in enumerate(ROUGHNESS_LEVELS):
        level = (roughness - d["LOBE_FIRST"]) / d["LOBE_STEP"]
        if roughness >= knee:
            level = d["LOBE_STEPS"] + (roughness - knee) / d["LOBE_LAST_STEP"]
        assert level == pytest.approx(index)
