# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that is looked up between its pixels and averaged over areas. Pure numpy."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...scene.arrays import Float32Array, Float64Array
from ...scene.camera.srgb import linear_to_srgb, srgb_to_linear

FINEST, COARSEST = 1, 8
"""Lookups along a side of a texel"""
EDGE_LOOKUPS = 4
"""Of texels through which the picture's edge goes, at least"""
AT_ONCE = 1 << 18
"""Texels that are looked up together"""


@dataclass
class Picture:
    """Pixels as they are stored, row 0 at the bottom; places in it go from 0 to 1."""

    pixels: Float32Array
    """(h, w, 4), alpha not multiplied in"""
    is_encoded: bool
    """Its colors are on the curve of sRGB: interpolated so, as Cycles and the viewport do, and averaged linear"""
    _levels: list[Float32Array] = field(default_factory=list)
    """Itself with alpha multiplied in, and each half the size of the one before"""

    def __post_init__(self) -> None:
        colors = self.pixels[..., :3] * self.pixels[..., 3:]
        self._levels = [np.concatenate([colors, self.pixels[..., 3:]], axis=2)]

    @property
    def width(self) -> int:
        return self.pixels.shape[1]

    @property
    def height(self) -> int:
        return self.pixels.shape[0]

    def at(self, places: Float64Array, level: int = 0) -> Float64Array:
        """(n, 4) linear colors times alpha, and alpha, between the pixels about places (n, 2); 0 outside."""
        pixels = self._level(level)
        places = np.nan_to_num(places, nan=-1.0)
        height, width = pixels.shape[:2]
        column, row = places[:, 0] * width - 0.5, places[:, 1] * height - 0.5
        left, low = np.floor(column).astype(np.int64), np.floor(row).astype(np.int64)
        x, y = (column - left)[:, None], (row - low)[:, None]
        left, right = (np.clip(value, 0, width - 1) for value in (left, left + 1))
        low, high = (np.clip(value, 0, height - 1) for value in (low, low + 1))
        lower = (1.0 - x) * pixels[low, left] + x * pixels[low, right]
        upper = (1.0 - x) * pixels[high, left] + x * pixels[high, right]
        found = (1.0 - y) * lower + y * upper
        if self.is_encoded:
            alpha = np.maximum(found[:, 3:], 1e-9)
            found[:, :3] = srgb_to_linear(found[:, :3] / alpha) * found[:, 3:]
        inside = (places >= 0.0).all(axis=1) & (places <= 1.0).all(axis=1)
        return np.where(inside[:, None], found, 0.0)

    def over(self, middles: Float64Array, spans: Float64Array) -> Float64Array:
        """(n, 4) the mean of `at` over parallelograms about middles (n, 2) whose sides are the columns of (n, 2, 2)."""
        result = np.empty((len(middles), 4))
        for first in range(0, len(middles), AT_ONCE):
            some = slice(first, first + AT_ONCE)
            result[some] = self._over(middles[some], spans[some])
        return result

    def _over(self, middles: Float64Array, spans: Float64Array) -> Float64Array:
        size = np.array([self.width, self.height], np.float64)
        extent = np.linalg.norm(spans * size[:, None], axis=1).max(axis=1)
        lookups = np.clip(np.ceil(np.nan_to_num(extent)), FINEST, COARSEST)
        level = np.ceil(np.log2(np.maximum(np.nan_to_num(extent, posinf=1e30) / COARSEST, 1.0))).astype(np.int64)
        level = np.minimum(level, int(np.log2(max(min(self.width, self.height), 1))))
        reach = 0.5 * np.abs(spans).sum(axis=2)
        is_edge = ((middles < reach) & (middles > -reach)) | ((middles > 1.0 - reach) & (middles < 1.0 + reach))
        lookups = np.where(is_edge.any(axis=1), np.maximum(lookups, EDGE_LOOKUPS), lookups).astype(np.int64)
        result = np.zeros((len(middles), 4))
        for key in np.unique(lookups * 64 + level).tolist():
            count, depth = divmod(key, 64)
            some = np.flatnonzero((lookups == count) & (level == depth))
            offsets = (np.arange(count) + 0.5) / count - 0.5
            for x in offsets.tolist():
                for y in offsets.tolist():
                    result[some] += self.at(middles[some] + spans[some] @ np.array([x, y]), depth)
            result[some] /= count**2
        return result

    def stored(self, colors: Float64Array) -> Float32Array:
        """(..., 4) as its own pixels, of linear colors times alpha."""
        alpha = np.clip(colors[..., 3:], 0.0, 1.0)
        straight = np.divide(colors[..., :3], alpha, out=np.zeros_like(colors[..., :3]), where=alpha > 0.0)
        if self.is_encoded:
            straight = linear_to_srgb(straight)
        return np.concatenate([straight, alpha], axis=-1).astype(np.float32)

    def _level(self, level: int) -> Float32Array:
        while len(self._levels) <= level:
            self._levels.append(_halved(self._levels[-1], self.is_encoded))
        return self._levels[level]


def _halved(pixels: Float32Array, is_encoded: bool) -> Float32Array:
    """The mean of each two by two, linear; the last row and column count twice where their number is odd."""
    height, width = pixels.shape[:2]
    even = np.pad(pixels, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
    alpha = np.maximum(even[..., 3:], 1e-9)
    linear = srgb_to_linear(even[..., :3] / alpha) * even[..., 3:] if is_encoded else even[..., :3]
    both = np.concatenate([linear, even[..., 3:]], axis=2).reshape(even.shape[0] // 2, 2, even.shape[1] // 2, 2, 4)
    mean = both.mean(axis=(1, 3))
    if is_encoded:
        opaque = np.maximum(mean[..., 3:], 1e-9)
        mean[..., :3] = linear_to_srgb(mean[..., :3] / opaque) * mean[..., 3:]
    return mean.astype(np.float32)
