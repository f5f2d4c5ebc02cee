# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds by programs, against Cycles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from extraction import extracted
from lighting.skies import all_directions, all_directions_by_cycles, new_world

pytestmark = pytest.mark.usefixtures("gpu")

SKIES = {
    "multiple": {"sky_type": "MULTIPLE_SCATTERING", "sun_elevation": 0.3, "sun_rotation": 2.0},
    "dusty": {"sky_type": "MULTIPLE_SCATTERING", "aerosol_density": 3.0, "ozone_density": 4.0, "altitude": 9000.0},
    "low": {"sky_type": "MULTIPLE_SCATTERING", "sun_elevation": -0.02, "air_density": 2.0, "sun_size": 0.3},
    "single": {"sky_type": "SINGLE_SCATTERING", "sun_elevation": 0.3, "sun_rotation": -1.0},
    "evening": {"sky_type": "SINGLE_SCATTERING", "sun_elevation": -0.03, "ozone_density": 3.0, "altitude": 2000.0},
    "behind": {"sky_type": "SINGLE_SCATTERING", "sun_elevation": 2.5, "sun_size": 0.4, "sun_intensity": 0.01},
    "preetham": {"sky_type": "PREETHAM", "sun_direction": (0.3, -0.5, 0.81), "turbidity": 3.0},
    "hosek": {"sky_type": "HOSEK_WILKIE", "sun_direction": (0.6, 0.5, 0.62), "turbidity": 4.3, "ground_albedo": 0.6},
}


@pytest.mark.parametrize("name", SKIES)
def test_skies_are_those_of_cycles(name: str) -> None:
    settings: dict[str, Any] = SKIES[name]
    new_world("ShaderNodeTexSky", **settings)
    read = extracted()
    assert read.warnings == ()
    ours, cycles = all_directions(read.world), all_directions_by_cycles()
    scale = np.maximum(cycles, 0.02 * float(np.quantile(cycles, 0.99)))
    error = np.abs(ours - cycles) / scale
    assert np.quantile(error, 0.995) < 1.0 / 255.0, np.quantile(error, [0.5, 0.9, 0.99, 0.995, 1.0])
    np.testing.assert_allclose(ours.mean(axis=(0, 1)), cycles.mean(axis=(0, 1)), rtol=0.002)
