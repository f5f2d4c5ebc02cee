# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a proof is, and how one comes out."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...scene.arrays import Float64Array
from ..device.batches import full_screen_triangle
from ..device.frame_buffers import frame_buffer
from ..device.state import drawing_state, set_viewport
from ..device.textures import empty_texture, read_texture

type Work = Generator[None, None, Found]
"""Ends a slice at each `yield`, with nothing bound; returns how it came out"""


@dataclass(frozen=True, slots=True)
class Found:
    """How far off results are."""

    error: float
    allowed: float
    unit: str
    """Of both"""

    @property
    def is_right(self) -> bool:
        """What is no number is not."""
        return self.error <= self.allowed

    def __str__(self) -> str:
        return f"off by {self.error:.3g} {self.unit}, {self.allowed:.3g} allowed"


@dataclass(frozen=True, slots=True)
class Proof:
    """One thing that a device may do wrong."""

    name: str
    subject: str
    """What is proven, as it stands in a sentence: "reflection points by Newton" """
    work: Callable[[], Work]
    features: tuple[str, ...] = ()
    """Of `Features`, without which the same is done another way, in the order in which they are tried"""
    methods: tuple[str, ...] = ()
    """Of the catalog, which are not right where this is not"""


def drawn_square(
    shader: Any,
    size: int,
    textures: Mapping[str, Any],
    outputs: int,
    bind: Callable[[Any], None] | None = None,
) -> list[Float64Array]:
    """What a full-screen shader writes into so many targets of `size` x `size` pixels, (size, size, 4) each; `textures`
    are its samplers by name, and `bind` sets what else it needs."""
    targets = [empty_texture(size, size) for _ in range(outputs)]
    with drawing_state(), frame_buffer(*targets).bind():
        set_viewport(0, 0, size, size)
        shader.bind()
        if bind is not None:
            bind(shader)
        for name, texture in textures.items():
            shader.uniform_sampler(name, texture)
        full_screen_triangle().draw(shader)
    return [read_texture(target).astype(np.float64) for target in targets]
