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


def bilinear(
    pixels: Pixels, column: NDArray[np.float64], row: NDArray[np.float64], wraps: bool = True
) -> NDArray[np.float32]:
    """Between pixel centers at whole `column` and `row`, any shape; both wrap around or stay on the image."""
    height, width = pixels.shape[:2]
    if not wraps:
        column, row = np.clip(column, 0.0, width - 1.0), np.clip(row, 0.0, height - 1.0)
    left, low = np.floor(column).astype(np.int64), np.floor(row).astype(np.int64)
    across, up = (column - left)[..., None], (row - low)[..., None]
    low, high = low % height, (low + 1) % height
    left, right = left % width, (left + 1) % width
    below = pixels[low, left] * (1.0 - across) + pixels[low, right] * across
    above = pixels[high, left] * (1.0 - across) + pixels[high, right] * across
    return (below * (1.0 - up) + above * up).astype(np.float32)


def stretched(pixels: Pixels, height: int, width: int, wraps: bool = True) -> NDArray[np.float32]:
    """The image at another resolution, as linear interpolation shows it, repeated or not."""
    if pixels.shape[:2] == (height, width):
        return np.asarray(pixels, np.float32)
    row = (np.arange(height) + 0.5) / height * pixels.shape[0] - 0.5
    column = (np.arange(width) + 0.5) / width * pixels.shape[1] - 0.5
    columns, rows = np.meshgrid(column, row)
    return bilinear(pixels, columns, rows, wraps)
