# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of mixed shaders a sample shows: by one random number, which nested mixes share."""

from __future__ import annotations

from ..builder import Builder
from ..expression import Expression
from .arithmetic import placed


class Chance:
    """A random number from 0 to 1, made where it is first asked for.

    Inside of a mix it is what is left of the outer number when the side is known: even again on either side, so that
    samples are as well spread over nested mixes as over one.
    """

    def __init__(self, outer: Chance | None = None, share: Expression | None = None) -> None:
        self._outer = outer
        self._share = share
        self._value: Expression | None = None

    def inside(self, share: Expression) -> Chance:
        """For the sides of a mix with this share (0 to 1) of the second."""
        return Chance(self, share)

    def is_second(self, b: Builder, share: Expression) -> Expression:
        """1 in this share of all samples, else 0."""
        return b.made("float", f"{self._number(b).text} < {placed(b, share)} ? 1.0 : 0.0", 0.0, 1.0)

    def _number(self, b: Builder) -> Expression:
        if self._value is None:
            if self._outer is None or self._share is None:
                b.depend("random")
                self._value = Expression("s.random", "float", None, 0.0, 1.0)
            else:
                b.include("nodes/chance.glsl")
                arguments = f"{self._outer._number(b).text}, {placed(b, self._share)}"
                self._value = b.made("float", f"chance_inside({arguments})", 0.0, 1.0)
        return self._value
