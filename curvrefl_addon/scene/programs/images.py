# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The images that nodes show, each once: what Cycles would keep of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ...memory import exceeds_memory
from ..arrays import Float32Array, ImageSource
from ..finite import usable_pixels
from ..materials.color_spaces import REC709, working_space
from ..remarks import Remark
from .image_headers import HEADER_BYTES, Header, header_of
from .image_pixels import (
    FLOAT_FORMATS,
    blender_pixels,
    decoded,
    four_channels,
    multiplied,
    narrowed,
    raw_pixels,
    scene_linear,
    to_bytes,
    truncated,
    without_alpha,
)

DATA = "Non-Color"
"""Blender's name of the space of what are no colors"""
FIRST_TILE = 1001
FLOAT_PIXEL_BYTES, BYTE_PIXEL_BYTES = 40, 12
"""That reading an image takes at most"""
_LINEAR = ("Linear", "Raw", "scene_linear")
"""Names of the working space beside its own"""

_OF_BYTES = (0.0, 1.0)

type _Key = tuple[int, str, int, int, str, str]
"""Image (session_uid), file shown, frame of a sequence or -1, tile or 0, color space, alpha mode"""


@dataclass(frozen=True, slots=True)
class _Kept:
    source: ImageSource
    remarks: tuple[Remark, ...]


class ProgramImages:
    """Finds the images of nodes (`builder.Images`) and lists them."""

    def __init__(self) -> None:
        self.reads = 0
        """How many images have been looked at"""
        self._sources: list[ImageSource] = []
        self._places: dict[_Key, int] = {}
        self._kept: dict[_Key, _Kept] = {}
        self._contents: dict[Any, ImageSource] = {}
        """By what packed files have in them"""

    @property
    def sources(self) -> tuple[ImageSource, ...]:
        """All that nodes have asked for since `restart`: `SceneArrays.images`."""
        return tuple(self._sources)

    @property
    def remarks(self) -> list[Remark]:
        """What of these is not drawn as it is."""
        return [remark for key in self._places for remark in self._kept[key].remarks]

    @property
    def sequences(self) -> set[int]:
        """Images (session_uid) that another frame may change."""
        return {key[0] for key in self._places if key[2] >= 0}

    def restart(self) -> None:
        """All nodes are asked anew. Images that they show again stay the same objects."""
        self._kept = {key: kept for key, kept in self._kept.items() if key in self._places}
        shown = {id(kept.source) for kept in self._kept.values()}
        self._contents = {key: source for key, source in self._contents.items() if id(source) in shown}
        self._sources.clear()
        self._places.clear()

    def forget(self, images: set[int]) -> None:
        """These (session_uid) changed; `restart` goes with it."""
        self._kept = {key: kept for key, kept in self._kept.items() if key[0] not in images}

    def forget_all(self) -> None:
        """Any may have changed."""
        self._kept.clear()

    def index_of(self, node: Any, note: Callable[[str], None], tile: int = 0) -> int | None:
        """As in `builder.Images`."""
        image = node.image
        if image is None:
            return None
        file, frame = _file_of(image, node.image_user, tile, note)
        key = (
            image.original.session_uid,
            file,
            frame,
            tile,
            image.colorspace_settings.name,
            image.alpha_mode,
        )
        if key not in self._places:
            if key not in self._kept:
                reading = _Reading(image, file, tile)
                source = reading.source()
                if reading.content is not None:
                    # (Imported models bring the same image many times.)
                    source = self._contents.setdefault(reading.content, source)
                self._kept[key] = _Kept(source, tuple(reading.remarks))
                self.reads += 1
            self._places[key] = len(self._sources)
            self._sources.append(self._kept[key].source)
        return self._places[key]

    def source(self, index: int) -> ImageSource:
        """As in `builder.Images`."""
        return self._sources[index]


def uses_alpha(image: bpy.types.Image) -> bool:
    """Colors are kept multiplied with alpha, and divided by it where a node's alpha is looked at."""
    return image.alpha_mode in ("STRAIGHT", "PREMUL") and image.colorspace_settings.name != DATA


def _file_of(image: bpy.types.Image, user: Any, tile: int, note: Callable[[str], None]) -> tuple[str, int]:
    """Path of the file that is shown ("": what Blender has), and the frame of what has several, else -1."""
    if image.source == "SEQUENCE":
        frame = int(user.frame_current)
        return bpy.path.abspath(image.filepath_from_user(image_user=user), library=image.library), frame
    if image.source == "TILED":
        if image.is_dirty:
            note("What is painted on tiles {of} and not saved is not shown.")
        if len(image.packed_files):
            return "", -1
        path = bpy.path.abspath(image.filepath_raw, library=image.library)
        number = tile - FIRST_TILE
        return path.replace("<UDIM>", str(tile)).replace("<UVTILE>", f"u{number % 10 + 1}_v{number // 10 + 1}"), -1
    if image.source == "FILE" and image.packed_file is None and not image.is_dirty and image.type == "IMAGE":
        return bpy.path.abspath(image.filepath_from_user(), library=image.library), -1
    if image.source == "MOVIE":
        note("Movies {of} stand still: one frame of them is shown.")
    return "", -1


