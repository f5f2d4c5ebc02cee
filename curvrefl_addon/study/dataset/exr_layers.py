# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenEXR files with any channels, written and read without a library: the same numbers make the same bytes.

One part of scan lines, floats of 32 or 16 bits, compressed by ZIP in blocks of 16 lines, as the file layout of OpenEXR
2 says (openexr.com, "OpenEXR File Layout").
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float32Array, Float64Array

type Float16Array = NDArray[np.float16]

LINES = 16
_ZIP, _HALF, _FLOAT = 3, 1, 2
_STORED = {_HALF: "<f2", _FLOAT: "<f4"}
_LONG_NAMES = 0x400


def save_layers(
    path: Path, channels: Mapping[str, Float32Array | Float64Array | Float16Array], said: Mapping[str, str]
) -> None:
    """Write channels (h, w) by name, row 0 at the BOTTOM, and texts by name into the header. Those of 16 bits stay so,
    all others have 32."""
    names = sorted(channels)
    height, width = channels[names[0]].shape
    kinds = [_HALF if channels[name].dtype == np.float16 else _FLOAT for name in names]
    entries = zip(names, kinds, strict=True)
    table = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", kind, 0, 1, 1) for name, kind in entries) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<2I", 20000630, 2 | _LONG_NAMES)
    attributes = {
        "channels": ("chlist", table),
        "compression": ("compression", bytes([_ZIP])),
        "dataWindow": ("box2i", box),
        "displayWindow": ("box2i", box),
        "lineOrder": ("lineOrder", b"\0"),
        "pixelAspectRatio": ("float", struct.pack("<f", 1.0)),
        "screenWindowCenter": ("v2f", struct.pack("<2f", 0.0, 0.0)),
        "screenWindowWidth": ("float", struct.pack("<f", 1.0)),
        **{name: ("string", text.encode()) for name, text in said.items()},
    }
    for name, (kind, value) in attributes.items():
        header += name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    header += b"\0"
    stored = [
        np.ascontiguousarray(channels[name][::-1], _STORED[kind]) for name, kind in zip(names, kinds, strict=True)
    ]
    lines = np.concatenate([values.view(np.uint8) for values in stored], axis=1)
    blocks = []
    for first in range(0, height, LINES):
        raw = lines[first : first + LINES].tobytes()
        packed = zlib.compress(_shuffled(raw))
        packed = packed if len(packed) < len(raw) else raw
        blocks.append(struct.pack("<2i", first, len(packed)) + packed)
    starts = np.cumsum([len(header) + 8 * len(blocks), *(len(block) for block in blocks[:-1])])
    path.write_bytes(header + starts.astype("<u8").tobytes() + b"".join(blocks))


def load_layers(path: Path) -> dict[str, Float32Array]:
    """Channels (h, w) by name, row 0 at the BOTTOM, of a file that `save_layers` has written. Raises OSError for
    another."""
    data = path.read_bytes()
    try:
        return _channels(data)
    except (struct.error, ValueError, KeyError, zlib.error) as error:
        raise OSError(f"{path} is not a file of passes that the data set has written ({error})") from error


def _channels(data: bytes) -> dict[str, Float32Array]:
    if data[:4] != struct.pack("<I", 20000630):
        raise ValueError("it is no OpenEXR file")
    place, attributes = 8, {}
    while data[place]:
        name, place = _text(data, place)
        _, place = _text(data, place)
        (length,) = struct.unpack_from("<i", data, place)
        attributes[name] = data[place + 4 : place + 4 + length]
        place += 4 + length
    place += 1
    kinds: dict[str, str] = {}
    inside = 0
    table = attributes["channels"]
    while table[inside]:
        name, inside = _text(table, inside)
        kinds[name] = _STORED[struct.unpack_from("<i", table, inside)[0]]
        inside += 16
    if attributes["compression"] != bytes([_ZIP]):
        raise ValueError("it is compressed in another way")
    _, _, right, top = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right + 1, top + 1
    ends = np.cumsum([width * np.dtype(kind).itemsize for kind in kinds.values()])
    lines = np.empty((height, ends[-1]), np.uint8)
    for number in range(-(-height // LINES)):
        (start,) = struct.unpack_from("<Q", data, place + 8 * number)
        first, length = struct.unpack_from("<2i", data, start)
        block = lines[first : first + LINES]
        raw = data[start + 8 : start + 8 + length]
        raw = raw if length == block.nbytes else _unshuffled(zlib.decompress(raw))
        block[...] = np.frombuffer(raw, np.uint8).reshape(block.shape)
    parts = np.split(lines[::-1], ends[:-1], axis=1)
    return {
        name: np.ascontiguousarray(part).view(kind).astype(np.float32)
        for (name, kind), part in zip(kinds.items(), parts, strict=True)
    }


def _text(data: bytes, place: int) -> tuple[str, int]:
    end = data.index(b"\0", place)
    return data[place:end].decode(), end + 1


def _shuffled(raw: bytes) -> bytes:
    """First all bytes at even places, then the others, as differences."""
    values = np.frombuffer(raw, np.uint8)
    values = np.concatenate([values[0::2], values[1::2]]).astype(np.int16)
    values[1:] = values[1:] - values[:-1] + 128
    return (values & 255).astype(np.uint8).tobytes()


def _unshuffled(packed: bytes) -> bytes:
    values = np.frombuffer(packed, np.uint8).astype(np.int64)
    values[1:] -= 128
    values = (np.cumsum(values) & 255).astype(np.uint8)
    result = np.empty_like(values)
    half = (len(values) + 1) // 2
    result[0::2], result[1::2] = values[:half], values[half:]
    return result.tobytes()
