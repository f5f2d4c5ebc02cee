# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is not shown as it is: one sentence for each cause, whatever number of materials or objects it concerns."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

MOST_NAMES = 3
"""Named in a sentence; the others are counted"""


@dataclass(frozen=True, slots=True)
class Remark:
    """One thing that one material, object, image or world is concerned by."""

    cause: str
    """A sentence with `{of}` where those concerned are named: "Volumes {of} are not shown.\""""
    kind: str
    """What is concerned, in the singular: 'material'"""
    name: str


def sentences(remarks: Iterable[Remark | str]) -> tuple[str, ...]:
    """Those of equal cause and kind as one sentence, at the place of the first. Strings are sentences already."""
    concerned: dict[str | tuple[str, str], dict[str, None]] = {}
    for remark in remarks:
        if isinstance(remark, str):
            concerned.setdefault(remark, {})
        else:
            concerned.setdefault((remark.cause, remark.kind), {})[remark.name] = None
    return tuple(key if isinstance(key, str) else _sentence(*key, list(names)) for key, names in concerned.items())


def _sentence(cause: str, kind: str, names: list[str]) -> str:
    named = [f'"{name}"' for name in names]
    if len(named) == 1:
        of = f"of {kind} {named[0]}"
    else:
        shown, rest = named[:MOST_NAMES], len(named) - MOST_NAMES
        listed = f"{', '.join(shown)} and {rest} more" if rest > 0 else f"{', '.join(shown[:-1])} and {shown[-1]}"
        of = f"of {len(named)} {kind}s ({listed})"
    # (Not str.format: names of nodes in a cause may have braces.)
    return cause.replace("{of}", of)
