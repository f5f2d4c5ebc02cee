# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-FileCopyrightText: 2011-2022 Blender Foundation (Apache-2.0)
# SPDX-License-Identifier: GPL-3.0-or-later
"""IES files: how lamps on the market shine by direction. A port of `util/ies.cpp` of Cycles."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

type Array = NDArray[np.float64]

_CANDELA_TO_WATT = 0.0706650768394
"""4 pi over the luminous efficacy of D65"""
_TYPE_C, _TYPE_B, _TYPE_A = 1, 2, 3
_MOST_ANGLES = 100_000


@dataclass(frozen=True, slots=True)
class Photometry:
    """Intensities by angles in radians, both ascending: from the lamp's axis, and about it."""

    vertical: Array
    horizontal: Array
    intensity: Array
    """(horizontal, vertical)"""


def photometry(text: str) -> Photometry | None:
    """What an IES file says; None for what is none."""
    text = text.replace(",", " ")
    start = text.find("\nTILT=")
    if start < 0:
        return None
    try:
        if text.startswith("\nTILT=INCLUDE", start):
            numbers = _numbers(text[start + len("\nTILT=INCLUDE") :])
            numbers = numbers[2 + 2 * int(numbers[1]) :]
        else:
            numbers = _numbers(text[text.index("\n", start + 1) :])
        factor = numbers[2] * numbers[10] * numbers[11] * _CANDELA_TO_WATT
        rows, columns, kind = int(numbers[3]), int(numbers[4]), int(numbers[5])
        if not (0 < rows < _MOST_ANGLES and 0 < columns < _MOST_ANGLES):
            return None
        vertical, horizontal, values = np.split(
            numbers[13 : 13 + rows + columns + rows * columns], [rows, rows + columns]
        )
        intensity = factor * values.reshape(columns, rows)
    except (ValueError, IndexError):
        return None
    if kind == _TYPE_A:
        vertical, horizontal, intensity = _from_type_a(vertical, horizontal, intensity)
    elif kind == _TYPE_B:
        vertical, horizontal, intensity = _from_type_b(vertical, horizontal, intensity)
    elif kind == _TYPE_C:
        horizontal, intensity = _around(horizontal, intensity)
    else:
        return None
    if len(vertical) < 2 or len(horizontal) < 2:
        return None
    return Photometry(np.radians(vertical), np.radians(horizontal), intensity)


def _numbers(text: str) -> Array:
    """As many as there are before something else."""
    found: list[float] = []
    for word in re.split(r"\s+", text.strip()):
        try:
            found.append(float(word))
        except ValueError:
            break
    return np.array(found)


def _close(one: float, other: float) -> bool:
    return abs(one - other) < 1e-4


def _from_type_a(vertical: Array, horizontal: Array, intensity: Array) -> tuple[Array, Array, Array]:
    """From -90 to 90 degrees about: 270 to 90 of type C."""
    about, values = 180.0 - horizontal[::-1], intensity[::-1]
    if _close(horizontal[0], 0.0):
        about = np.concatenate([about, 180.0 + horizontal[1:]])
        values = np.concatenate([values, intensity[1:]])
    return vertical + 90.0, about, values


def _from_type_b(vertical: Array, horizontal: Array, intensity: Array) -> tuple[Array, Array, Array]:
    """The axis is another one: angles change places."""
    vertical, horizontal, intensity = horizontal, vertical, intensity.T
    if _close(horizontal[0], 0.0):
        horizontal = np.concatenate([-horizontal[:0:-1], horizontal])
        intensity = np.concatenate([intensity[:0:-1], intensity])
    if _close(vertical[0], 0.0):
        vertical = np.concatenate([-vertical[:0:-1], vertical])
        intensity = np.concatenate([intensity[:, :0:-1], intensity], axis=1)
    return vertical + 90.0, horizontal + 90.0, intensity


def _around(horizontal: Array, intensity: Array) -> tuple[Array, Array]:
    """Mirrored to the whole turn."""
    if _close(horizontal[0], 90.0):
        horizontal = horizontal - 90.0
    if len(horizontal) == 1:
        horizontal, intensity = np.array((0.0, 360.0)), np.repeat(intensity, 2, axis=0)
    for end in (90.0, 180.0):
        if _close(horizontal[-1], end):
            horizontal = np.concatenate([horizontal, 2.0 * end - horizontal[-2::-1]])
            intensity = np.concatenate([intensity, intensity[-2::-1]])
    if _close(horizontal[0], 0.0) and not _close(horizontal[-1], 360.0):
        gap = 360.0 - horizontal[-1]
        if _close(horizontal[-1] - horizontal[-2], gap) or _close(horizontal[1] - horizontal[0], gap):
            horizontal = np.append(horizontal, 360.0)
            intensity = np.concatenate([intensity, intensity[:1]])
    return horizontal, intensity
