# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads the .glsl files beside this one, and remembers which file and line each line of a shader is from.

A line ``#include "folder/piece.glsl"`` is replaced by that file's text, once per shader, so that pieces can include
what they need without guards. Blender's own shader compiler knows no includes.

A line ``#from optics.status import REFLECTED, HIDDEN as OUT_OF_SIGHT`` becomes one ``#define`` for each of the numbers
that it names in a module of ``curvrefl_addon``: what Python and a shader share is written in Python alone.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path

__all__ = ["Part", "Snippet", "Source", "load"]

_FOLDER = Path(__file__).resolve().parent
_INCLUDE = re.compile(r'#include "([a-z0-9_]+/[a-z0-9_]+(?:\.[a-z]+)?\.glsl)"\s*')
_CONSTANTS = re.compile(r"#from ([a-z0-9_.]+) import (.+)")


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
    """Text of a shader with its includes, and the numbers it takes from Python, in place."""

    text: str
    places: tuple[tuple[str, int], ...]
    """File and line (from 1) that each line of the text is from"""


@cache
def load(*parts: Part) -> Source:
    """These parts, one after the other.

    Raises FileNotFoundError when a file or one of its includes does not exist, ImportError or AttributeError when a
    module or a number does not, and TypeError for what is no number.
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
        if include := _INCLUDE.fullmatch(line):
            if include.group(1) not in seen:
                lines += _expand(include.group(1), seen)
        elif constants := _CONSTANTS.fullmatch(line):
            lines += [(define, (name, number)) for define in _defines(*constants.groups())]
        else:
            lines.append((line, (name, number)))
    return lines


def _defines(module_name: str, names: str) -> list[str]:
    module = import_module(f"..curvrefl_addon.{module_name}", __package__)
    defines = []
    for item in names.split(","):
        name, _, name_here = item.strip().partition(" as ")
        value = getattr(module, name)
        if type(value) not in (int, float):
            raise TypeError(f"{module.__name__}.{name} is no number that a shader could take, but {value!r}.")
        defines.append(f"#define {name_here or name} {value!r}")
    return defines
