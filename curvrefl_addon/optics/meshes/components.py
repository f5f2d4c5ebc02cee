# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What hangs together, by pairs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def components(count: int, pairs: NDArray[np.integer]) -> NDArray[np.int64]:
    """(count,) the least number of those that each hangs together with, by pairs (m, 2) of them."""
    label = np.arange(count)
    while len(pairs):
        one, other = label[pairs[:, 0]], label[pairs[:, 1]]
        pairs = pairs[one != other]
        one, other = one[one != other], label[pairs[:, 1]]
        # Roots are hung below lesser ones, then all below their roots: long strips take few rounds.
        np.minimum.at(label, np.maximum(one, other), np.minimum(one, other))
        while not np.array_equal(label[label], label):
            label = label[label]
    return label
