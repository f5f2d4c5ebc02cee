# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where results go: checked before the work, written beside, checked again, and moved into place at the end."""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .errors import InputError
from .held_folders import hold, let_go, new_name, remove_abandoned
from .supervised import publishing, removed_at_end
from .written_files import BROKEN_OFF, NO_ROOM, UNWRITABLE, require_whole, sync_folder

LONGEST_NAME = 255
"""Bytes that file systems give a name"""
_FILES = "files"
"""In a held folder"""
_cleaned: set[Path] = set()
"""Folders in which this process has looked for what killed runs left"""


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
    """A temporary folder; what is in it is moved into `folder` at the end, and dropped if something fails before.

    The temporary folder lies beside `folder`, so that moving is renaming: at once where `folder` is not there yet. Else
    file after file, and the last stands for all: it is there only while all are, also where the program is killed or
    the power fails in between. That is the last by name, but files called report* come behind the others. What killed
    runs have left beside `folder` is removed. Raises InputError where the files cannot be written, or not whole.
    """
    clean_up(folder)
    with _held(_existing_base(folder), folder) as held:
        part = held / _FILES
        with _said(folder):
            part.mkdir()
        with _said(folder, inside=part):
            yield part
        with _said(folder):
            for path in part.rglob("*"):
                if path.is_file():
                    require_whole(path)
            _publish(part, folder, held)


def clean_up(folder: Path) -> None:
    """Remove what killed runs have left in `folder` and those above it, where their results were to go; once each."""
    for base in (folder, *folder.parents):
        if base not in _cleaned and base.is_dir():
            _cleaned.add(base)
            remove_abandoned(base)


@contextmanager
def _held(base: Path, place: Path, start: str = ".curvrefl-") -> Iterator[Path]:
    """A folder in `base` that is held, and gone at the end. Raises InputError, of `place`, where it cannot be made."""
    while True:
        with removed_at_end(new_name(base, start)) as folder:
            with _said(place):
                folder.mkdir(0o700)
                held = hold(folder)
            if held is None:
                continue
            try:
                yield folder
            finally:
                let_go(held)
            return


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """A folder for what is read again at once, gone at the end. Raises InputError where it cannot be written to."""
    try:
        base = tempfile.gettempdir()
    except FileNotFoundError as error:
        raise InputError("There is no temporary folder to write to: name one in TMPDIR.") from error
    clean_up(Path(base))
    with _held(Path(base), Path(base), "curvrefl-") as folder:
        try:
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
    clean_up(path.parent)
    with _held(_existing_base(path.parent), path) as held, _said(path):
        part = held / path.name
        part.write_text(text, encoding="utf-8")
        require_whole(part)
        path.parent.mkdir(parents=True, exist_ok=True)
        os.replace(part, _target(path))
        sync_folder(path.parent)


def unwritable(place: Path | str, error: OSError) -> InputError:
    """What to say of a place that cannot be written to."""
    reason = error.strerror or str(error)
    return InputError(f'Cannot write "{place}" ({reason}): make room or choose another output.')


def _publish(part: Path, folder: Path, held: Path) -> None:
    """Move all that is in `part`, or nothing where something cannot be moved; `held` has room for what is replaced."""
    paths = sorted(
        (path for path in part.rglob("*") if path.is_file()),
        key=lambda path: (path.parent == part and path.name.startswith("report"), path.relative_to(part)),
    )
    targets = [_target(folder / path.relative_to(part)) for path in paths]
    for target in targets:
        if target.is_dir():
            raise InputError(f'Cannot write "{target}", which is a folder: choose another output.')
    with publishing():
        if os.path.lexists(folder) or not _moves_whole(part, folder):
            _move_all(list(zip(paths, targets, strict=True)), held)


def _moves_whole(part: Path, folder: Path) -> bool:
    """Put the folder `part` where none is yet; False where one has come there meanwhile."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    for inside in (part, *(path for path in part.rglob("*") if path.is_dir())):
        sync_folder(inside)
    try:
        part.rename(folder)
    except OSError as error:
        if error.errno not in (errno.ENOTEMPTY, errno.EEXIST):
            raise
        return False
    sync_folder(folder.parent)
    return True


def _move_all(moves: list[tuple[Path, Path]], held: Path) -> None:
    """Move files, the last of which stands for all: an older one is taken away first."""
    if not moves:
        return
    last, replaced = moves[-1][1], held / "replaced"
    made: list[Path] = []
    try:
        if len(moves) > 1 and last.exists():
            _move(last, replaced)
            sync_folder(last.parent)
        for path, target in moves:
            target.parent.mkdir(parents=True, exist_ok=True)
            if target == last:
                for folder in {target.parent for _path, target in moves}:
                    sync_folder(folder)
            is_new = not target.exists()
            _move(path, target)
            if is_new:
                made.append(target)
        sync_folder(last.parent)
    except OSError:
        for target in made:
            target.unlink(missing_ok=True)
        if replaced.exists():
            with suppress(OSError):  # (what went wrong before is said)
                _move(replaced, last)
        raise


def _move(path: Path, target: Path) -> None:
    """Put a file in another's place at once, also where that is on another file system."""
    if path.stat().st_dev == target.parent.stat().st_dev:
        os.replace(path, target)
        return
    clean_up(target.parent)
    with _held(target.parent, target) as beside:
        copy = beside / target.name
        shutil.copyfile(path, copy)
        with copy.open("r+b") as file:
            os.fsync(file.fileno())
        os.replace(copy, target)


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
