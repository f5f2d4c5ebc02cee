# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a method changes from one frame to the next that the truth does not: flicker, pops and holes. Pure numpy.

With M the method's picture and R the converged one, both as a display shows them, and w where the frame before shows
in its mirror what pixel x shows now, flicker is D(x) = (M_t(x) - M_t-1(w(x))) - (R_t(x) - R_t-1(w(x))). The frame
before is looked up between its pixels (bilinear), method and reference alike; so noise of one frame that is independent
of the other's counts as sqrt(1 + s) times its standard deviation, s being the sum of the squared weights (between 1/4
and 1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...report.display import display_transform
from ...scene.arrays import Float64Array, Int32Array
from .kept import FAILED, REFERENCE, KeptFrame

NEAR = 0.05
"""Share of its distance by which a point may be off what a pixel shows and still be the one that is seen there"""


@dataclass(frozen=True, slots=True, eq=False)
class Followed:
    """The n pixels of a frame whose scene point was seen in the same mirror in the frame before."""

    pixel: NDArray[np.int64]
    """(n,) number in a picture (h, w)"""
    corner: NDArray[np.int64]
    """(n, 4) pixels of the frame before about its place there"""
    weight: Float64Array
    """(n, 4) of them, bilinear"""

    def before(self, picture: Float64Array) -> Float64Array:
        """(n, channels) of a picture (h, w, channels) of the frame before, at the places there."""
        flat = picture.reshape(-1, picture.shape[-1])
        return np.einsum("nk,nkc->nc", self.weight, flat[self.corner])


@dataclass(frozen=True, slots=True)
class Pops:
    """How much farther than in truth what a method shows has moved, pixels."""

    largest: float
    p99: float
    pixel: tuple[int, int]
    """Of the largest, from the left and from the bottom"""


