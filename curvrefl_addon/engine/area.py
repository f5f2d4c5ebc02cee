# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which pixels of a picture are rendered: all, or those in the border."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..scene.arrays import Float32Array
from ..scene.camera.film import rendered_size
from ..scene.camera.view import View


@dataclass(frozen=True, slots=True)
class Area:
    """Some pixels of a picture of `full_width` x `full_height`, from the bottom left."""

    full_width: int
    full_height: int
    x: int
    y: int
    width: int
    height: int

    def view(self, full: View) -> View:
        """What `full` sees in these pixels, on a picture of their number."""
        onto = np.eye(4)
        onto[0, 0], onto[0, 3] = self._stretch(self.full_width, self.x, self.width)
        onto[1, 1], onto[1, 3] = self._stretch(self.full_height, self.y, self.height)
        return replace(full, view_to_clip=onto @ full.view_to_clip, width=self.width, height=self.height)

    def uncropped(self, pixels: Float32Array) -> Float32Array:
        """(full_height, full_width, ...) with the area's pixels (height, width, ...) in their place and 0 elsewhere."""
        whole = np.zeros((self.full_height, self.full_width, *pixels.shape[2:]), pixels.dtype)
        whole[self.y : self.y + self.height, self.x : self.x + self.width] = pixels
        return whole

    @staticmethod
    def _stretch(full: int, start: int, length: int) -> tuple[float, float]:
        return full / length, (full - 2 * start - length) / length


def area_of(render: Any) -> Area:
    """Of a scene's `RenderSettings`, rounded as Blender does."""
    width, height = rendered_size(render)
    if not render.use_border:
        return Area(width, height, 0, 0, width, height)
    left, right = (int(np.float32(share) * np.float32(width)) for share in (render.border_min_x, render.border_max_x))
    low, high = (int(np.float32(share) * np.float32(height)) for share in (render.border_min_y, render.border_max_y))
    return Area(width, height, left, low, max(right - left, 1), max(high - low, 1))
