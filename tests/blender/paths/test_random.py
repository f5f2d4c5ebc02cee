# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""random.glsl draws the numbers that the reference draws."""

from __future__ import annotations

import numpy as np
import pytest
from curvrefl.curvrefl_addon.optics.scattering.sampler import path_random
from paths.programs import randoms

pytestmark = pytest.mark.usefixtures("gpu")


@pytest.mark.parametrize(
    ("sub_frame", "bounce", "asked"), [(0, 0, 1), (1, 0, 16), (77, 3, 64), (65535, 1, 1 << 20), (70000, 12, 256)]
)
def test_numbers_are_those_of_the_reference(sub_frame: int, bounce: int, asked: int) -> None:
    """Bit by bit."""
    found = randoms(48, 32, sub_frame, bounce, asked, (1900, 40))
    y, x = np.mgrid[0:32, 0:48]
    expected = path_random(np.stack([x.ravel() + 1900, y.ravel() + 40], axis=1), sub_frame, bounce, asked)
    np.testing.assert_array_equal(found.reshape(-1, 4), expected)