def follow(now: KeptFrame, before: KeptFrame) -> Followed:
    """Of a frame and the one before it. All four pixels about the place must show the same mirror, and one of them the
    same object, as far away: else something hid it, or the mirror was not there."""
    height, width = now.mask.shape
    known = np.isfinite(now.place).all(axis=-1) & (now.mask != 0)
    pixel = np.flatnonzero(known)
    there = np.column_stack([pixel % width, pixel // width]) + now.place.reshape(-1, 2)[pixel].astype(np.float64)
    first = np.floor(there)
    # (On the last column or row the next one has no weight.)
    first = np.where((there == first) & (first == np.array([width - 1, height - 1])), first - 1.0, first)
    inside = ((first >= 0.0) & (first + 1.0 < np.array([width, height]))).all(axis=1)
    pixel, there, first = pixel[inside], there[inside], first[inside].astype(np.int64)
    corner = (first[:, 1] * width + first[:, 0])[:, None] + np.array([0, 1, width, width + 1])
    x, y = (there - first).T
    weight = np.column_stack([(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y])
    mirror, shown = _as_numbered(now.mask, now, before), _as_numbered(now.object, now, before)
    same_mirror = ((before.mask.ravel()[corner] == mirror.ravel()[pixel, None]) | (weight == 0.0)).all(axis=1)
    same_object = (before.object.ravel()[corner] == shown.ravel()[pixel, None]) & (weight > 0.0)
    distance = before.distance.ravel()[corner].astype(np.float64)
    expected = now.distance_before.ravel()[pixel].astype(np.float64)
    is_seen = (same_object & _is_near(np.where(same_object, distance, np.nan), expected)).any(axis=1)
    kept = same_mirror & is_seen
    return Followed(pixel[kept], corner[kept], weight[kept])


def _is_near(distance: Float64Array, expected: Float64Array) -> NDArray[np.bool_]:
    """(n, 4) whether pixels about a place, so far away (NaN: another object), may show a point that is `expected` (n,)
    so far away: within NEAR of it, or no farther from it than they are from each other."""
    infinite = np.isinf(distance) & np.isinf(expected)[:, None]
    finite = np.where(np.isfinite(distance), distance, np.nan)
    low, high = (np.where(np.isnan(finite), end, finite) for end in (np.inf, -np.inf))
    spread = high.max(axis=1) - low.min(axis=1)
    off = np.abs(finite - np.where(np.isfinite(expected), expected, np.nan)[:, None])
    reach = np.maximum(NEAR * np.where(np.isfinite(expected), expected, 0.0), spread)
    return infinite | (off <= reach[:, None])


def shown_error(kept: KeptFrame, name: str) -> Float64Array:
    """(h, w, 3) display values of a method or peer less those of the reference."""
    shown, right = (display_transform(kept.pictures[title]).astype(np.float64) for title in (name, REFERENCE))
    return shown - right


def flicker(now: KeptFrame, before: KeptFrame, followed: Followed, name: str) -> Float64Array:
    """(n, 3) D of the followed pixels, in display values from 0 to 1."""
    error = shown_error(now, name).reshape(-1, 3)[followed.pixel]
    return error - followed.before(shown_error(before, name))


def flicker_numbers(change: Float64Array) -> dict[str, float] | None:
    """Of D (n, 3): mean, p95 and p99 of its size (the mean of the channels' absolute values), and its root mean square;
    None where no pixel is followed."""
    if len(change) == 0:
        return None
    size = np.abs(change).mean(axis=1)
    p95, p99 = np.percentile(size, (95.0, 99.0))
    return {
        "mean": float(size.mean()),
        "p95": float(p95),
        "p99": float(p99),
        "rms": float(np.sqrt(np.square(change).mean())),
    }


def pops(now: KeptFrame, before: KeptFrame, followed: Followed, method: str) -> Pops | None:
    """From where a method shows what it shows too far to a side, in both frames, where both show the same object; None
    where there is no such pixel."""
    one, two = now.shown[method], before.shown[method]
    objects = _as_numbered(one.object, now, before).ravel()[followed.pixel]
    offset = one.offset.reshape(-1, 2)[followed.pixel].astype(np.float64)
    past = two.offset.reshape(-1, 2)[followed.corner].astype(np.float64)
    usable = (two.object.ravel()[followed.corner] == objects[:, None]) & np.isfinite(past).all(axis=2)
    weight = np.where(usable, followed.weight, 0.0)
    total = weight.sum(axis=1)
    kept = np.flatnonzero((total > 0.0) & np.isfinite(offset).all(axis=1) & (objects != FAILED))
    if len(kept) == 0:
        return None
    past = np.einsum("nk,nkj->nj", weight[kept], np.where(usable[kept, :, None], past[kept], 0.0))
    moved = np.linalg.norm(offset[kept] - past / total[kept, None], axis=1)
    worst = followed.pixel[kept[moved.argmax()]]
    width = now.mask.shape[1]
    return Pops(float(moved.max()), float(np.percentile(moved, 99.0)), (int(worst % width), int(worst // width)))


def holes(kept: KeptFrame, method: str) -> int:
    """Pixels in which a method shows no mirror, nothing that is a number, or the background, though Cycles shows
    objects in the mirror there and in all eight pixels about it: edges do not count."""
    is_surface = (kept.mask != 0) & (kept.object != 0)
    inner = is_surface.copy()
    padded = np.pad(is_surface, 1)
    height, width = is_surface.shape
    for row in range(3):
        for column in range(3):
            inner &= padded[row : row + height, column : column + width]
    return int(np.count_nonzero(inner & (kept.shown[method].object <= 0)))


def _as_numbered(numbers: Int32Array, now: KeptFrame, before: KeptFrame) -> Int32Array:
    """Objects of a frame by their numbers in the frame before: names say which is which. FAILED where there is none."""
    there = {name: number for number, name in before.objects.items()}
    found = np.where(numbers <= 0, numbers, FAILED)
    for number, name in now.objects.items():
        found[numbers == number] = there.get(name, FAILED)
    return found
