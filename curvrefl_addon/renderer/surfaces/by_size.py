# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What has the size of a picture."""

from __future__ import annotations

from collections.abc import Callable


class BySize[T]:
    """One for each size, made when first asked for; those that were made the longest ago go."""

    def __init__(self, make: Callable[[int, int], T], most: int) -> None:
        """`make(width, height)`; `most`: sizes that are kept. A viewport draws smaller pictures while it moves."""
        self._make, self._most = make, most
        self._held: dict[tuple[int, int], T] = {}

    def of(self, width: int, height: int) -> T:
        if (width, height) not in self._held:
            while len(self._held) >= self._most:
                del self._held[next(iter(self._held))]
            self._held[width, height] = self._make(width, height)
        return self._held[width, height]
