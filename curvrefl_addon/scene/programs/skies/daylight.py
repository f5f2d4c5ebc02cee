# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Sky Texture's older models, by a few numbers for the whole sky: Preetham et al., "A Practical Analytic Model for
Daylight" (1999), and Hosek and Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance" (2012).

`hosek.npy` (3 of XYZ, 2 albedos, 10 turbidities, 6 points, 9 coefficients and the radiance) is the latter's own data,
Copyright (c) 2012-2013 Lukas Hosek and Alexander Wilkie (BSD-3-Clause).
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

type Array = NDArray[np.float64]

DATA_FILE = Path(__file__).with_name("hosek.npy")


def preetham(theta: float, turbidity: float) -> Array:
    """(6, 3): the zenith's Y, x and y over what the other rows, the coefficients of each, give there. `theta`: between
    zenith and sun."""
    t = turbidity
    powers = np.array((theta**3, theta**2, theta, 1.0))
    squares = np.array((t**2, t, 1.0))
    chi = (4.0 / 9.0 - t / 120.0) * (np.pi - 2.0 * theta)
    luminance = 0.06 * ((4.0453 * t - 4.9710) * np.tan(chi) - 0.2155 * t + 2.4192)
    x = squares @ (
        np.array(
            (
                (0.00166, -0.00375, 0.00209, 0.0),
                (-0.02903, 0.06377, -0.03202, 0.00394),
                (0.11693, -0.21196, 0.06052, 0.25886),
            )
        )
        @ powers
    )
    y = squares @ (
        np.array(
            (
                (0.00275, -0.00610, 0.00317, 0.0),
                (-0.04214, 0.08970, -0.04153, 0.00516),
                (0.15346, -0.26756, 0.06670, 0.26688),
            )
        )
        @ powers
    )
    lines = np.array(
        (
            ((0.1787, -1.4630), (-0.0193, -0.2592), (-0.0167, -0.2608)),
            ((-0.3554, 0.4275), (-0.0665, 0.0008), (-0.0950, 0.0092)),
            ((-0.0227, 5.3251), (-0.0004, 0.2125), (-0.0079, 0.2102)),
            ((0.1206, -2.5771), (-0.0641, -0.8989), (-0.0441, -1.6537)),
            ((-0.0670, 0.3703), (-0.0033, 0.0452), (-0.0109, 0.0529)),
        )
    )
    terms = lines[..., 0] * t + lines[..., 1]
    a, b, c, d, e = terms
    at_zenith = (1.0 + a * np.exp(b)) * (1.0 + c * np.exp(d * theta) + e * np.cos(theta) ** 2)
    return np.vstack([np.array((luminance, x, y)) / at_zenith, terms])


def hosek_wilkie(theta: float, turbidity: float, albedo: float) -> Array:
    """(10, 3): radiance of X, Y and Z, then the nine coefficients of each. `theta`: between zenith and sun."""
    turbidity = min(max(turbidity, 1.0), 10.0)
    elevation = (0.5 * np.pi - min(max(theta, 0.0), 0.5 * np.pi)) / (0.5 * np.pi)
    t = elevation ** (1.0 / 3.0)
    bernstein = np.array((1.0, 5.0, 10.0, 10.0, 5.0, 1.0)) * (1.0 - t) ** np.arange(5, -1, -1) * t ** np.arange(6)
    low = int(turbidity)
    rest = turbidity - low
    both = (1.0 - albedo) * _data()[:, 0] + albedo * _data()[:, 1]
    found = (1.0 - rest) * both[:, low - 1]
    if low < 10:
        found = found + rest * both[:, low]
    numbers = np.einsum("p,cpk->kc", bernstein, found)
    return np.vstack([numbers[9:], numbers[:9]])


@cache
def _data() -> Array:
    return np.asarray(np.load(DATA_FILE), np.float64)
