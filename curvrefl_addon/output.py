# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where results go: checked before the work, written beside, checked again, and moved into place at the end."""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
import uuid
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from .errors import InputError
from .supervised import publishing, removed_at_end
from .written_files import BROKEN_OFF, NO_ROOM, UNWRITABLE, require_whole

LONGEST_NAME = 255
"""Bytes that file systems give a name"""


def checked_folder(path: Path | str) -> Path:
    """The absolute folder to write to, which need not be there yet. Raises InputError when it cannot be one."""
    folder = Path(path).absolute()
    with _said(folder):
        _require_length(folder)
        if os.path.lexists(folder) and not folder.is_dir():
            what = "a link to nothing" if folder.is_symlink() and not folder.exists() else "a file"
            raise InputError(f'Cannot write into "{path}", which is {what}: name a folder as output.')
        _require_writable(_existing_base(folder))
    return folder


def checked_file(path: Path | str, suffixes: tuple[str, ...]) -> Path:
    """The absolute file to write, with one of the lower-case `suffixes`. Raises InputError when it cannot be one.

    A symbolic link is followed: what it points to is what is replaced, and has to be a file or not there yet.
    """
    file = Path(path).absolute()
    if file.suffix.lower() not in suffixes:
        raise InputError(f'The output "{path}" must end in {" or ".join(suffixes)}.')
    with _said(file):
        target = _target(file)
        _require_length(target)
        if target.is_dir():
            raise InputError(f'Cannot write "{path}", which is a folder: name a file as output.')
        if target.exists() and not target.is_file():
            raise InputError(f'Cannot write "{path}", which is a device: name a file as output.')
        checked_folder(file.parent)
        checked_folder(target.parent)
        if target.exists() and not os.access(target, os.W_OK):
            raise InputError(f'Cannot write "{path}", which is write-protected: name another file as output.')
    return file


def numbered(path: Path, frame: int, is_numbered: bool = True) -> Path:
    """The file of a frame: its number in place of #, or behind the name where `is_numbered` and there is no #."""
    stem = path.stem
    if "#" not in stem:
        if not is_numbered:
            return path
        stem = f"{stem}_####"
    start, digits = stem.index("#"), stem.count("#")
    sign = "-" if frame < 0 else ""
    return path.with_name(f"{stem[:start]}{sign}{abs(frame):0{digits}d}{stem[start:].replace('#', '')}{path.suffix}")


@contextmanager
def folder_to_publish(folder: Path) -> Iterator[Path]:
    """A temporary folder; its files are moved into `folder` at the end, and dropped if something fails before.

    The temporary folder lies beside `folder`, so that moving is renaming. Files called report* come last: where a
    report is, all that it names is. Raises InputError where the files cannot be written, or not whole.
    """
    with removed_at_end(_existing_base(folder) / f".curvrefl-{uuid.uuid4().hex}") as part:
        with _said(folder):
            part.mkdir(0o700)
        with _said(folder, inside=part):
            yield part
        with _said(folder):
            paths = sorted(part.iterdir(), key=lambda path: (path.name.startswith("report"), path.name))
            for path in paths:
                if path.is_file():
                    require_whole(path)
            _publish(paths, folder)


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """A folder for what is read again at once, gone at the end. Raises InputError where it cannot be written to."""
    try:
        base = tempfile.gettempdir()
    except FileNotFoundError as error:
        raise InputError("There is no temporary folder to write to: name one in TMPDIR.") from error
    with removed_at_end(Path(base, f"curvrefl-{uuid.uuid4().hex}")) as folder:
        try:
            folder.mkdir(0o700)
            yield folder
        except OSError as error:
            is_here = error.filename is not None and Path(os.fsdecode(error.filename)).is_relative_to(folder)
            if error.errno not in BROKEN_OFF or not is_here:
                raise
            reason = error.strerror or str(error)
            raise InputError(
                f"Cannot write temporary files ({reason}): make room, or name a folder in TMPDIR."
            ) from error


def write_whole(path: Path, text: str) -> None:
    """Write a file, in UTF-8, that is there whole or as it was: also when the program is stopped.

    Its folder is made when missing. Raises InputError where it cannot be written.
    """
    with removed_at_end(_existing_base(path.parent) / f".{path.name}.part") as part, _said(path):
        part.write_text(text, encoding="utf-8")
        require_whole(part)
        path.parent.mkdir(parents=True, exist_ok=True)
        os.replace(part, _target(path))


def unwritable(place: Path | str, error: OSError) -> InputError:
    """What to say of a place that cannot be written to."""
    reason = error.strerror or str(error)
    return InputError(f'Cannot write "{place}" ({reason}): make room or choose another output.')


def _publish(paths: Sequence[Path], folder: Path) -> None:
    """Move all, or none where one cannot be."""
    targets = [_target(folder / path.name) for path in paths]
    for target in targets:
        if target.is_dir():
            raise InputError(f'Cannot write "{target}", which is a folder: choose another output.')
    is_new_folder = not folder.exists()
    made: list[Path] = []
    with publishing():
        folder.mkdir(parents=True, exist_ok=True)
        try:
            for path, target in zip(paths, targets, strict=True):
                is_new = not target.exists()
                _move(path, target)
                if is_new:
                    made.append(target)
        except OSError:
            for target in made:
                target.unlink(missing_ok=True)
            if is_new_folder:
                shutil.rmtree(folder, ignore_errors=True)
            raise


def _move(path: Path, target: Path) -> None:
    """Put a file in another's place at once, also where that is on another file system."""
    if path.stat().st_dev == target.parent.stat().st_dev:
        os.replace(path, target)
        return
    with removed_at_end(target.with_name(f".curvrefl-{uuid.uuid4().hex}")) as beside:
        shutil.copyfile(path, beside)
        with beside.open("r+b") as file:
            os.fsync(file.fileno())
        os.replace(beside, target)


@contextmanager
def _said(place: Path, inside: Path | None = None) -> Iterator[None]:
    """Errors that mean that a place cannot be written to, as a sentence.

    With `inside` only those of files in that folder, and those that can only come of writing.
    """
    try:
        yield
    except OSError as error:
        name = error.filename
        is_here = inside is None or (name is not None and Path(os.fsdecode(name)).is_relative_to(inside))
        if error.errno not in (UNWRITABLE if is_here else NO_ROOM):
            raise
        raise unwritable(place, error) from error


def _target(path: Path) -> Path:
    """What is written instead of `path`: the end of its links where it is one."""
    target = Path(os.path.realpath(path)) if path.is_symlink() else path
    if target.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), str(path))
    return target


def _require_length(path: Path) -> None:
    """Raises OSError for a name that is too long, also below folders that are not there yet."""
    for name in path.parts:
        if len(os.fsencode(name)) > LONGEST_NAME:
            raise OSError(errno.ENAMETOOLONG, os.strerror(errno.ENAMETOOLONG), str(path))


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
