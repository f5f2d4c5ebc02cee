# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes that look up whichever of a scene's images a pixel has: some at a time, as a shader has few samplers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..device.batches import full_screen_triangle
from ..device.shaders import Piece, named

IMAGES_AT_ONCE = 8
_NAMES = tuple(f"image_{slot}" for slot in range(IMAGES_AT_ONCE))
IMAGE_GROUP = Piece(
    samplers=named("FLOAT_2D", *_NAMES),
    constants={"first_image": "INT"},
    defines={
        "IMAGES": IMAGES_AT_ONCE,
        "IMAGE_CASES": " ".join(f"CASE({slot}, {name})" for slot, name in enumerate(_NAMES)),
    },
    outputs={"color": "VEC4"},
)
"""Images number `first_image` and on; IMAGE_CASES is a CASE(slot, sampler) of each, as samplers cannot be indexed by
what differs from pixel to pixel"""


def draw_groups(shader: Any, images: Sequence[Any]) -> None:
    """A full-screen triangle for each group of the images, by a bound shader with `IMAGE_GROUP`."""
    for first in range(0, len(images), IMAGES_AT_ONCE):
        group = images[first : first + IMAGES_AT_ONCE]
        shader.uniform_int("first_image", first)
        for slot, name in enumerate(_NAMES):
            shader.uniform_sampler(name, group[min(slot, len(group) - 1)])
        full_screen_triangle().draw(shader)