class _Reading:
    """One image while it is looked at."""

    def __init__(self, image: bpy.types.Image, file: str, tile: int) -> None:
        self._image = image
        self._file = file
        self._tile = tile
        self.remarks: list[Remark] = []
        self.content: Any = None
        """Equal for images that are alike, where that is known"""
        space = image.colorspace_settings.name
        self._is_data = space == DATA
        self._is_linear = self._is_data or space in _LINEAR or space == working_space()
        self._is_srgb = space == "sRGB" and working_space() == REC709
        self._multiplies = image.alpha_mode == "STRAIGHT" and not self._is_data
        """Colors with alpha"""

    def source(self) -> ImageSource:
        """What Cycles would keep."""
        image = self._image
        if self._file:
            return self._of_file()
        if image.type != "IMAGE" and image.type != "UV_TEST":
            self._remark("Renders and layers {of} are not read: drawn magenta.")
            return _missing(image.name)
        data = _packed(image, self._tile)
        if data is not None:
            header = header_of(data[:HEADER_BYTES])
            # (Blender's own pixels, which are straight, are multiplied as Cycles multiplies them.)
            if header is not None and image.alpha_mode != "PREMUL":
                return self._of_bytes(data, header)
        return self._of_blender()

    def _of_file(self) -> ImageSource:
        path = Path(self._file)
        try:
            with path.open("rb") as stream:
                header = header_of(stream.read(HEADER_BYTES))
            if header is not None:
                return self._of_bytes(self._file, header)
            values, kind = decoded(self._file)
        except OSError:
            return self._lost()
        if values.dtype == np.uint8:
            height, width = values.shape[:2]
            is_opaque = values.shape[2] != 4 or bool(values[..., 3].min() == 255)
            return self._of_bytes(self._file, Header(width, height, is_opaque))
        is_whole = kind not in FLOAT_FORMATS
        # (Read like this, they would be multiplied with alpha and converted.)
        if not is_whole and working_space() == REC709 and (values.shape[2] != 4 or values[..., 3].min() == 1.0):
            return self._of_floats(four_channels(values))
        pixels = raw_pixels(self._file)
        if pixels is None:
            return self._lost()
        return self._of_values(self._usable(pixels), self._multiplies, is_whole)

    def _of_bytes(self, file: str | bytes, header: Header) -> ImageSource:
        """A file of bytes, or all of its bytes."""
        image = self._image
        if exceeds_memory(BYTE_PIXEL_BYTES * header.width * header.height):
            return self._too_large()
        is_opaque = header.is_opaque or image.alpha_mode == "NONE"
        multiplies = self._multiplies and not header.is_opaque
        if header.is_gray_alpha and isinstance(file, str):
            multiplies = False
        read = partial(_read_bytes, file, (header.height, header.width), multiplies, image.alpha_mode == "NONE")
        if self._is_linear or self._is_srgb:
            if isinstance(file, bytes):
                self.content = len(file), hash(file), multiplies, image.alpha_mode == "NONE", self._is_srgb
            return ImageSource(image.name, header.width, header.height, True, self._is_srgb, is_opaque, _OF_BYTES, read)
        try:
            return self._of_values(_read_bytes(file, (header.height, header.width), False, False), multiplies)
        except OSError:
            return self._lost()

    def _of_blender(self) -> ImageSource:
        """What is generated, painted, or packed and more than bytes."""
        image = self._image
        # (Asked for its size, Blender would generate it.)
        is_generated = image.source == "GENERATED"
        width, height = (image.generated_width, image.generated_height) if is_generated else image.size
        if exceeds_memory(FLOAT_PIXEL_BYTES * width * height):
            return self._too_large()
        pixels = blender_pixels(image)
        if pixels is None:
            return self._lost()
        multiplies = self._multiplies
        if not image.is_float:
            return self._of_values(to_bytes(pixels), multiplies)
        if image.alpha_mode == "NONE":
            without_alpha(pixels)
        pixels = self._usable(pixels)
        if multiplies:
            pixels[..., :3] *= pixels[..., 3:]
        return self._of_array(pixels, False)

    def _of_floats(self, pixels: Float32Array) -> ImageSource:
        """Opaque ones, that can be read again when they are needed."""
        pixels = self._usable(pixels)
        if not self._is_linear and not self._is_srgb:
            return self._of_values(pixels, False, False)
        height, width = pixels.shape[:2]
        read = partial(_read_floats, self._file, (height, width))
        return ImageSource(self._image.name, width, height, False, self._is_srgb, True, _range_of(pixels), read)

    def _of_values(self, values: NDArray[Any], multiplies: bool, is_whole: bool = True) -> ImageSource:
        """Of bytes or floats as they are in a file; `is_whole`: of whole numbers there."""
        if self._image.alpha_mode == "NONE":
            without_alpha(values)
        if not self._is_linear and not self._is_srgb:
            return self._converted(values, multiplies, is_whole)
        if multiplies and values.dtype == np.uint8:
            multiplied(values)
        elif multiplies:
            values[..., :3] *= values[..., 3:]
        return self._of_array(values, self._is_srgb)

    def _converted(self, values: NDArray[Any], multiplies: bool, is_half: bool) -> ImageSource:
        """Of any other color space; Cycles converts whole numbers in half precision."""
        pixels = values.astype(np.float32) / np.float32(255.0 if values.dtype == np.uint8 else 1.0)
        if is_half:
            pixels = pixels.astype(np.float16).astype(np.float32)
        alpha = pixels[..., 3:]
        if multiplies:
            pixels[..., :3] *= alpha
            if is_half:
                pixels = truncated(pixels)
        # (Cycles divides and multiplies for the conversion, but where alpha is 0.)
        factor = np.where(alpha > 0.0, alpha, np.float32(1.0)) if uses_alpha(self._image) else np.float32(1.0)
        colors = scene_linear(pixels[..., :3] / factor, self._image.colorspace_settings.name)
        pixels[..., :3] = colors * factor
        return self._of_array(truncated(pixels) if is_half else self._usable(pixels), False)

    def _usable(self, pixels: Float32Array) -> Float32Array:
        pixels, count = usable_pixels(pixels)
        if count:
            self._remark(f"Pixels {{of}} that are not usable numbers ({count}) are drawn black.")
        return pixels

    def _too_large(self) -> ImageSource:
        self._remark("Memory does not do for the pixels {of}: drawn magenta.")
        return _missing(self._image.name)

    def _lost(self) -> ImageSource:
        self._remark("The pixels {of} are missing: drawn magenta, as in Cycles.")
        return _missing(self._image.name)

    def _of_array(self, values: NDArray[Any], is_srgb: bool) -> ImageSource:
        kept = values if values.dtype == np.uint8 else narrowed(values)
        height, width = kept.shape[:2]
        is_opaque = bool(kept[..., 3].min() == (255 if kept.dtype == np.uint8 else 1.0))
        is_bytes = kept.dtype == np.uint8
        limits = _OF_BYTES if is_bytes else _range_of(kept)
        return ImageSource(self._image.name, width, height, is_bytes, is_srgb, is_opaque, limits, lambda: kept)

    def _remark(self, cause: str) -> None:
        self.remarks.append(Remark(cause, "image", self._image.name))


