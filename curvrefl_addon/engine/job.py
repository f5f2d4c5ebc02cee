# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render is to draw where the file alone does not say it, and what came of it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ..scene.arrays import Float32Array
from ..settings_table import Settings

if TYPE_CHECKING:
    from ..renderer.noise import Convergence


@dataclass(slots=True)
class Job:
    """A render that a verb asks for; `None` for F12."""

    reflectors: tuple[str, ...]
    """Names of the mirrors, in place of those that are marked"""
    settings: Settings
    passes: tuple[str, ...] = ()
    """What to read beside the color: names of `passes.OF_MIRRORS`"""
    multilayer: bool = False
    """They are layers of the picture's own file, in place of `arrays`"""
    may_be_hidden: bool = False
    """A frame of several shows what mirrors there are, and the others with a warning; else they are an error"""
    missing: set[str] = field(default_factory=set)
    """Reflectors that no view layer has shown yet"""
    arrays: dict[str, Float32Array] = field(default_factory=dict)
    """By pass, of the whole picture of the first view layer: (h, w) or (h, w, 4), row 0 at the bottom"""
    object_names: dict[int, str] = field(default_factory=dict)
    """By the numbers of the passes with objects' numbers"""
    convergence: Convergence | None = None
    """Of the last view layer's picture"""
    warnings: list[str] = field(default_factory=list)
    error: Exception | None = None
    """Why there is no picture"""

    def __post_init__(self) -> None:
        self.missing = set(self.reflectors)


_jobs: list[Job] = []


@contextmanager
def asked_for(job: Job) -> Iterator[None]:
    """Renders meanwhile are this job's."""
    _jobs.append(job)
    try:
        yield
    finally:
        _jobs.remove(job)


def current_job() -> Job | None:
    """The one that is asked for now."""
    return _jobs[-1] if _jobs else None
