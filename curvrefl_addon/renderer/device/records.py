# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Record textures: lists of vec4 as 2D textures, as there are no storage buffers."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from ...scene.arrays import Float32Array
from . import context
from .textures import empty_texture, read_texture, texture_2d

RECORD_FORMAT = "RGBA32F"
ROW_BITS = 11
"""Known to every shader, as a power of two is found with a shift and a mask"""
TEXTURE_WIDTH = 1 << ROW_BITS
"""Width of record textures"""


def record_texture(records: np.ndarray) -> Any:
    """RGBA32F texture, TEXTURE_WIDTH wide, of (n, 4) records; record i is at (i % width, i / width)."""
    count = padded_count(len(records))
    if count != len(records):
        padded = np.empty((count, 4), np.float32)
        padded[: len(records)] = records
        padded[len(records) :] = 0.0
        records = padded
    return texture_2d(records.reshape(-1, TEXTURE_WIDTH, 4))


def packed_texture(numbers: Float32Array) -> Any:
    """Record texture of numbers, any shape, one after the other (`fetch_three` of records.glsl)."""
    # (One more: who reads the last three looks at two records.)
    records = np.empty((padded_count(numbers.size // 4 + 2), 4), np.float32)
    flat = records.reshape(-1)
    flat[: numbers.size] = numbers.reshape(-1)
    flat[numbers.size :] = 0.0
    return record_texture(records)


@cache
def records_are_images() -> bool:
    """Whether drawing shaders read records as images, not as textures.

    Both give the same numbers. Graphics cards cache textures better; a software driver works out the level of detail of
    every texel, even where there is one, which takes it as long as the texel itself.
    """
    return context.is_software_opengl()


def set_records(shader: Any, name: str, texture: Any) -> None:
    """Set one of `Piece.records` of a bound shader."""
    (shader.image if records_are_images() else shader.uniform_sampler)(name, texture)


def padded_count(count: int) -> int:
    """Records in the whole rows that hold so many, at least one row."""
    return max(-(-count // TEXTURE_WIDTH), 1) * TEXTURE_WIDTH


def empty_record_texture(count: int) -> Any:
    """As `record_texture`, unfilled, to be written by a compute shader."""
    return empty_texture(TEXTURE_WIDTH, padded_count(count) // TEXTURE_WIDTH)


def empty_index_texture(count: int) -> Any:
    """R32UI texture, TEXTURE_WIDTH wide, of so many numbers, to be written by a compute shader."""
    return empty_texture(TEXTURE_WIDTH, padded_count(count) // TEXTURE_WIDTH, "R32UI")


def read_records(texture: Any, count: int) -> Float32Array:
    """(count, 4) records of a record texture; waits for the GPU."""
    return read_texture(texture).reshape(-1, 4)[:count]
