# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's images as scene-linear pixels."""

from __future__ import annotations

from typing import Any

import bpy
import imbuf
import numpy as np

from ...memory import exceeds_memory
from ..arrays import Float32Array
from ..camera.srgb import linear_to_srgb, srgb_to_linear
from ..finite import usable_pixels
from ..programs.image_pixels import four_channels
from ..remarks import Remark
from .color_spaces import rec709_to_scene
from .pixels import stretched

MISSING_COLOR = (1.0, 0.0, 1.0, 1.0)
"""What Blender shows for an image that is not there"""
IMAGE_BYTES = 40
"""For a pixel: Blender's own, and ours while they are converted"""
# Blender's names of the color spaces whose numbers are those of the scene (or are no colors at all).
_LINEAR = ("Non-Color", "Linear Rec.709", "Linear", "Raw", "scene_linear")
_DATA = ("Non-Color", "Raw", "scene_linear")
MAGNIFIED = 1024
"""Images of bytes are interpolated up to this size, pixels along a side"""
MOST_MAGNIFIED = 7

type _Key = tuple[int, str, bool]
"""Image (session_uid), file of the frame shown, whether alpha is used by itself"""


class ImageReader:
    """Reads each image once, and again after `forget`."""

    def __init__(self) -> None:
        self.reads = 0
        """How many images have been read"""
        self._pixels: dict[_Key, Float32Array] = {}
        self._remarks: dict[_Key, list[Remark]] = {}

    @property
    def remarks(self) -> list[Remark]:
        """What of the images is not drawn as it is."""
        return [remark for remarks in self._remarks.values() for remark in remarks]

    @property
    def sequences(self) -> set[int]:
        """Images (session_uid) of which one frame is shown."""
        return {uid for uid, frame, _ in self._pixels if frame}

    def read(self, image: bpy.types.Image, user: Any = None, splits_alpha: bool = False) -> Float32Array:
        """(height, width, 4) scene-linear, row 0 at the bottom.

        `user`: the node's ImageUser, evaluated, which says what frame of a sequence is shown. Colors are multiplied
        with alpha as Cycles does where nothing uses a node's alpha; with `splits_alpha` divided by it again, as where
        something does. Packed and generated images too. A missing file gives one magenta pixel and a remark.
        """
        frame = _frame_path(image, user)
        key = (image.original.session_uid, frame, splits_alpha)
        if key not in self._pixels:
            self._remarks[key] = []
            self._pixels[key] = self._read(image, key, self._remarks[key])
            self.reads += 1
        return self._pixels[key]

    def forget_all(self) -> None:
        """Any may have changed."""
        self._pixels.clear()
        self._remarks.clear()

    def forget(self, images: set[int]) -> None:
        """These images (session_uid) changed."""
        for key in [key for key in self._pixels if key[0] in images]:
            del self._pixels[key], self._remarks[key]

    def _read(self, image: bpy.types.Image, key: _Key, remarks: list[Remark]) -> Float32Array:
        uid, frame, splits_alpha = key
        if image.source == "TILED":
            remarks.append(Remark("Only the first tile {of} is drawn.", "image", image.name))
        if image.source == "MOVIE":
            remarks.append(Remark("Movies are not shown: the pixels {of} are drawn magenta.", "image", image.name))
            return _missing()
        # (asked for its size, Blender would generate it)
        is_generated = image.source == "GENERATED"
        width, height = (image.generated_width, image.generated_height) if is_generated else image.size
        if exceeds_memory(IMAGE_BYTES * width * height):
            remarks.append(Remark("Memory does not do for the pixels {of}: drawn magenta.", "image", image.name))
            return _missing()
        found = _frame_pixels(frame) if frame else _own_pixels(image)
        if found is None:
            cause = "The pixels {of} are missing: drawn magenta, as in Cycles."
            if image.type != "IMAGE":
                cause = "Layers {of} are not read: drawn magenta."
            remarks.append(Remark(cause, "image", image.name))
            return _missing()
        pixels, is_float = found
        if is_float:
            pixels, count = usable_pixels(pixels)
            if count:
                remarks.append(
                    Remark(f"Pixels {{of}} that are not usable numbers ({count}) are drawn black.", "image", image.name)
                )
        # Blender makes float images linear as it loads them; bytes stay as they are in the file.
        space = image.colorspace_settings.name
        if space not in _DATA and image.alpha_mode in ("STRAIGHT", "PREMUL") and pixels[..., 3].min() < 1.0:
            _use_alpha(pixels, image, is_float, splits_alpha)
        elif (uid, frame, not splits_alpha) in self._pixels:
            # The same either way.
            return self._pixels[uid, frame, not splits_alpha]
        if not is_float and space not in _LINEAR:
            if space != "sRGB":
                remarks.append(Remark(f'Color space "{space}" {{of}} is taken for sRGB.', "image", image.name))
            _decode_srgb(pixels)
        if not is_float and space not in _DATA:
            # Bytes hold linear Rec.709 then, whatever the file's working space.
            pixels = rec709_to_scene(pixels)
        return pixels


