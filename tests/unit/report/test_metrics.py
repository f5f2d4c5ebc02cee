# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Error measures on pictures whose error is known by construction."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest
from curvrefl.curvrefl_addon.errors import InputError
from curvrefl.curvrefl_addon.report.display import display_transform, inverse_display_transform
from curvrefl.curvrefl_addon.report.metrics import (
    direction_angle_deg,
    error_map,
    flip_in_mask,
    geometry_error,
    mask_mismatch,
    psnr_in_mask,
)

HEIGHT, WIDTH = 12, 16


@pytest.fixture
def picture() -> np.ndarray:
    return np.random.default_rng(1).uniform(0.0, 1.0, (HEIGHT, WIDTH, 4)).astype(np.float32)


@pytest.fixture
def mask() -> np.ndarray:
    mask = np.zeros((HEIGHT, WIDTH), bool)
    mask[3:9, 4:12] = True
    return mask


def test_display_transform_is_the_srgb_curve() -> None:
    shown = display_transform(np.array([-1.0, 0.0, 0.001, 0.18, 1.0, 7.0, np.inf, np.nan], np.float32))
    assert shown == pytest.approx([0.0, 0.0, 0.01292, 0.461356, 1.0, 1.0, 1.0, 0.0], abs=2e-6)


def test_inverse_display_transform() -> None:
    values = np.linspace(0.0, 1.0, 1001, dtype=np.float32)
    assert display_transform(inverse_display_transform(values)) == pytest.approx(values, abs=2e-6)


def test_equal_pictures_have_no_error(picture: np.ndarray, mask: np.ndarray) -> None:
    assert flip_in_mask(picture, picture, mask) == 0.0
    assert psnr_in_mask(picture, picture, mask) == math.inf
    assert not error_map(picture, picture).any()


def test_what_is_outside_the_mask_does_not_count(picture: np.ndarray, mask: np.ndarray) -> None:
    other = np.where(mask[..., None], picture, 1.0 - picture)
    assert flip_in_mask(other, picture, mask) == 0.0
    assert psnr_in_mask(other, picture, mask) == math.inf


def test_flip_of_black_against_white_is_one(mask: np.ndarray) -> None:
    everywhere = np.ones((HEIGHT, WIDTH), bool)
    black, white = np.zeros((HEIGHT, WIDTH, 3), np.float32), np.ones((HEIGHT, WIDTH, 3), np.float32)
    assert flip_in_mask(black, white, everywhere) == pytest.approx(1.0, abs=0.05)


