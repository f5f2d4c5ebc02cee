# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The process's own stdout and stderr, which Blender and C libraries write to past Python."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import TextIO

STDOUT, STDERR = 1, 2


@contextlib.contextmanager
def dropped(descriptor: int) -> Iterator[TextIO]:
    """What is written to STDOUT or STDERR meanwhile goes nowhere; yields the way past that."""
    stream: TextIO | None = sys.stdout if descriptor == STDOUT else sys.stderr
    if stream is not None:  # (Blender may have none)
        stream.flush()
    kept = os.dup(descriptor)
    # Names of files may be bytes that are no UTF-8: they are written as they came.
    with open(kept, "w", encoding="utf-8", errors="surrogateescape") as past:
        try:
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, descriptor)
            os.close(nowhere)
            yield past
        finally:
            if stream is not None:
                stream.flush()
            os.dup2(kept, descriptor)


def readable(name: str) -> str:
    """A name of a file as text that can be written everywhere: bytes that are no UTF-8 become question marks."""
    return os.fsencode(name).decode("utf-8", "replace")
