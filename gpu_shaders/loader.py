# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads the .glsl files beside this one, and remembers which file and line each line of a shader is from.

A line ``#include "folder/piece.glsl"`` is replaced by that file's text, once per shader, so that pieces can include
what they need without guards. Blender's own shader compiler knows no includes.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

__all__ = ["Part", "Snippet", "Source", "load"]

_FOLDER = Path(__file__).resolve().parent
_INCLUDE = re.compile(r'#include "([a-z0-9_]+/[a-z0-9_]+(?:\.[a-z]+)?\.glsl)"\s*')


@dataclass(frozen=True, slots=True)
class Snippet:
    """GLSL that is in no file, with a name for error messages."""

    name: str
    text: str


type Part = str | Path | Snippet
"""A file's name in this folder, a file elsewhere, or text"""
type _Line = tuple[str, tuple[str, int]]


@dataclass(frozen=True, slots=True)
class Source:
    """Text of a shader with its includes in place."""

    text: str
    places: tuple[tuple[str, int], ...]
    """File and line (from 1) that each line of the text is from"""


@cache
def load(*parts: Part) -> Source:
    """These parts, one after the other.

    Raises FileNotFoundError when a file or one of its includes does not exist.
    """
    seen: set[Part] = set()
    lines = [line for part in parts for line in _expand(part, seen)]
    return Source("".join(f"{text}\n" for text, _ in lines), tuple(place for _, place in lines))


def _expand(part: Part, seen: set[Part]) -> list[_Line]:
    seen.add(part)
    if isinstance(part, Snippet):
        name, text = part.name, part.text
    else:
        name, text = str(part), (_FOLDER / part).read_text(encoding="utf-8")
    lines: list[_Line] = []
    for number, line in enumerate(text.removesuffix("\n").split("\n"), 1):
        match = _INCLUDE.fullmatch(line)
        if match is None:
            lines.append((line, (name, number)))
        elif match.group(1) not in seen:
            lines += _expand(match.group(1), seen)
    return lines
