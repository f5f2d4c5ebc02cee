# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points for the sub-frames of a picture, spread evenly."""

from __future__ import annotations

import numpy as np

from ..arrays import Float64Array

_ORDERS = (20260, 52026)
"""Seeds of the orders in which lenses and shutters are gone through"""


def hammersley(samples: int) -> Float64Array:
    """(samples, 2) low-discrepancy points in the unit square, in the middle of their strata."""
    index = np.arange(samples)
    bits = np.zeros(samples)
    scale, left = 0.5, index.copy()
    while left.any():
        bits += scale * (left & 1)
        left >>= 1
        scale *= 0.5
    return np.column_stack([(index + 0.5) / samples, bits + 0.5 / samples])


def scattered_points(samples: int) -> Float64Array:
    """The same points in an order that has nothing to do with theirs, for what is sampled beside pixels."""
    return hammersley(samples)[np.random.default_rng(_ORDERS[0]).permutation(samples)]


def scattered_strata(samples: int) -> Float64Array:
    """(samples,) middles of equal parts of 0..1, in an order that has nothing to do with the other points'."""
    return (np.random.default_rng(_ORDERS[1]).permutation(samples) + 0.5) / samples
