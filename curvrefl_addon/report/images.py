# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Pictures in and out: float32 arrays (height, width, 4), scene-linear Rec.709, row 0 at the BOTTOM.

All goes through Blender's own image datablocks, which are removed again (OpenEXR files in `scene.exr_files`). A PNG
keeps the straight, display-encoded bytes it is given.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..scene.arrays import Float32Array
from ..scene.exr_files import as_rgba, load_exr, save_exr, save_image
from .display import display_transform

__all__ = ["as_rgba", "load_exr", "save_exr", "save_png", "to_image_datablock"]


def to_image_datablock(name: str, array: Float32Array) -> bpy.types.Image:
    """A new packed float image in the open file, scene-linear, that shows `array` (see `as_rgba`) as it is."""
    rgba = as_rgba(array)
    image: Any = bpy.data.images.new(name, rgba.shape[1], rgba.shape[0], alpha=True, float_buffer=True)
    image.alpha_mode = "PREMUL"
    image.pixels.foreach_set(rgba.ravel())
    image.update()
    image.pack()
    return image


def save_png(path: Path | str, linear_rgba: Float32Array) -> None:
    """Write scene-linear, premultiplied `linear_rgba` (see `as_rgba`) as an 8-bit PNG through `display_transform`.

    Raises OSError when the file cannot be written.
    """
    rgba = as_rgba(linear_rgba)
    alpha = np.clip(rgba[..., 3:], 0.0, 1.0)
    straight = np.divide(rgba[..., :3], alpha, out=np.zeros_like(rgba[..., :3]), where=alpha > 0.0)
    encoded = np.concatenate((display_transform(straight), alpha), axis=2)
    image: Any = bpy.data.images.new("curvrefl png", rgba.shape[1], rgba.shape[0], alpha=True, float_buffer=False)
    try:
        # A byte image stores what it is given; rounding here keeps the choice ours.
        image.pixels.foreach_set((np.round(encoded * 255.0) / 255.0).astype(np.float32).ravel())
        save_image(image, "PNG", Path(path))
    finally:
        bpy.data.images.remove(image)
