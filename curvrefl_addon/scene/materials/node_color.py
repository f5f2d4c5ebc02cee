# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A color as nodes make it: a constant times a texture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Protocol, Self

import numpy as np

from .pixels import Pixels

type Change = Callable[..., Any]
"""From colors (..., 3) to colors of the same shape"""


class Texture(Protocol):
    """Pixels and whatever says where they go."""

    def colors(self) -> Pixels:
        """(h, w, 3)"""

    def changed(self, change: Change) -> Self:
        """The texture with other colors."""

    def aligned(self, other: Any) -> Pixels | None:
        """(h, w, 3) colors of another texture at this one's pixels; None where they do not lie on each other."""


@dataclass(frozen=True, slots=True)
class NodeColor:
    """`factor` times texture."""

    factor: tuple[float, float, float] = (1.0, 1.0, 1.0)
    texture: Any | None = None
    """A `Texture`"""

    @property
    def is_constant(self) -> bool:
        return self.texture is None

    def mean(self) -> tuple[float, float, float]:
        """The nearest constant."""
        if self.texture is None:
            return self.factor
        return triple(np.asarray(self.factor) * self.texture.colors().reshape(-1, 3).mean(axis=0, dtype=np.float64))

    def scaled(self, by: tuple[float, float, float]) -> NodeColor:
        """Times a constant."""
        return replace(self, factor=triple(np.multiply(self.factor, by)))


def gray(factor: float) -> NodeColor:
    """A constant gray."""
    return NodeColor((factor, factor, factor))


def product(a: NodeColor, b: NodeColor, factor: NodeColor) -> NodeColor | None:
    """a * (1 - factor + factor * b) where no pixel has to change for it; else None."""
    if not factor.is_constant:
        return None
    if b.is_constant:
        f = np.array(factor.factor)
        return a.scaled(triple(1.0 - f + f * np.array(b.factor)))
    if factor != gray(1.0):
        return None
    if a.texture is not None and b.texture is not None:
        return None
    texture = a.texture if a.texture is not None else b.texture
    return NodeColor(triple(np.multiply(a.factor, b.factor)), texture)


def plain(value: Any) -> NodeColor:
    """Of a socket's default value: a number, a vector or a color with alpha."""
    if isinstance(value, int | float):
        return gray(float(value))
    return NodeColor(triple(value[:3]))


def triple(values: Any) -> tuple[float, float, float]:
    r, g, b = (float(value) for value in values)
    return r, g, b


def spread(values: Any) -> Any:
    """Numbers (...) as grays (..., 3)."""
    return np.repeat(values[..., None], 3, axis=-1)
