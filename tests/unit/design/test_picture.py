# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lookups in pictures, and PNG files that know their size."""

from __future__ import annotations

import io

import numpy as np
import pytest
from curvrefl.curvrefl_addon.design.anamorphosis.picture import Picture
from curvrefl.curvrefl_addon.design.anamorphosis.picture_frame import PictureFrame
from curvrefl.curvrefl_addon.design.anamorphosis.png_file import png_bytes
from curvrefl.curvrefl_addon.scene.camera.srgb import srgb_to_linear


def pixels(width: int = 8, height: int = 6) -> np.ndarray:
    return np.random.default_rng(5).uniform(0.0, 1.0, (height, width, 4)).astype(np.float32)


def middles(width: int, height: int) -> np.ndarray:
    x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    return np.column_stack([x.ravel(), y.ravel()])


@pytest.mark.parametrize("is_encoded", [True, False])
def test_in_the_middle_of_a_pixel_is_its_color(is_encoded: bool) -> None:
    own = pixels()
    picture = Picture(own, is_encoded)
    found = picture.at(middles(8, 6))
    colors = srgb_to_linear(own[..., :3]) if is_encoded else own[..., :3]
    np.testing.assert_allclose(found[:, :3], (colors * own[..., 3:]).reshape(-1, 3), atol=1e-6)
    np.testing.assert_allclose(found[:, 3], own[..., 3].ravel(), atol=1e-6)
    np.testing.assert_allclose(picture.stored(found.reshape(6, 8, 4)), own, atol=1e-5)


def test_between_pixels_encoded_colors_are_mixed_as_cycles_does() -> None:
    own = np.ones((1, 2, 4), np.float32)
    own[0, :, :3] = [[0.2, 0.4, 0.0], [0.6, 0.0, 1.0]]
    found = Picture(own, True).at(np.array([[0.5, 0.5]]))
    np.testing.assert_allclose(found[0, :3], srgb_to_linear(np.array([0.4, 0.2, 0.5])), atol=1e-6)


def test_outside_is_nothing() -> None:
    found = Picture(pixels(), True).at(np.array([[-1e-6, 0.5], [0.5, 1.1], [np.nan, 0.5]]))
    assert (found[:2] == 0.0).all() and not found[2].any()


def test_over_a_pixel_or_many_is_their_mean() -> None:
    own = pixels(32, 16)
    picture = Picture(own, False)
    span = np.tile(np.diag([0.25, 0.5]), (8, 1, 1))
    found = picture.over(middles(4, 2), span)
    expected = (
        np.concatenate([own[..., :3] * own[..., 3:], own[..., 3:]], axis=2).reshape(2, 8, 4, 8, 4).mean(axis=(1, 3))
    )
    np.testing.assert_allclose(found, expected.reshape(-1, 4), atol=0.02)
    # All of it in one texel, also where a texel holds thousands of its pixels.
    whole = Picture(pixels(256, 256), False)
    mean = whole.over(np.array([[0.5, 0.5]]), np.eye(2)[None])
    linear = whole.pixels[..., :3] * whole.pixels[..., 3:]
    np.testing.assert_allclose(mean[0, :3], linear.mean(axis=(0, 1)), atol=0.01)


def test_at_the_edge_a_texel_is_covered_in_part() -> None:
    own = np.ones((4, 4, 4), np.float32)
    found = Picture(own, True).over(
        np.array([[0.0, 0.5], [1.0, 1.0], [0.02, 0.5]]), np.tile(0.1 * np.eye(2), (3, 1, 1))
    )
    np.testing.assert_allclose(found[:, 3], [0.5, 0.25, 0.75], atol=1e-6)
    np.testing.assert_allclose(found[:, :3] / found[:, 3:], 1.0, atol=1e-6)


def test_places_of_a_frame_and_back() -> None:
    frame = PictureFrame(0.1, 0.2, 0.3, 0.6)
    np.testing.assert_allclose(frame.in_view(np.array([[0.0, 0.0], [1.0, 0.5]])), [[0.1, 0.2], [0.4, 0.5]])
    places = np.random.default_rng(6).normal(size=(9, 2))
    np.testing.assert_allclose(frame.in_picture(frame.in_view(places)), places)


def test_a_png_has_its_pixels_and_its_size() -> None:
    from PIL import Image

    own = pixels(21, 13)
    with Image.open(io.BytesIO(png_bytes(own, 300.0))) as opened:
        read = np.asarray(opened)
        dots = opened.info["dpi"]
    np.testing.assert_array_equal(read[::-1], np.rint(own * 255.0))
    np.testing.assert_allclose(dots, 300.0, rtol=1e-4)
    with Image.open(io.BytesIO(png_bytes(own))) as opened:
        assert "dpi" not in opened.info
