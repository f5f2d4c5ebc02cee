# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives: differences between the four pixels of a quad, by which they share what they look up."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..device.context import gpu_cache
from ..device.shaders import FULL_SCREEN, Piece, build_shader
from ..device.textures import texture_2d
from ..device.ways.features import features
from .proof import Found, Work, drawn_square

SIZE = 16
MOST_OFF = 1e-4


def prove_quads() -> Work:
    """Sums over quads, and whether all four know which are one surface."""
    if not features().quads:
        # Each pixel looks up all by itself.
        return Found(0.0, MOST_OFF, "of the values")
    y, x = np.mgrid[0:SIZE, 0:SIZE]
    values = np.sin(1.0 + 0.7 * x + 1.3 * y)
    # One object to the left, another one to the right, which begins within a quad.
    objects = np.where(x < SIZE // 2 + 1, 1.0, 2.0)
    numbers = np.stack([values, objects, 0.1 * x, 0.1 * y], axis=-1)
    (found,) = drawn_square(_shader(), SIZE, {"numbers": texture_2d(numbers.astype(np.float32))}, 1)
    yield
    sums = values.reshape(SIZE // 2, 2, SIZE // 2, 2).sum(axis=(1, 3)).repeat(2, axis=0).repeat(2, axis=1)
    joined = (x // 2 != SIZE // 4).astype(np.float64)
    off = max(
        np.abs(found[..., 0] - sums).max(),
        np.abs(found[..., 1] - joined).max(),
        # Of what falls by one per pixel the derivative is known.
        np.abs(np.abs(found[..., 2:]) - 0.1).max(),
    )
    return Found(float(off), MOST_OFF, "of the values")


@gpu_cache
def _shader() -> Any:
    return build_shader(
        "proof of quads",
        FULL_SCREEN,
        Piece(samplers={"numbers": "FLOAT_2D"}, outputs={"found": "VEC4"}, fragment="proofs/quads.frag.glsl"),
    )
