# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is not shown as it is: one sentence for each cause, whatever number of materials or objects it concerns."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from .names import listed


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


def of_kind(kind: str, remarks: Iterable[Remark | str]) -> tuple[Remark, ...]:
    """Those that concern such things, each once."""
    return tuple(dict.fromkeys(one for one in remarks if isinstance(one, Remark) and one.kind == kind))


def of_one(cause: str, name: str) -> str:
    """Under the name of what it concerns: "Rust: volumes are not shown."."""
    # (Names of Blender's nodes keep their capitals.)
    return f"{name}: {cause.replace(' {of}', '')}"


def _sentence(cause: str, kind: str, names: list[str]) -> str:
    of = f"of {kind} {listed(names)}" if len(names) == 1 else f"of {len(names)} {kind}s ({listed(names)})"
    # (Not str.format: names of nodes in a cause may have braces.)
    return cause.replace("{of}", of)
