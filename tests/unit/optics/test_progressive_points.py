# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Any beginning of a long picture is spread evenly: over pixels, lenses, shutters and lamps."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.lighting.lamps import lamp_points
from curvrefl.curvrefl_addon.renderer.surfaces.pixel_filter import WIDTH, offsets
from curvrefl.curvrefl_addon.scene.arrays import LightArrays
from curvrefl.curvrefl_addon.scene.camera.sampling import (
    hammersley,
    progressive_points,
    scattered_points,
    scattered_strata,
)


@pytest.mark.parametrize("seed", [0, 1, 1510])
def test_beginnings_are_nets(seed: int) -> None:
    """Of 2^k points one is in each of 2^k boxes, whatever the boxes' shape."""
    points = progressive_points(256, seed)
    for k in range(9):
        for wide in range(k + 1):
            boxes = np.floor(points[: 1 << k] * [1 << wide, 1 << (k - wide)]).astype(int)
            assert len({tuple(box) for box in boxes.tolist()}) == 1 << k, (k, wide)


def test_other_seeds_are_other_sets() -> None:
    one, other = progressive_points(256, 1), progressive_points(256, 2)
    assert abs(np.corrcoef(one[:, 0], other[:, 0])[0, 1]) < 0.2
    assert len({tuple(np.floor(16 * pair)) for pair in np.column_stack([one[:, 0], other[:, 0]])}) > 140


@pytest.mark.parametrize("samples", [64, 100, 256])
def test_beginnings_look_the_same_way(samples: int) -> None:
    """The first 16 sub-frames of many are not a picture that has moved aside."""
    found = offsets(samples)
    assert np.abs(found[:16].mean(axis=0)).max() < 0.04 * WIDTH
    assert np.abs(found.mean(axis=0)).max() < 1e-12
    assert abs(scattered_strata(samples)[:16].mean() - 0.5) < 0.04
    assert np.abs(scattered_points(samples)[:16].mean(axis=0) - 0.5).max() < 0.04


def test_pictures_of_few_sub_frames_stay_as_they_were() -> None:
    window = np.sort(hammersley(16)[:, 0])
    assert np.array_equal(window, (np.arange(16) + 0.5) / 16)
    assert (np.diff(offsets(32)[:, 0]) > 0.0).all()


def test_lamps_are_gone_through_evenly() -> None:
    """A half-shadow of 256 points has as many steps, and its first 16 are spread over the whole lamp."""
    matrix = np.eye(4)
    for light in (
        LightArrays("sun", "SUN", (1.0, 1.0, 1.0), matrix, angle=0.2),
        LightArrays("area", "AREA", (1.0, 1.0, 1.0), matrix, size=(2.0, 1.0)),
        LightArrays("disk", "AREA", (1.0, 1.0, 1.0), matrix, size=(1.0, 1.0), ellipse=True),
        LightArrays("ball", "POINT", (1.0, 1.0, 1.0), matrix, radius=0.5),
    ):
        places = lamp_points(light, 256, seed=0)[:, :2]
        assert len(np.unique(np.round(places, 9), axis=0)) == 256
        half = np.abs(places).max(axis=0)
        assert np.abs(places[:16].mean(axis=0)).max() < 1e-9, "pairs lie opposite each other"
        spread = places[:16].std(axis=0) / places.std(axis=0)
        assert (np.abs(spread - 1.0) < 0.15).all(), (light.kind, spread, half)
