# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The collection of awkward scenes: builders by name, with what a warning must say where a picture may differ."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

type Builder = Callable[[Path], None]


@dataclass(frozen=True, slots=True)
class Awkward:
    """One scene with one awkward thing in it."""

    name: str
    text: str
    """What is awkward about it"""
    build: Builder
    """Replaces the open file by the scene; files that the scene needs are written into the folder given"""
    mirrors: tuple[str, ...]
    """Names of the objects that are chosen as mirrors"""
    words: tuple[str, ...]
    """A sentence names the cause where it has one of these in it, in whatever case: a name, a kind of thing"""
    samples: int
    """Of Cycles: its noise must not count"""


SCENES: dict[str, Awkward] = {}
MIRROR = "Mirror"
"""What the mirror of most scenes is called"""


def awkward(
    text: str, words: tuple[str, ...] = (), mirrors: tuple[str, ...] = (MIRROR,), samples: int = 64
) -> Callable[[Builder], Builder]:
    """Registers a builder under its function's name. Without `words` the picture has to be right."""

    def register(build: Builder) -> Builder:
        name = build.__name__
        if name in SCENES:
            raise ValueError(f"There are two awkward scenes called {name}.")
        SCENES[name] = Awkward(name, text, build, mirrors, words, samples)
        return build

    return register
