# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every shader node in a mirror, lit by a sun: as bright as in Cycles, or named among what is not."""

from __future__ import annotations

import pytest
from nodes.shaders import judged_shaders

pytestmark = pytest.mark.usefixtures("gpu")
LIMIT = 1.5 / 255.0
LIMITS = {
    "Glass BSDF": 0.015,
    "Principled BSDF, transmission": 0.015,
    "Principled BSDF, thin wall": 0.02,
    # Light of what shines, by what it lets through: only lamps and the world give light.
    "Translucent BSDF": 0.3,
}
"""Of what is only near"""


def test_shaders_are_right_or_said() -> None:
    wrong = {
        judged.name: judged.error
        for judged in judged_shaders()
        if not judged.warnings and judged.error > LIMITS.get(judged.name, LIMIT)
    }
    assert not wrong
