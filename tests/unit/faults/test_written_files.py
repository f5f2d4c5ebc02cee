# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that break off are found out, whatever wrote them."""

from __future__ import annotations

import errno
import struct
import zlib
from pathlib import Path

import pytest
from curvrefl.curvrefl_addon.written_files import error_in, is_whole, require_whole


def png() -> bytes:
    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    head = struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(bytes(14))) + chunk(b"IEND", b"")


def exr(parts: int = 1) -> bytes:
    """As far as its structure goes: headers with one attribute, a table, chunks of 20 bytes."""
    count = 3
    many = parts > 1
    header = b"chunkCount\0int\0" + struct.pack("<II", 4, count) + b"\0"
    head = b"\x76\x2f\x31\x01" + struct.pack("<I", 2 | (0x1000 if many else 0))
    head += header * parts + (b"\0" if many else b"")
    chunks, offsets = b"", []
    behind = len(head) + 8 * count * parts
    for part in range(parts):
        for line in range(count):
            offsets.append(behind + len(chunks))
            chunks += (struct.pack("<I", part) if many else b"") + struct.pack("<iI", line, 20) + bytes(20)
    return head + struct.pack(f"<{len(offsets)}Q", *offsets) + chunks


WHOLE = {
    "a.png": png(),
    "a.exr": exr(),
    "several.exr": exr(parts=2),
    "a.blend": b"BLENDER-v502" + bytes(100) + b"ENDB" + bytes(20),
    "packed.blend": b"\x28\xb5\x2f\xfd" + bytes(90) + struct.pack("<I", 0x8F92EAB1),
    "a.txt": b"anything",
}


@pytest.mark.parametrize("name", WHOLE)
def test_whole_files_pass(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(WHOLE[name])
    require_whole(tmp_path / name)


@pytest.mark.parametrize("name", [name for name in WHOLE if name != "a.txt"])
def test_no_shorter_file_passes(name: str, tmp_path: Path) -> None:
    content = WHOLE[name]
    # (of an uncompressed .blend file the last block's head may be short)
    least = 24 if name == "a.blend" else 1
    for length in (*range(0, len(content) - least, 11), len(content) - least):
        (tmp_path / name).write_bytes(content[:length])
        with pytest.raises(OSError, match="not written whole"):
            require_whole(tmp_path / name)


def test_a_table_that_was_never_filled_is_found(tmp_path: Path) -> None:
    content = exr()
    table = content.index(struct.pack("<Q", len(content) - 3 * 28))
    (tmp_path / "a.exr").write_bytes(content[:table] + bytes(24) + content[table + 24 :])
    with pytest.raises(OSError, match="not written whole"):
        require_whole(tmp_path / "a.exr")


def test_damage_within_a_png_is_found(tmp_path: Path) -> None:
    content = bytearray(png())
    content[45] ^= 1
    (tmp_path / "a.png").write_bytes(content)
    with pytest.raises(OSError, match="not written whole"):
        require_whole(tmp_path / "a.png")


def test_a_file_that_is_not_there_is_not_whole(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="not written whole"):
        require_whole(tmp_path / "a.exr")


def test_the_reason_is_taken_from_what_others_say(tmp_path: Path) -> None:
    assert error_in("Error: Could not write: No space left on device\n", tmp_path).errno == errno.ENOSPC
    other = error_in("Error: Could not\n write it.\n", tmp_path)
    assert (other.errno, other.strerror) == (errno.EIO, "Could not write it")


def matroska(unknown: bool = False) -> bytes:
    """As far as its structure goes: a header, and a segment that knows its length once it is at its end."""
    header = b"\x1a\x45\xdf\xa3" + b"\x84" + bytes(4)
    length = b"\x01" + (b"\xff" * 7 if unknown else (300).to_bytes(7))
    return header + b"\x18\x53\x80\x67" + length + bytes(300)


@pytest.mark.parametrize("name", ["a.mkv", "a.webm"])
def test_a_segment_reaches_to_the_end(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(matroska())
    assert is_whole(path)
    for broken in (matroska(unknown=True), *(matroska()[:length] for length in range(0, len(matroska()), 7))):
        path.write_bytes(broken)
        assert not is_whole(path)
