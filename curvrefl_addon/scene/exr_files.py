# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenEXR files in and out: float32 arrays (height, width, 4), row 0 at the BOTTOM, bit for bit.

All goes through Blender's own image datablocks, which are removed again. An EXR must be read and written as
"Non-Color" or it may be converted, and its alpha must stay as it is stored (premultiplied).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..streams import STDERR, dropped
from ..written_files import error_in, require_whole
from .arrays import Float32Array


def as_rgba(array: Float32Array) -> Float32Array:
    """(h, w), (h, w, 1), (h, w, 3) or (h, w, 4) as a contiguous (h, w, 4); gray is repeated, missing alpha is 1."""
    values = np.asarray(array, np.float32)
    if values.ndim == 2:
        values = values[..., None]
    if values.ndim != 3 or values.shape[2] not in (1, 3, 4):
        raise ValueError(f"an image must be (height, width[, 1 | 3 | 4]), not {values.shape}")
    rgba = np.ones((*values.shape[:2], 4), np.float32)
    rgba[..., : max(values.shape[2], 3)] = values
    return rgba


def save_exr(path: Path | str, array: Float32Array) -> None:
    """Write `array` (see `as_rgba`) as a 32-bit float OpenEXR file, bit for bit.

    Raises OSError when the file cannot be written.
    """
    rgba = as_rgba(array)
    image: Any = bpy.data.images.new("curvrefl exr", rgba.shape[1], rgba.shape[0], alpha=True, float_buffer=True)
    try:
        image.colorspace_settings.name = "Non-Color"
        image.alpha_mode = "PREMUL"
        image.pixels.foreach_set(rgba.ravel())
        save_image(image, "OPEN_EXR", Path(path))
    finally:
        bpy.data.images.remove(image)


def load_exr(path: Path | str) -> Float32Array:
    """(h, w, 4) as stored in a single-layer file, bit for bit for 32-bit files.

    Raises OSError when it cannot be read.
    """
    path = Path(path).absolute()
    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist")
    image: Any = bpy.data.images.load(str(path), check_existing=False)
    try:
        image.colorspace_settings.name = "Non-Color"
        width, height = image.size
        if width == 0 or height == 0:
            raise OSError(f"{path} is not an image that Blender can read")
        pixels = np.empty(width * height * 4, np.float32)
        image.pixels.foreach_get(pixels)
    finally:
        bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)


def save_image(image: Any, file_format: str, path: Path) -> None:
    """Write an image datablock. Raises OSError when the file cannot be written, or not whole."""
    image.file_format = file_format
    image.filepath_raw = str(path.absolute())
    try:
        # (it says more on stderr than the error does)
        with dropped(STDERR):
            image.save()
    except RuntimeError as error:
        raise error_in(str(error), path) from error
    require_whole(path)