def _packed(image: bpy.types.Image, tile: int) -> bytes | None:
    """The file within Blender's that an image, or its tile, is; None where there is none or it was painted since."""
    if image.is_dirty or image.source not in ("FILE", "TILED"):
        return None
    for packed in image.packed_files:
        if packed.packed_file is not None and (not tile or packed.tile_number == tile):
            return bytes(packed.packed_file.data)
    return None


def _read_floats(file: str, shape: tuple[int, int]) -> Float32Array:
    """(h, w, 4)"""
    pixels = four_channels(decoded(file)[0])
    if pixels.dtype != np.float32 or pixels.shape[:2] != shape:
        raise OSError("the file has changed")
    return usable_pixels(pixels)[0]


def _read_bytes(file: str | bytes, shape: tuple[int, int], multiplies: bool, ignores_alpha: bool) -> NDArray[np.uint8]:
    """(h, w, 4); `multiplies`: colors with alpha"""
    pixels = four_channels(decoded(file)[0])
    if pixels.dtype != np.uint8 or pixels.shape[:2] != shape:
        raise OSError("the file has changed")
    if ignores_alpha:
        return without_alpha(pixels)
    return multiplied(pixels) if multiplies else pixels


def _range_of(pixels: NDArray[Any]) -> tuple[float, float]:
    return float(pixels.min()), float(pixels.max())


def _missing(name: str) -> ImageSource:
    """Cycles shows magenta."""
    return ImageSource(name, 0, 0, True, False, True, _OF_BYTES, lambda: np.zeros((0, 0, 4), np.uint8))
