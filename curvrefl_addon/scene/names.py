# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Names in sentences."""

from __future__ import annotations

from collections.abc import Iterable

MOST_NAMES = 3
"""Named in a sentence; the others are counted"""


def listed(names: Iterable[str]) -> str:
    """'"A"', '"A" and "B"', '"A", "B", "C" and 2 more', each name once."""
    quoted = [f'"{name}"' for name in dict.fromkeys(names)]
    first, rest = quoted[:MOST_NAMES], len(quoted) - MOST_NAMES
    last = [f"{rest} more"] if rest > 0 else [first.pop()] if len(first) > 1 else []
    return " and ".join([", ".join(first), *last])
