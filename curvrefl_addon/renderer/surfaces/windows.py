# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rectangles of pixels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

type Window = tuple[int, int, int, int]
"""x, y, width and height of pixels"""


def union(windows: Sequence[Window]) -> Window:
    """A window that holds all of these; an empty one where all are."""
    some = np.array([window for window in windows if window[2] > 0 and window[3] > 0], np.int64)
    if len(some) == 0:
        return (0, 0, 0, 0)
    x, y = some[:, :2].min(axis=0).tolist()
    right, top = (some[:, :2] + some[:, 2:]).max(axis=0).tolist()
    return (x, y, right - x, top - y)
