# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Changes to the open file that are taken back, whatever happens in between."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import bpy


@dataclass(slots=True)
class TemporarySettings:
    """Remembers the first value of every property it changes and every datablock it is given to remove."""

    _first_values: dict[tuple[int, str], tuple[Any, str, Any]] = field(default_factory=dict)
    _made: list[tuple[Any, Any]] = field(default_factory=list)

    def set(self, owner: Any, **values: Any) -> None:
        """Set properties of `owner`; those that have the value already are left untouched.

        All are remembered before the first is set, and set back in the same order: some properties (a file
        format) change others (its color depth) as they are set.
        """
        for name in values:
            key = (owner.as_pointer(), name)
            if key not in self._first_values:
                self._first_values[key] = (owner, name, _plain(getattr(owner, name)))
        for name, value in values.items():
            if _plain(getattr(owner, name)) != value:
                setattr(owner, name, value)

    def remove_at_end(self, collection: Any, datablock: Any) -> Any:
        """Have `datablock`, new in `collection` (bpy.data.materials, ...), removed at the end; returns it."""
        self._made.append((collection, datablock))
        return datablock

    def restore(self) -> None:
        """Take everything back."""
        for owner, name, value in self._first_values.values():
            if _plain(getattr(owner, name)) != value:
                setattr(owner, name, value)
        self._first_values.clear()
        for collection, datablock in reversed(self._made):
            collection.remove(datablock)
        self._made.clear()


@contextmanager
def temporary_settings() -> Iterator[TemporarySettings]:
    """A `TemporarySettings` that is restored at the end, also of the image that the first render leaves behind."""
    images_before = set(bpy.data.images.keys())
    changes = TemporarySettings()
    try:
        yield changes
    finally:
        changes.restore()
        for name in ("Render Result", "Viewer Node"):
            if name not in images_before and name in bpy.data.images:
                bpy.data.images.remove(bpy.data.images[name])


def _plain(value: Any) -> Any:
    """Vectors and colors are views into the datablock: copy them to compare and to keep."""
    return tuple(value) if isinstance(value, bpy.types.bpy_prop_array) or hasattr(value, "to_tuple") else value
