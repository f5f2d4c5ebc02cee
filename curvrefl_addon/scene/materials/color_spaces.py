# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The file's working space: what scene-linear colors are made of, and the way to linear Rec.709 and back."""

from __future__ import annotations

from functools import cache
from typing import Any

import bpy
import numpy as np
from mathutils import Color

from ..arrays import Float32Array, Float64Array

REC709 = "Linear Rec.709"
REC709_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def working_space() -> str:
    """Blender's name of the space of all scene-linear colors of the open file."""
    data: Any = bpy.data
    return data.colorspace.working_space


def rec709_to_scene(colors: Float32Array) -> Float32Array:
    """Linear Rec.709 colors (..., 3) in the working space; the same array where that is Rec.709."""
    return _changed(colors, "from_rec709_linear_to_scene_linear")


def scene_to_rec709(colors: Float32Array) -> Float32Array:
    """Scene-linear colors (..., 3 or 4, alpha stays) in linear Rec.709; the same array where they are."""
    return _changed(colors, "from_scene_linear_to_rec709_linear")


def xyz_to_scene(colors: Float64Array) -> Float64Array:
    """CIE XYZ (D65) colors (..., 3) in the working space."""
    return colors @ _matrix(working_space(), "from_xyz_d65_to_scene_linear").T


def luminance_weights() -> Float64Array:
    """(3,) of scene-linear red, green and blue in the luminance."""
    space = working_space()
    return REC709_LUMINANCE if space == REC709 else _matrix(space, "from_scene_linear_to_xyz_d65")[1]


def _changed(colors: Float32Array, change: str) -> Float32Array:
    space = working_space()
    if space == REC709:
        return colors
    result = colors.copy()
    result[..., :3] = colors[..., :3] @ _matrix(space, change).T.astype(colors.dtype)
    return result


@cache
def _matrix(_space: str, change: str) -> Float64Array:
    """(3, 3) of a method of `Color`, while that is the working space."""
    columns = [getattr(Color(unit), change)() for unit in np.eye(3).tolist()]
    return np.array(columns, np.float64).T
