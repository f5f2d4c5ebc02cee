# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a proof is, and how one comes out."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass

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
