# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Other resolutions of images. Pure numpy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

type Pixels = NDArray[np.float32] | NDArray[np.float64]
"""(h, w, channels), row 0 at the bottom"""


def averaged(pixels: Pixels, height: int, width: int) -> Pixels:
    """The image in `height` rows and `width` columns of equal parts, each the mean of its pixels; never enlarged."""
    for axis, wanted in enumerate((height, width)):
        count = pixels.shape[axis]
        if wanted >= count:
            continue
        starts = np.arange(wanted) * count // wanted
        sizes = np.diff(np.append(starts, count)).reshape((-1, 1, 1) if axis == 0 else (1, -1, 1))
        pixels = np.add.reduceat(pixels, starts, axis=axis) / sizes.astype(np.float32)
    return pixels


def bilinear(pixels: Pixels, column: NDArray[np.float64], row: NDArray[np.float64]) -> NDArray[np.float32]:
    """Between pixel centers at whole `column` and `row`, any shape; both wrap around."""
    height, width = pixels.shape[:2]
    left, low = np.floor(column).astype(np.int64), np.floor(row).astype(np.int64)
    across, up = (column - left)[..., None], (row - low)[..., None]
    low, high = low % height, (low + 1) % height
    left, right = left % width, (left + 1) % width
    below = pixels[low, left] * (1.0 - across) + pixels[low, right] * across
    above = pixels[high, left] * (1.0 - across) + pixels[high, right] * across
    return (below * (1.0 - up) + above * up).astype(np.float32)


def stretched(pixels: Pixels, height: int, width: int) -> NDArray[np.float32]:
    """The image at another resolution, as linear interpolation with repetition shows it."""
    if pixels.shape[:2] == (height, width):
        return np.asarray(pixels, np.float32)
    row = (np.arange(height) + 0.5) / height * pixels.shape[0] - 0.5
    column = (np.arange(width) + 0.5) / width * pixels.shape[1] - 0.5
    return bilinear(pixels, *np.meshgrid(column, row))
