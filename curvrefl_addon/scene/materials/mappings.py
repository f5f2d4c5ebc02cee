# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mapping nodes before a texture: what they do to coordinates, as one affine map."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Float64Array
from .node_colors import ColorReader
from .node_links import Source


def mapped_from(texture: Source, colors: ColorReader) -> tuple[Float64Array, Float64Array, Source]:
    """Of a texture node: (3, 3) matrix and (3,) shift of its coordinates, and the source of what is mapped.

    Coordinates = matrix @ source + shift.
    """
    linear, shift = np.eye(3), np.zeros(3)
    vector = texture.input("Vector")
    while vector.node is not None and vector.node.type == "MAPPING":
        inner, inner_shift = _mapping(vector, colors)
        linear, shift = linear @ inner, linear @ inner_shift + shift
        vector = vector.input("Vector")
    return linear, shift, vector


def euler_matrix(angles: Float64Array) -> Float64Array:
    """(3, 3) of Blender's Euler angles XYZ: about X first."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(angles), np.sin(angles)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def _mapping(source: Source, colors: ColorReader) -> tuple[Float64Array, Float64Array]:
    node: Any = source.node
    kind = node.vector_type

    def vector(name: str) -> Float64Array:
        return np.array(colors.vector(source.input(name), f"the {name} of a Mapping").mean(), np.float64)

    turn, scale = euler_matrix(vector("Rotation")), vector("Scale")
    location = vector("Location") if kind in ("POINT", "TEXTURE") else np.zeros(3)
    inverse = np.divide(1.0, scale, out=np.zeros(3), where=scale != 0.0)
    if kind == "TEXTURE":
        linear = inverse[:, None] * turn.T
        return linear, -linear @ location
    # (Normals have no length: what NORMAL does besides only matters where there is one.)
    return turn * (inverse if kind == "NORMAL" else scale), location
