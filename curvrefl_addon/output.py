# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where results go: checked before the work, written beside, and moved into place at the end."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import InputError


def checked_folder(path: Path | str) -> Path:
    """The absolute folder to write to, which need not be there yet. Raises InputError when it cannot be one."""
    folder = Path(path).absolute()
    if folder.exists() and not folder.is_dir():
        raise InputError(f'Cannot write into "{path}", which is a file: name a folder as output.')
    _require_writable(_existing_base(folder))
    return folder


def checked_file(path: Path | str, suffixes: tuple[str, ...]) -> Path:
    """The absolute file to write, with one of the lower-case `suffixes`. Raises InputError when it cannot be one."""
    file = Path(path).absolute()
    if file.suffix.lower() not in suffixes:
        raise InputError(f'The output "{path}" must end in {" or ".join(suffixes)}.')
    if file.is_dir():
        raise InputError(f'Cannot write "{path}", which is a folder: name a file as output.')
    checked_folder(file.parent)
    if file.exists() and not os.access(file, os.W_OK):
        raise InputError(f'Cannot write "{path}", which is write-protected: name another file as output.')
    return file


@contextmanager
def folder_to_publish(folder: Path) -> Iterator[Path]:
    """A temporary folder; its files are moved into `folder` at the end, and dropped if something fails before.

    The temporary folder lies beside `folder`, so that moving is renaming. Files called report* come last: where a
    report is, all that it names is.
    """
    part = Path(tempfile.mkdtemp(prefix=".curvrefl-", dir=_existing_base(folder)))
    try:
        yield part
        folder.mkdir(parents=True, exist_ok=True)
        for path in sorted(part.iterdir(), key=lambda path: (path.name.startswith("report"), path.name)):
            os.replace(path, folder / path.name)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def write_whole(path: Path, text: str) -> None:
    """Write a file, in UTF-8, that is there whole or as it was: also when the program is stopped."""
    part = path.with_name(f".{path.name}.part")
    try:
        part.write_text(text, encoding="utf-8")
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def _existing_base(folder: Path) -> Path:
    """`folder` itself or the nearest one above it that exists."""
    return next(base for base in (folder, *folder.parents) if base.exists())


def _require_writable(base: Path) -> None:
    if not base.is_dir():
        raise InputError(f'Cannot make a folder in "{base}", which is a file: choose another output.')
    try:
        # Permission bits do not tell of read-only file systems and the like: try.
        with tempfile.TemporaryFile(dir=base):
            pass
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(f'Cannot write into "{base}" ({reason}): choose another output.') from error
