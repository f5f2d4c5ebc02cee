# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A large scene is read over a few redraws: how much in each."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter


@dataclass(slots=True)
class ReadingTime:
    """For what is read for the first time."""

    end: float | None = None
    """On the clock of `perf_counter`; None: all is read at once"""
    begun: int = 0
    unread: int = 0
    """Objects for which no time was left"""

    @classmethod
    def of(cls, seconds: float | None) -> ReadingTime:
        """So long from now on."""
        return cls(None if seconds is None else perf_counter() + seconds)

    def is_left_for_another(self) -> bool:
        """Whether one more object may be read now; the first one always may."""
        if self.end is not None and self.begun and perf_counter() >= self.end:
            self.unread += 1
            return False
        self.begun += 1
        return True