def test_flip_grows_with_the_error_and_sees_only_where_it_is(picture: np.ndarray) -> None:
    left, right = np.zeros((2, HEIGHT, WIDTH), bool)
    left[:, : WIDTH // 2], right[:, WIDTH // 2 :] = True, True
    slightly, clearly = picture.copy(), picture.copy()
    slightly[2, 2, :3] = 1.0 - picture[2, 2, :3]
    clearly[:, : WIDTH // 2, :3] = 1.0 - picture[:, : WIDTH // 2, :3]
    small, large = flip_in_mask(slightly, picture, left), flip_in_mask(clearly, picture, left)
    assert small is not None and large is not None
    assert 0.0 < small < large
    assert flip_in_mask(clearly, picture, right) == 0.0


def test_psnr_of_a_known_difference(mask: np.ndarray) -> None:
    reference = inverse_display_transform(np.full((HEIGHT, WIDTH, 3), 0.5, np.float32))
    test = inverse_display_transform(np.full((HEIGHT, WIDTH, 3), 0.6, np.float32))
    assert psnr_in_mask(test, reference, mask) == pytest.approx(20.0, abs=1e-3)


def test_error_map_is_sixteen_times_the_difference() -> None:
    reference = inverse_display_transform(np.full((2, 2, 3), 0.5, np.float32))
    test = inverse_display_transform(np.full((2, 2, 3), 0.52, np.float32))
    assert error_map(test, reference) == pytest.approx(np.full((2, 2, 3), 0.32), abs=1e-4)


def test_an_empty_mask_has_no_numbers(picture: np.ndarray) -> None:
    nowhere = np.zeros((HEIGHT, WIDTH), bool)
    assert flip_in_mask(picture, picture, nowhere) is None
    assert psnr_in_mask(picture, picture, nowhere) is None


def test_missing_flip_package_is_named(monkeypatch: pytest.MonkeyPatch, picture: np.ndarray, mask: np.ndarray) -> None:
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    with pytest.raises(InputError, match="flip-evaluator"):
        flip_in_mask(picture, picture, mask)


def test_angles_between_points_and_directions() -> None:
    origins = np.array([[1.0, 2.0, 3.0]] * 5)
    first = np.array([[2, 2, 3, 1], [5, 2, 3, 1], [1, 0, 0, 0], [1, 0, 0, 0], [1, 2, 3, 1]], float)
    second = np.array([[1, 3, 3, 1], [9, 2, 3, 1], [-1, 0, 0, 0], [7, 2, 3, 1], [0, 0, 1, 0]], float)
    assert direction_angle_deg(origins, first, second) == pytest.approx([90.0, 0.0, 180.0, 0.0, 180.0])


@pytest.mark.parametrize("degrees", [1e-6, 1e-3, 1.0, 179.0])
def test_small_and_large_angles_keep_their_digits(degrees: float) -> None:
    radians = math.radians(degrees)
    first = np.array([[1.0, 0.0, 0.0, 0.0]])
    second = np.array([[math.cos(radians), math.sin(radians), 0.0, 0.0]])
    assert direction_angle_deg(np.zeros((1, 3)), first, second)[0] == pytest.approx(degrees, rel=1e-6)


class TestGeometryError:
    """One reflector, id 3, of 8 x 8 pixels at the origin that shows points along +X."""

    @pytest.fixture
    def reference(self) -> dict[str, np.ndarray]:
        mask = np.zeros((HEIGHT, WIDTH), np.int32)
        mask[2:10, 2:10] = 3
        shown = np.zeros((HEIGHT, WIDTH, 4), np.float32)
        shown[..., 0], shown[..., 3] = 5.0, 1.0
        return {
            "reference_mask": mask,
            "reference_reflector_position": np.zeros((HEIGHT, WIDTH, 3), np.float32),
            "reference_reflected_position": shown,
            "reference_reflected_object": np.full((HEIGHT, WIDTH), 7, np.int32),
        }

    def frame(self, reference: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        names = ("mask", "reflected_position", "reflected_object")
        return {name: reference[f"reference_{name}"].copy() for name in names}

    def test_the_reference_against_itself(self, reference: dict[str, np.ndarray]) -> None:
        error = geometry_error(**self.frame(reference), **reference)
        assert error == {"angle_deg": {"median": 0.0, "p95": 0.0, "p99": 0.0}, "wrong_object": 0.0}

    def test_a_known_turn_and_share(self, reference: dict[str, np.ndarray]) -> None:
        frame = self.frame(reference)
        frame["reflected_position"][2:6, 2:10] = (1.0, 1.0, 0.0, 1.0)
        frame["reflected_position"][2, 2] = (0.0, 1.0, 0.0, 0.0)
        frame["reflected_object"][2:4, 2:10] = 0
        error = geometry_error(**frame, **reference)
        assert error["angle_deg"] == pytest.approx({"median": 22.5, "p95": 45.0, "p99": 45.0 + 45.0 * 0.37}, abs=1e-4)
        assert error["wrong_object"] == pytest.approx(0.25)

    def test_pixels_where_the_masks_disagree_do_not_count(self, reference: dict[str, np.ndarray]) -> None:
        frame = self.frame(reference)
        frame["mask"][2, :] = 0
        frame["mask"][3, :] = 4
        frame["mask"][11, :] = 3
        frame["reflected_position"][[2, 3, 11]] = (0.0, 1.0, 0.0, 0.0)
        frame["reflected_object"][[2, 3, 11]] = 1
        error = geometry_error(**frame, **reference)
        assert error == {"angle_deg": {"median": 0.0, "p95": 0.0, "p99": 0.0}, "wrong_object": 0.0}
        assert mask_mismatch(frame["mask"], reference["reference_mask"]) == pytest.approx((16 + 16 + 8) / 64)

    def test_pixels_that_cycles_lost_do_not_count(self, reference: dict[str, np.ndarray]) -> None:
        frame = self.frame(reference)
        frame["reflected_position"][2] = (0.0, 1.0, 0.0, 0.0)
        valid = np.ones((HEIGHT, WIDTH), bool)
        valid[2] = False
        error = geometry_error(**frame, **reference, reference_valid=valid)
        assert error["angle_deg"]["p99"] == 0.0

    def test_not_a_number_is_the_largest_error(self, reference: dict[str, np.ndarray]) -> None:
        frame = self.frame(reference)
        frame["reflected_position"][..., 1] = np.nan
        assert geometry_error(**frame, **reference)["angle_deg"]["median"] == 180.0

    def test_no_pixels_no_numbers(self, reference: dict[str, np.ndarray]) -> None:
        frame = self.frame(reference)
        frame["mask"][:] = 0
        error = geometry_error(**frame, **reference)
        assert error == {"angle_deg": {"median": None, "p95": None, "p99": None}, "wrong_object": None}