def _missing() -> Float32Array:
    return np.array([[MISSING_COLOR]], np.float32)


def _frame_path(image: bpy.types.Image, user: Any) -> str:
    """The file with the frame of a sequence that is shown; "" for other images."""
    if image.source != "SEQUENCE" or user is None:
        return ""
    return bpy.path.abspath(image.filepath_from_user(image_user=user), library=image.library)


def _own_pixels(image: bpy.types.Image) -> tuple[Float32Array, bool] | None:
    """(h, w, 4) as in the image, and whether these are floats; None where it has none."""
    width, height = image.size
    image_pixels: Any = image.pixels
    pixels = np.empty(width * height * image.channels, np.float32)
    if pixels.size and len(image_pixels) == pixels.size:
        image_pixels.foreach_get(pixels)
    if pixels.size == 0 or not image.has_data:
        return None
    return four_channels(pixels.reshape(height, width, -1)), bool(image.is_float)


def _frame_pixels(path: str) -> tuple[Float32Array, bool] | None:
    """The same of a file."""
    try:
        loaded = imbuf.load(path)
    except (OSError, ValueError):
        return None
    try:
        with loaded.with_buffer() as buffer:
            values = np.array(buffer)
    finally:
        loaded.free()
    is_float = values.dtype != np.uint8
    pixels = values.astype(np.float32) if is_float else values.astype(np.float32) / np.float32(255.0)
    return four_channels(pixels.reshape(*values.shape[:2], -1)), is_float


def _use_alpha(pixels: Float32Array, image: bpy.types.Image, is_float: bool, splits_alpha: bool) -> None:
    """Multiply colors with alpha, and divide them by it where a node's alpha is used, as Cycles does; in place.

    Cycles takes a file's own numbers, but Blender's of what is generated, painted or packed; and so those of
    straight alpha are multiplied where they are not yet.
    """
    alpha = pixels[..., 3:]
    is_blenders = image.source == "GENERATED" or image.is_dirty or image.packed_file is not None
    is_straight = image.alpha_mode == "STRAIGHT"
    if (is_straight and (is_blenders or not is_float)) or (not is_straight and not is_float and not is_blenders):
        pixels[..., :3] *= alpha
    elif is_float and not is_blenders and not splits_alpha and image.colorspace_settings.name == "sRGB":
        # The file's numbers are encoded as they are, where Blender divides them by alpha first.
        colors = np.divide(pixels[..., :3], alpha, out=np.zeros_like(pixels[..., :3]), where=alpha > 0.0)
        pixels[..., :3] = srgb_to_linear(linear_to_srgb(colors) * alpha)
    if splits_alpha:
        np.divide(pixels[..., :3], alpha, out=pixels[..., :3], where=alpha > 0.0)
        if not is_float:
            np.minimum(pixels, 1.0, out=pixels)


def magnified(image: bpy.types.Image, pixels: Float32Array, wraps: bool) -> Float32Array:
    """Pixels of a small image of bytes at several times its resolution, others as they are.

    Between pixels Cycles interpolates bytes, and makes them linear after that.
    """
    height, width = pixels.shape[:2]
    factor = min(MAGNIFIED // max(height, width), MOST_MAGNIFIED)
    # (Odd: the pixels' own centers stay.)
    factor -= (factor + 1) % 2
    if (
        factor < 3
        or image.is_float
        or image.colorspace_settings.name in _LINEAR
        or not np.ptp(pixels, axis=(0, 1)).any()
    ):
        return pixels
    encoded = np.concatenate([linear_to_srgb(pixels[..., :3]), pixels[..., 3:]], axis=-1)
    finer = stretched(encoded, factor * height, factor * width, wraps)
    finer[..., :3] = srgb_to_linear(finer[..., :3])
    return finer


def _decode_srgb(pixels: Float32Array) -> None:
    """Make the colors of a byte image (h, w, 4) linear, in place; a few rows at a time, which stay in the cache."""
    table = _srgb_table()
    for start in range(0, len(pixels), 16):
        rows = pixels[start : start + 16]
        alpha = rows[..., 3].copy()
        rows[...] = table.take((rows * np.float32(255.0) + np.float32(0.5)).astype(np.uint8))
        rows[..., 3] = alpha


def _srgb_table() -> Float32Array:
    """(256,) linear value of each byte."""
    return srgb_to_linear(np.arange(256, dtype=np.float32) / 255.0)
