# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What three renderers see round one sphere: a sky that is a formula, and where the eye is. Numpy alone."""

from __future__ import annotations

import numpy as np

SIZE = 128
"""Pixels a side"""
DISTANCE = 6.0
"""Of the eye from the middle of a sphere of radius 1, along -Y"""
ANGLE = float(np.degrees(2.0 * np.arcsin(1.08 / DISTANCE)))
"""Of view, degrees"""
MAP_SIZE = (512, 256)
"""Columns and rows of the sky as a picture"""

_LIGHTS = (
    # Toward, how narrow, radiance.
    ((-0.5, -0.7, 0.6), 60.0, (6.0, 5.4, 4.5)),
    ((0.8, -0.3, 0.1), 25.0, (0.4, 1.2, 2.4)),
    ((0.2, -0.6, -0.8), 12.0, (1.0, 0.3, 0.2)),
    ((0.1, 0.9, 0.4), 30.0, (2.0, 2.2, 1.0)),
)


def radiance(directions: np.ndarray) -> np.ndarray:
    """(..., 3) of unit directions (..., 3), Z up: a gradient with bars across it and four soft lights."""
    x, y, z = np.moveaxis(directions, -1, 0)
    sky = np.stack([0.25 + 0.15 * z, 0.3 + 0.2 * z, 0.4 + 0.3 * z], -1)
    bars = 0.5 + 0.5 * np.tanh(6.0 * np.sin(9.0 * np.arctan2(y, x)) * np.cos(np.arcsin(np.clip(z, -1.0, 1.0))))
    sky = sky * (0.35 + 0.65 * bars[..., None])
    for toward, narrow, color in _LIGHTS:
        cosine = directions @ (np.array(toward) / np.linalg.norm(toward))
        sky = sky + np.exp(narrow * (cosine - 1.0))[..., None] * np.array(color)
    return sky


def blender_map() -> np.ndarray:
    """(rows, columns, 3) as Blender lays an equirectangular picture out, row 0 at the bottom."""
    columns, rows = MAP_SIZE
    longitude = np.pi * (1.0 - 2.0 * (np.arange(columns) + 0.5) / columns)
    latitude = np.pi * ((np.arange(rows) + 0.5) / rows - 0.5)
    return radiance(_directions(longitude[None], latitude[:, None])).astype(np.float32)


def mitsuba_map() -> np.ndarray:
    """(rows, columns, 3) as Mitsuba lays one out under `MITSUBA_TURN`: row 0 at the top, both ends at the poles."""
    columns, rows = MAP_SIZE
    longitude = np.pi * (1.0 - 2.0 * (np.arange(columns) + 0.5) / columns)
    latitude = np.pi * (0.5 - np.arange(rows) / (rows - 1))
    return radiance(_directions(longitude[None], latitude[:, None])).astype(np.float32)


MITSUBA_TURN = ((0, 0, 1, 0), (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 0, 1))
"""Of its picture, whose up is Y, to the world"""


def _directions(longitude: np.ndarray, latitude: np.ndarray) -> np.ndarray:
    return np.stack(
        np.broadcast_arrays(
            np.cos(longitude) * np.cos(latitude), np.sin(longitude) * np.cos(latitude), np.sin(latitude)
        ),
        -1,
    )


def disc(share: float = 0.95) -> np.ndarray:
    """(SIZE, SIZE) whether a pixel's center lies within this share of the sphere's outline."""
    reach = np.tan(np.arcsin(1.0 / DISTANCE)) / np.tan(np.radians(0.5 * ANGLE))
    place = (2.0 * np.arange(SIZE) + 1.0) / SIZE - 1.0
    return np.hypot(place[None], place[:, None]) < share * reach
