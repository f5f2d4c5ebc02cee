# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made once and kept (shaders, hierarchies, shadow maps) spread over the redraws of a viewport.

Whoever makes such a thing does so in a `piece_of_work`. Within `paced` that raises OutOfTime once the time is over:
the drawing is given up, what has been made stays, and the next attempt gets farther. Elsewhere nothing is raised.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from time import perf_counter
from typing import Any


class OutOfTime(Exception):  # noqa: N818 (it is no error)
    """The time of a redraw is over; the message says what would have been made next."""


@dataclass(slots=True)
class _Pace:
    end: float
    """On the clock of `perf_counter`"""
    made: int = 0
    """Pieces"""
    is_inside: bool = False
    """A piece is being made"""


_pace: ContextVar[_Pace | None] = ContextVar("pace", default=None)
"""Of this thread: a render beside the viewports takes the time that it needs"""


@contextmanager
def paced(seconds: float) -> Iterator[None]:
    """About so long, but one piece at least. Raises OutOfTime where pieces are left."""
    token = _pace.set(_Pace(perf_counter() + seconds))
    try:
        yield
    finally:
        _pace.reset(token)


@contextmanager
def unpaced() -> Iterator[None]:
    """What is made in here is made whole."""
    token = _pace.set(None)
    try:
        yield
    finally:
        _pace.reset(token)


@contextmanager
def piece_of_work(what: str) -> Iterator[None]:
    """Around a piece of work whose result is kept; `what` it is, for a panel. Pieces within a piece are of it: it is
    made whole."""
    pace = _pace.get()
    if pace is None or pace.is_inside:
        yield
        return
    if pace.made and perf_counter() >= pace.end:
        raise OutOfTime(what)
    pace.is_inside = True
    try:
        yield
    finally:
        pace.is_inside = False
    pace.made += 1


def outcome[Result](steps: Generator[Any, None, Result]) -> Result:
    """What comes of steps, all done at once."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value
