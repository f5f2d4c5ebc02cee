# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The collection of scenes of paths: builders by name, what is judged of their pictures, and how close they must be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

type Builder = Callable[[], None]

OBJECT = "Object"
"""What the chosen object of most scenes is called"""
GLASS_LIMIT = (None, 0.03)
type Limits = tuple[float | None, float | None]
"""Largest FLIP of 16 and of 64 sub-frames; None is not judged"""


@dataclass(frozen=True, slots=True)
class PathScene:
    """One tiny scene about one thing that a path does at a surface."""

    name: str
    text: str
    build: Builder
    """Replaces the open file; the file's own Cycles settings are those of the reference"""
    mirrors: tuple[str, ...]
    """Names of the objects that are chosen"""
    judged: tuple[str, ...]
    """Names of the objects whose pixels are compared"""
    limits: Limits
    samples: int
    """Of each of the two references by Cycles"""
    layered: bool
    """A rough layer over a matt base: see `judged.layered_picture`"""


SCENES: dict[str, PathScene] = {}


def path_scene(
    text: str,
    limits: Limits = (None, None),
    mirrors: tuple[str, ...] = (OBJECT,),
    judged: tuple[str, ...] | None = None,
    samples: int = 256,
    layered: bool = False,
) -> Callable[[Builder], Builder]:
    """Registers a builder under its function's name; all that is chosen is judged unless `judged` says otherwise."""

    def register(build: Builder) -> Builder:
        add_scene(build.__name__, text, build, limits, mirrors, judged, samples, layered)
        return build

    return register


def add_scene(
    name: str,
    text: str,
    build: Builder,
    limits: Limits = (None, None),
    mirrors: tuple[str, ...] = (OBJECT,),
    judged: tuple[str, ...] | None = None,
    samples: int = 256,
    layered: bool = False,
) -> None:
    """Registers one of a row of scenes that differ by a number."""
    if name in SCENES:
        raise ValueError(f"There are two scenes of paths called {name}.")
    compared = mirrors if judged is None else judged
    SCENES[name] = PathScene(name, text, build, mirrors, compared, limits, samples, layered)
