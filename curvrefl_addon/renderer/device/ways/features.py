# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What of the device is used. It is asked when a pass is made or chosen; a device that has all of it pays nothing.

What a driver says it has is one thing, whether its results are right another: `renderer/proofs` finds that out, and
what has failed goes by the next way.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field

FEATURES = ("compute", "atomics", "quads", "fits")
"""Names of the fields of `Features` that say what a device has"""


@dataclass(frozen=True, slots=True)
class Features:
    """What passes may use; part of the key of each shader that depends on it."""

    compute: bool = True
    """Compute shaders write records; else each record is a fragment of a pass over the texture that holds it"""
    atomics: bool = True
    """A first pass lists what it leaves to a second one by image atomics; else the second looks at all records"""
    quads: bool = True
    """Derivatives tell the pixels of a quad apart, which share what they look up; else each looks up all"""
    fits: bool = True
    """Compute shaders fit trees of what deforms, a pass for each level, in the texture that they read; else numpy"""
    distrusted: frozenset[str] = field(default=frozenset(), compare=False)
    """Methods that no way gets right: `auto` takes none of them"""

    def without(self, *names: str) -> Features:
        """The same with less."""
        return Features(
            compute=self.compute and "compute" not in names,
            atomics=self.atomics and "atomics" not in names,
            quads=self.quads and "quads" not in names,
            fits=self.fits and "fits" not in names,
            distrusted=self.distrusted,
        )

    @property
    def lists(self) -> bool:
        """Whether a pass can make a list: an image that several invocations add to."""
        return self.compute and self.atomics

    @property
    def missing(self) -> tuple[str, ...]:
        """Names of what is not used."""
        return tuple(name for name in FEATURES if not getattr(self, name))


_used = [Features()]
_tried: ContextVar[Features | None] = ContextVar("tried", default=None)
"""By this thread alone: a render may go on in another one"""


def features() -> Features:
    """What passes use now."""
    return _tried.get() or _used[0]


def use_features(found: Features) -> None:
    """From now on. What has been drawn or solved before is not done again."""
    _used[0] = found


@contextmanager
def only_features(found: Features) -> Iterator[None]:
    """Use these meanwhile, in this thread."""
    token = _tried.set(found)
    try:
        yield
    finally:
        _tried.reset(token)
