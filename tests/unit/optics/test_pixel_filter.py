# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sub-frame offsets follow the filter's window."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.renderer.surfaces.pixel_filter import WIDTH, offsets


def test_one_sample_looks_through_the_center() -> None:
    assert offsets(1).tolist() == [[0.0, 0.0]]


@pytest.mark.parametrize("samples", [2, 3, 4, 16, 64])
def test_mean_is_zero_and_support_is_kept(samples: int) -> None:
    found = offsets(samples)
    assert found.shape == (samples, 2)
    np.testing.assert_allclose(found.mean(axis=0), 0.0, atol=1e-12)
    assert np.abs(found).max() <= 0.5 * WIDTH
    assert len(np.unique(found, axis=0)) == samples


def test_variance_is_the_windows() -> None:
    """Of the window a0 + a1 cos + a2 cos 2 + a3 cos 3 over -1/2 to 1/2: 1/12 plus the cosines' second moments."""
    x = (np.arange(200_000) + 0.5) / 200_000 - 0.5
    window = (
        0.35875 + 0.48829 * np.cos(2 * np.pi * x) + 0.14128 * np.cos(4 * np.pi * x) + 0.01168 * np.cos(6 * np.pi * x)
    )
    expected = WIDTH**2 * (window * x**2).sum() / window.sum()
    np.testing.assert_allclose(offsets(256).var(axis=0), expected, rtol=0.02)
