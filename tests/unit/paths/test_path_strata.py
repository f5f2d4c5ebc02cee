# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers of paths are spread evenly over sub-frames, whatever the pixel and the bounce."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.scattering.sampler import path_random

PIXELS = np.array([(0, 0), (7, 3), (159, 119), (1023, 5)])


@pytest.mark.parametrize("bounce", range(5))
@pytest.mark.parametrize("count", [2, 16, 64])
@pytest.mark.parametrize("first", [0, 64])
def test_each_stratum_of_an_axis_has_one_sub_frame(bounce: int, count: int, first: int) -> None:
    numbers = np.stack([path_random(PIXELS, first + index, bounce) for index in range(count)])
    strata = np.sort((numbers * count).astype(int), axis=0)
    assert (strata == np.arange(count)[:, None, None]).all()
