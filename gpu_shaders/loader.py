# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads the .glsl files beside this one.

A line ``#include "folder/piece.glsl"`` is replaced by that file's text, once per shader, so that pieces can include
what they need without guards. Blender's own shader compiler knows no includes.

A line ``#from optics.status import REFLECTED, HIDDEN as OUT_OF_SIGHT`` becomes one ``#define`` for each of the numbers
that it names in a module of ``curvrefl_addon``: what Python and a shader share is written in Python alone.
"""

from __future__ import annotations

import re
from functools import cache
from importlib import import_module
from pathlib import Path

__all__ = ["load"]

_FOLDER = Path(__file__).resolve().parent
_INCLUDE = re.compile(r'^#include "([a-z0-9_]+/[a-z0-9_]+\.glsl)"\s*$', re.MULTILINE)
_CONSTANTS = re.compile(r"^#from ([a-z0-9_.]+) import (.+)$", re.MULTILINE)


@cache
def load(name: str) -> str:
    """Source text of ``gpu_shaders/<name>`` with its includes and the numbers it takes from Python in place.

    Raises FileNotFoundError when the file or one of its includes does not exist, ImportError or AttributeError when a
    module or a number does not, and TypeError for what is no number.
    """
    return _expand(name, set())


def _expand(name: str, seen: set[str]) -> str:
    seen.add(name)
    text = (_FOLDER / name).read_text(encoding="utf-8")

    def include(match: re.Match[str]) -> str:
        piece = match.group(1)
        return "" if piece in seen else _expand(piece, seen)

    return _INCLUDE.sub(include, _CONSTANTS.sub(_defines, text))


def _defines(line: re.Match[str]) -> str:
    module = import_module(f"..curvrefl_addon.{line.group(1)}", __package__)
    defines = []
    for item in line.group(2).split(","):
        name, _, name_here = item.strip().partition(" as ")
        value = getattr(module, name)
        if type(value) not in (int, float):
            raise TypeError(f"{module.__name__}.{name} is no number that a shader could take, but {value!r}.")
        defines.append(f"#define {name_here or name} {value!r}")
    return "\n".join(defines)
