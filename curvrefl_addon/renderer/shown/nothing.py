# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mirror that shows no object: the background alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

from ...scene.arrays import Float32Array
from .shown import Shown, SubFrame


@dataclass(frozen=True)
class ShownNothing(Shown):
    """The background, by each pixel's own reflected ray."""

    @classmethod
    def draw(cls, members: Sequence[Self], sub_frame: SubFrame, of_positions: bool = False) -> None:
        return None

    @classmethod
    def read_back(cls, members: Sequence[Self], sub_frame: SubFrame) -> dict[str, Float32Array]:
        return {}
