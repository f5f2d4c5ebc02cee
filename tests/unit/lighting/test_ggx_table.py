# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The table that is stored is the one that is integrated."""

from __future__ import annotations

import numpy as np
from curvrefl.curvrefl_addon.renderer.lighting.ggx import ggx_table, integrate_ggx


def test_stored_table_is_the_integral() -> None:
    """Integrated more coarsely here: most entries differ by the noise of that."""
    coarse = integrate_ggx(32)
    stored = ggx_table()[: len(coarse)]
    assert stored.shape == coarse.shape
    assert np.abs(stored - coarse).mean(axis=(0, 1)).max() < 2e-3
    assert np.abs(stored - coarse).max() < 0.03


def test_a_white_smooth_lobe_keeps_all_light() -> None:
    columns = ggx_table()[0, :32, 0]
    np.testing.assert_allclose(columns[1:], 1.0, atol=2e-3)
