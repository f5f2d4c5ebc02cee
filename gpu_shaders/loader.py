# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads the .glsl files beside this one.

A line ``#include "piece.glsl"`` is replaced by that file's text, once per shader, so that pieces can include
what they need without guards. Blender's own shader compiler knows no includes.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

__all__ = ["load"]

_FOLDER = Path(__file__).resolve().parent
_INCLUDE = re.compile(r'^#include "([a-z0-9_]+/[a-z0-9_]+\.glsl)"\s*$', re.MULTILINE)


@cache
def load(name: str) -> str:
    """Source text of ``gpu_shaders/<name>`` with its includes in place.

    Raises FileNotFoundError when the file or one of its includes does not exist.
    """
    return _expand(name, set())


def _expand(name: str, seen: set[str]) -> str:
    seen.add(name)
    text = (_FOLDER / name).read_text(encoding="utf-8")

    def include(match: re.Match[str]) -> str:
        piece = match.group(1)
        return "" if piece in seen else _expand(piece, seen)

    return _INCLUDE.sub(include, text)
