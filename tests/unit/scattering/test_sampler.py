# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers of paths: strata at every pixel, nothing in common between pixels, axes and bounces."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.scattering.sampler import path_point, path_random

PIXELS = np.array([[0, 0], [1, 0], [511, 3], [1919, 1079], [7, 4095]])


def samples(count: int, bounce: int, pixels: np.ndarray = PIXELS, asked: int = 256) -> np.ndarray:
    """(sub-frames, pixels, 4)"""
    return np.stack([path_random(pixels, sub_frame, bounce, asked) for sub_frame in range(count)])


@pytest.mark.parametrize("asked", [1, 16, 256])
@pytest.mark.parametrize("bounce", [0, 1, 7])
def test_axes_are_stratified(bounce: int, asked: int) -> None:
    """The first 2^k sub-frames have one number in each of 2^k intervals, at every pixel and axis."""
    numbers = samples(64, bounce, asked=asked)
    for count in (1, 2, 4, 8, 16, 32, 64):
        strata = np.sort((numbers[:count] * count).astype(int), axis=0)
        assert (strata == np.arange(count)[:, None, None]).all()


@pytest.mark.parametrize("bounce", [0, 1, 3])
def test_pairs_of_axes_are_stratified(bounce: int) -> None:
    """The first two axes choose a microfacet: of 16 sub-frames one is in each elementary rectangle."""
    numbers = samples(16, bounce)
    for rows in (1, 2, 4, 8, 16):
        cells = (numbers[:, :, 0] * rows).astype(int) * (16 // rows) + (numbers[:, :, 1] * (16 // rows)).astype(int)
        assert (np.sort(cells, axis=0) == np.arange(16)[:, None]).all()


@pytest.mark.parametrize("asked", [1, 4, 16])
def test_quads_of_pixels_are_stratified_together(asked: int) -> None:
    """When all sub-frames are there: the four pixels of a quad, and the sixteen of a quad of quads."""
    for size in (2, 4):
        corner = np.stack(np.meshgrid(np.arange(size), np.arange(size)), axis=-1).reshape(-1, 2)
        numbers = samples(asked, 0, corner + size * np.array([13, 37]), asked).reshape(-1, 4)
        strata = np.sort((numbers * len(numbers)).astype(int), axis=0)
        assert (strata == np.arange(len(numbers))[:, None]).all()


def test_bounces_and_axes_and_pixels_are_apart() -> None:
    """Numbers of 4,096 pixels, paired between bounces, axes and neighbors, are no more alike than by chance."""
    pixels = np.stack(np.meshgrid(np.arange(64), np.arange(64)), axis=-1).reshape(-1, 2)
    for sub_frame in (0, 1, 5):
        columns = [path_random(pixels, sub_frame, bounce)[:, axis] for bounce in (0, 1, 2) for axis in range(4)]
        columns.append(path_random(pixels + np.array([1, 0]), sub_frame, 0)[:, 0])
        correlation = np.corrcoef(columns) - np.eye(len(columns))
        assert np.abs(correlation).max() < 5.0 / 64.0
        assert np.abs(np.mean(columns, axis=1) - 0.5).max() < 5.0 * 0.29 / 64.0


def test_bounces_average_independently() -> None:
    """The mean over sub-frames of a product of two bounces' numbers is near 1/4 at every pixel."""
    product = samples(64, 0)[..., 0] * samples(64, 1)[..., 0]
    assert np.abs(product.mean(axis=0) - 0.25).max() < 0.02


def test_numbers_stay_below_one_and_go_on_after_65536() -> None:
    pixels = np.stack(np.meshgrid(np.arange(128), np.arange(128)), axis=-1).reshape(-1, 2)
    numbers = np.concatenate([path_random(pixels, sub_frame, 0) for sub_frame in (0, 65535, 65536)])
    assert numbers.min() >= 0.0
    assert numbers.max() < 1.0
    assert path_point(0, 0) != path_point(65536, 0)
    assert all(-(1 << 31) <= value < 1 << 31 for value in path_point(123456, 9))
