# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Temporary folders that are held while their run lives: what killed runs have left is told from what others need.

A folder is held by a lock on a file in it, which ends with the process that has it, however that ends. Its name says
where it was made: on the same machine and the same mounted file system a lock is decisive. Elsewhere, as on a folder of
a network that several machines write to, locks may not reach: there a folder is given up once nobody has touched it for
long. tools/supervise.py loads this file alone, with any Python from 3.8 on.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import shutil
import time
import zlib
from pathlib import Path

try:
    import fcntl
except ImportError:  # (Windows, where a file that is open cannot be removed)
    fcntl = None  # type: ignore[assignment]

LOCK = "held"
"""The file in a held folder; made first"""
FORGOTTEN = 7 * 24 * 3600.0
"""Seconds after which a folder that may be another machine's is given up: far more than a picture takes"""
_NAME = re.compile(r"\.?curvrefl-([0-9a-f]{8})-[0-9a-f]{16}")
_BOOT = Path("/proc/sys/kernel/random/boot_id")


def hold_new_folder(base: Path, start: str = ".curvrefl-") -> tuple[Path, int]:
    """Make a folder in `base` whose name begins so, and hold it; returns it with what `let_go` is told.

    Raises OSError where it cannot be made.
    """
    while True:
        folder = new_name(base, start)
        folder.mkdir(0o700)
        held = hold(folder)
        if held is not None:
            return folder, held


def new_name(base: Path, start: str = ".curvrefl-") -> Path:
    """For a folder to hold in `base`."""
    return base / f"{start}{_place(base)}-{os.urandom(8).hex()}"


def hold(folder: Path) -> int | None:
    """Hold a folder that was just made; None where someone who cleans up took it for left in between."""
    try:
        lock = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o600)
    except FileNotFoundError:
        return None
    if _locks(lock) is not False:
        with contextlib.suppress(FileNotFoundError):
            if os.path.samestat(os.fstat(lock), os.stat(folder / LOCK)):
                return lock
    os.close(lock)
    return None


def let_go(held: int) -> None:
    """Hold a folder no more."""
    os.close(held)


def remove_abandoned(base: Path) -> None:
    """Remove from `base` what runs that were killed have left there. What cannot be read or removed stays."""
    here = _place(base)
    try:
        with os.scandir(base) as entries:
            found = [(entry.path, _NAME.fullmatch(entry.name)) for entry in entries]
    except OSError:
        return
    for path, match in found:
        if match is not None and os.path.isdir(path) and not os.path.islink(path):
            with contextlib.suppress(OSError):
                _remove_if_abandoned(Path(path), is_here=match.group(1) == here)


def _remove_if_abandoned(folder: Path, is_here: bool) -> None:
    if not is_here and time.time() - _last_touched(folder) < FORGOTTEN:
        return
    try:
        lock = os.open(folder / LOCK, os.O_RDWR)
    except FileNotFoundError:
        # It was killed between two steps, of making it or of taking it away: an empty one could be just made.
        with contextlib.suppress(OSError):
            folder.rmdir()
        if folder.exists() and not (folder / LOCK).exists():
            shutil.rmtree(folder, ignore_errors=True)
        return
    try:
        locks = _locks(lock)
        if locks or (locks is None and not is_here):
            shutil.rmtree(folder, ignore_errors=True)
    finally:
        os.close(lock)
    if fcntl is None:
        shutil.rmtree(folder, ignore_errors=True)


def _locks(file: int) -> bool | None:
    """Lock an open file, without waiting: False where someone else does, None where the file system has no locks."""
    if fcntl is None:
        return None
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        return False if error.errno in (errno.EWOULDBLOCK, errno.EACCES) else None
    return True


def _place(base: Path) -> str:
    """Eight digits for this machine, since it was switched on, and the mounted file system that `base` is on."""
    try:
        machine = _BOOT.read_text(encoding="ascii")
    except OSError:
        import platform

        machine = platform.node()
    return f"{zlib.crc32(f'{machine} {base.stat().st_dev}'.encode()):08x}"


def _last_touched(folder: Path) -> float:
    times = [folder.stat().st_mtime]
    for path in folder.rglob("*"):
        with contextlib.suppress(OSError):
            times.append(path.stat().st_mtime)
    return max(times)
