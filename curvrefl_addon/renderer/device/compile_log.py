# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a driver says of a shader that does not compile, with the file and line that it is about.

Blender raises an error without a word of that: its log goes to the process's own output, past Python. So that output is
taken while a shader compiles. What is in it beside the errors is written again.
"""

from __future__ import annotations

import os
import re
import tempfile
import threading
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from typing import IO

from ....gpu_shaders.loader import Source

MOST_ERRORS = 3
"""More follow from the first ones"""
_STREAMS = (1, 2)
"""File descriptors of standard output and standard error: Blender's log may go to either"""
_ERROR_START = re.compile(r"gpu\.shader\s*\|\s*ERROR")
_CONTINUED = re.compile(r"\s*\|")
_STAGE = re.compile(r"(Vert|Frag|Compute)Shader:")
_STAGES = {"Vert": "vertex", "Frag": "fragment", "Compute": "compute"}
_redirected = threading.Lock()
"""The streams are the whole process's, and shaders may be compiled in two threads"""
_AT_LINE = re.compile(r"\|\s*(?:ERROR: *)?(?:python_shader\.glsl|\d+)[:(](\d+)(?:[:(]\d+)?[:)]*[ :]*(.*)")
"""In Blender's form, or in those of drivers: `0(12) : error ..`, `0:12(5): error: ..`, `ERROR: 0:12: ..`"""


class CapturedOutput:
    """What was written meanwhile, by stream."""

    def __init__(self) -> None:
        self.text: dict[int, str] = {}

    @property
    def errors(self) -> list[str]:
        """Lines of shader errors in Blender's log."""
        return [line for text in self.text.values() for line, is_error in _told_apart(text) if is_error]

    def write_rest(self) -> None:
        """Write again what is not about shader errors, where it would have gone."""
        for stream, text in self.text.items():
            rest = "".join(line for line, is_error in _told_apart(text) if not is_error)
            if rest:
                os.write(stream, rest.encode("utf-8", "surrogateescape"))


@contextmanager
def captured_output() -> Iterator[CapturedOutput]:
    """Keep what this process writes to its standard streams; it is in the result afterwards."""
    result = CapturedOutput()
    with _redirected, ExitStack() as stack:
        for stream in _STREAMS:
            try:
                kept = os.dup(stream)
            except OSError:
                # A program without a console has no such stream, and Blender's log is lost anyway.
                continue
            stack.callback(os.close, kept)
            file = stack.enter_context(tempfile.TemporaryFile())
            stack.callback(_read_back, file, stream, result)
            stack.callback(os.dup2, kept, stream)
            os.dup2(file.fileno(), stream)
        yield result


def _read_back(file: IO[bytes], stream: int, result: CapturedOutput) -> None:
    file.seek(0)
    result.text[stream] = file.read().decode("utf-8", "surrogateescape")


def _told_apart(text: str) -> Iterator[tuple[str, bool]]:
    """Lines, and whether each is of a shader error."""
    is_error = False
    for line in text.splitlines(keepends=True):
        is_error = _ERROR_START.search(line) is not None or (is_error and _CONTINUED.match(line) is not None)
        yield line, is_error


def explain(errors: list[str], sources: Mapping[str, Source]) -> str:
    """The first errors with file and line; `sources` are those of the stages vertex, fragment and compute."""
    found: list[str] = []
    source = next(iter(sources.values()))
    for line in errors:
        if stage := _STAGE.search(line):
            source = sources.get(_STAGES[stage.group(1)], source)
        if match := _AT_LINE.search(line):
            number, words = int(match.group(1)), match.group(2).strip()
            if 1 <= number <= len(source.places):
                file, at = source.places[number - 1]
                found.append(f"{file}, line {at}: {words}")
    if not found:
        # Errors of linking are at no line.
        words = [line.rpartition("|")[2].strip() for line in errors if not _ERROR_START.search(line)]
        found = [word for word in words if word] or ["the driver does not say why"]
    return "; ".join(found[:MOST_ERRORS])
