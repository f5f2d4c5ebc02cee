# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What some pixels of mirrors show, against rays in float64: how far off in pixels, wrong objects, holes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from curvrefl.curvrefl_addon.renderer.truth.shown_points import NOTHING
from curvrefl.curvrefl_addon.scene.arrays import Float64Array, SceneArrays
from curvrefl.curvrefl_addon.scene.camera.view import View
from curvrefl.curvrefl_addon.study.dataset.float64_rays import Float64Rays
from numpy.typing import NDArray

AROUND = ((0, 0), (1, 0), (0, 1), (-1, 0), (0, -1))
"""Of a pixel: itself, and those beside it"""


@dataclass(frozen=True)
class PixelErrors:
    """Of one picture."""

    pixels: Float64Array
    """(n,) how far what a pixel shows is from where it is shown in truth, where both are of one surface"""
    wrong: int
    """Pixels that show what neither they nor those beside them show in truth"""
    holes: int
    """Pixels that show nothing where they and all beside them show something in truth"""
    judged: int


class TruePixels:
    """Pixels chosen at random among those of the mirrors that have others of the mirrors on all sides."""

    def __init__(self, rays: Float64Rays, view: View, mask: NDArray[np.bool_], count: int) -> None:
        """`mask` (h, w): which pixels show mirrors."""
        inner = np.zeros_like(mask)
        inner[1:-1, 1:-1] = mask[1:-1, 1:-1] & mask[:-2, 1:-1] & mask[2:, 1:-1] & mask[1:-1, :-2] & mask[1:-1, 2:]
        found = np.flatnonzero(inner)
        self.chosen = np.sort(np.random.default_rng(1).choice(found, min(count, len(found)), replace=False))
        wanted = np.stack([self.chosen + dx + dy * view.width for dx, dy in AROUND], axis=1)
        every, back = np.unique(wanted, return_inverse=True)
        points = rays.points(view, lambda _: None, every)
        # (A pixel of the mask whose float64 ray just misses the mirror is not judged.)
        row = np.full(len(every), -1)
        row[np.searchsorted(every, points.pixel)] = np.arange(len(points.pixel))
        rows = row[back.reshape(wanted.shape)]
        kept = (rows >= 0).all(axis=1) & (len(points.pixel) > 0)
        self.chosen, rows = self.chosen[kept], rows[kept]
        ids = np.array([item.object_id for item in rays.scene.instances], np.int64)
        self._instance = points.instance[rows]
        self._object = np.where(self._instance == NOTHING, 0, ids[np.maximum(self._instance, 0)])
        self._place = points.shown[rows, :3]

    def errors(self, shown: NDArray[np.float32]) -> PixelErrors:
        """`shown` (h, w, 4): points with the number of their object, 0 where that is the background."""
        here = shown.reshape(-1, 4)[self.chosen].astype(float)
        number = np.rint(here[:, 3]).astype(np.int64)
        alike = (self._instance == self._instance[:, :1]).all(axis=1) & (self._instance[:, 0] != NOTHING)
        alike &= number == self._object[:, 0]
        off = here[alike, :3] - self._place[alike, 0]
        # One pixel on, what is shown is so far on: the mean of both sides.
        right = 0.5 * (self._place[alike, 1] - self._place[alike, 3])
        up = 0.5 * (self._place[alike, 2] - self._place[alike, 4])
        steps = np.stack([right, up], axis=-1)
        pixels = np.einsum("nij,nj->ni", np.linalg.pinv(steps), off)
        return PixelErrors(
            np.linalg.norm(pixels, axis=1),
            int((number[:, None] != self._object).all(axis=1).sum()),
            int(((number == 0) & (self._object > 0).all(axis=1)).sum()),
            len(number),
        )


def holes(shown: NDArray[np.float32], exact: NDArray[np.float32], mask: NDArray[np.bool_]) -> int:
    """Pixels of a mirror that show nothing where by rays they and all beside them show something. Arrays (h, w, 4) as
    for `errors`, mask (h, w)."""
    there = mask & (exact[..., 3] > 0.5)
    inner = np.zeros_like(there)
    inner[1:-1, 1:-1] = there[1:-1, 1:-1] & there[:-2, 1:-1] & there[2:, 1:-1] & there[1:-1, :-2] & there[1:-1, 2:]
    return int((inner & (shown[..., 3] < 0.5)).sum())


def float64_rays(scene: SceneArrays, before: Float64Rays | None) -> Float64Rays:
    """Of a frame; those of the frame before where the scene is the same."""
    if before is not None and before.scene.instances == scene.instances and before.scene.meshes == scene.meshes:
        return before
    return Float64Rays(scene)
