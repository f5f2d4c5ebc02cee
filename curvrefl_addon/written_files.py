# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a file that was just written is there whole, and why it is not.

Blender's writers of pictures and of .blend files report success on a full disk, and leave a file that breaks off. So
what they write is read again: the chunks of a PNG with their sums, the table of an OpenEXR file and its last chunk, the
last block of a .blend file, the boxes of a video or its segment. Python's own writers raise OSError, and their files
are taken as they are.
"""

from __future__ import annotations

import contextlib
import errno
import os
import struct
import tempfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
BROKEN_OFF = (*NO_ROOM, errno.EIO, errno.EROFS)
UNWRITABLE = (*BROKEN_OFF, errno.EACCES, errno.EPERM, errno.ENAMETOOLONG, errno.ELOOP, errno.ENOTDIR, errno.EEXIST)
"""Numbers of the errors that say that a place cannot be written to, as it is"""

_PNG_START = b"\x89PNG\r\n\x1a\n"
_EXR_START = b"\x76\x2f\x31\x01"
_EXR_TILED, _EXR_PARTS = 0x200, 0x1000
_ZSTD_START = b"\x28\xb5\x2f\xfd"
_SEEKABLE_END = struct.pack("<I", 0x8F92EAB1)
_BLEND_END = b"ENDB"
_EBML_START, _SEGMENT_START = b"\x1a\x45\xdf\xa3", b"\x18\x53\x80\x67"
_LARGEST_BLOCK_HEAD = 32


def require_whole(path: Path) -> None:
    """Raises OSError, with the reason where it can be found, when the file breaks off or cannot be kept."""
    size = 0
    if path.is_file():
        with path.open("r+b") as file:
            if _passes_check(path, file):
                # Some file systems say only now that there was no room.
                os.fsync(file.fileno())
                return
            size = file.seek(0, os.SEEK_END)
    _require_room(path.parent, size)
    raise OSError(errno.EIO, "it was not written whole", str(path))


def sync_folder(folder: Path) -> None:
    """Have what was put into a folder stay there though the power fails, where the system can do that."""
    with contextlib.suppress(OSError):  # (Windows opens no folders, some file systems sync none)
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)


def is_whole(path: Path) -> bool:
    """Whether the file is there and does not break off, as far as its kind tells."""
    if not path.is_file() or path.stat().st_size == 0:
        return False
    with path.open("rb") as file:
        return _passes_check(path, file)


def _passes_check(path: Path, file: BinaryIO) -> bool:
    check = _CHECKS.get(path.suffix.lower())
    try:
        return check is None or check(file)
    except (struct.error, ValueError):
        return False


def error_in(text: str, path: Path | str) -> OSError:
    """What another program's message about writing `path` says, with the system's number where it names the reason."""
    for number in UNWRITABLE:
        if os.strerror(number) in text:
            return OSError(number, os.strerror(number), str(path))
    return OSError(errno.EIO, " ".join(text.removeprefix("Error:").split()).rstrip("."), str(path))


def _require_room(folder: Path, size: int) -> None:
    """Raises OSError with the system's own reason where a file of twice that size cannot be written."""
    with tempfile.TemporaryFile(dir=folder) as file:
        block = bytes(1 << 20)
        for _ in range(2 * size // len(block) + 1):
            file.write(block)
        file.flush()
        os.fsync(file.fileno())


def _is_whole_png(file: BinaryIO) -> bool:
    if file.read(8) != _PNG_START:
        return False
    while True:
        length, kind = struct.unpack(">I4s", file.read(8))
        content = file.read(length)
        (total,) = struct.unpack(">I", file.read(4))
        if len(content) != length or zlib.crc32(content, zlib.crc32(kind)) != total:
            return False
        if kind == b"IEND":
            return True


def _is_whole_exr(file: BinaryIO) -> bool:
    """The table of chunks is written last: one that is full, and whose last chunk lies within the file, is whole."""
    start, version = struct.unpack("<4sI", file.read(8))
    if start != _EXR_START:
        return False
    counts = []
    while (count := _read_exr_header(file)) is not None:
        counts.append(count)
        if not version & _EXR_PARTS:
            break
    table = file.tell()
    if not version & _EXR_PARTS:
        # The first chunk lies behind the table.
        (first,) = struct.unpack("<Q", file.read(8))
        counts = [(first - table) // 8]
    size = file.seek(0, os.SEEK_END)
    total = sum(counts)
    if not 0 < total <= size // 8:
        return False
    file.seek(table)
    last = max(offsets := struct.unpack(f"<{total}Q", file.read(8 * total)))
    if min(offsets) < table + 8 * total:
        return False
    file.seek(last)
    before = 4 * (bool(version & _EXR_PARTS) + (4 if version & _EXR_TILED else 1))
    file.seek(before, os.SEEK_CUR)
    (length,) = struct.unpack("<I", file.read(4))
    return file.tell() + length <= size


def _read_exr_header(file: BinaryIO) -> int | None:
    """The attribute chunkCount of the header that begins here, 0 without it; None for the empty one behind the last."""
    count = 0
    is_empty = True
    while name := _read_text(file):
        is_empty = False
        _read_text(file)  # (its type)
        (length,) = struct.unpack("<I", file.read(4))
        value = file.read(length)
        if name == b"chunkCount":
            (count,) = struct.unpack("<I", value)
    return None if is_empty else count


def _read_text(file: BinaryIO) -> bytes:
    """Up to the next zero byte. Raises ValueError at the file's end."""
    text = bytearray()
    while (byte := file.read(1)) != b"\0":
        if not byte:
            raise ValueError("the file ends within a header")
        text += byte
    return bytes(text)


def _is_whole_blend(file: BinaryIO) -> bool:
    is_packed = file.read(4) == _ZSTD_START
    file.seek(0, os.SEEK_END)
    file.seek(max(file.tell() - _LARGEST_BLOCK_HEAD, 0))
    end = file.read()
    return end.endswith(_SEEKABLE_END) if is_packed else _BLEND_END in end


def _is_whole_video(file: BinaryIO) -> bool:
    """The boxes of an ISO base media file, MP4 or QuickTime, reach to its end, and the one with the index is there."""
    size = file.seek(0, os.SEEK_END)
    kinds, place = [], 0
    while place < size:
        file.seek(place)
        length, kind = struct.unpack(">I4s", file.read(8))
        if length == 1:
            (length,) = struct.unpack(">Q", file.read(8))
        if length < 8:
            return False
        kinds.append(kind)
        place += length
    return place == size and b"moov" in kinds


def _is_whole_matroska(file: BinaryIO) -> bool:
    """The segment behind the header has got its length, which is written at the end, and reaches to the file's."""
    size = file.seek(0, os.SEEK_END)
    file.seek(0)
    if file.read(4) != _EBML_START:
        return False
    length = _read_ebml_length(file)
    file.seek(length or 0, os.SEEK_CUR)
    if length is None or file.read(4) != _SEGMENT_START:
        return False
    length = _read_ebml_length(file)
    return length is not None and file.tell() + length == size


def _read_ebml_length(file: BinaryIO) -> int | None:
    """A length of one to eight bytes; None for the one that says that it is not known. Raises ValueError for none."""
    first = file.read(1)
    if not first or not first[0]:
        raise ValueError("there is no length")
    more = 8 - first[0].bit_length()
    rest = file.read(more)
    if len(rest) != more:
        raise ValueError("the file ends within a length")
    value = int.from_bytes(bytes([first[0] ^ (0x80 >> more)]) + rest)
    return None if value == (1 << 7 * (more + 1)) - 1 else value


_CHECKS: dict[str, Callable[[BinaryIO], bool]] = {
    ".png": _is_whole_png,
    ".exr": _is_whole_exr,
    ".blend": _is_whole_blend,
    ".mp4": _is_whole_video,
    ".mov": _is_whole_video,
    ".mkv": _is_whole_matroska,
    ".webm": _is_whole_matroska,
}
