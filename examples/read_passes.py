# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the passes of a multilayer OpenEXR file into numpy arrays, by names as Blender writes them.

    python examples/read_passes.py FILE.exr

prints what is in it. Takes the package OpenEXR (`pip install OpenEXR`), or OpenImageIO, which comes with Blender. Copy
`read_passes` into your own code: it depends on nothing else of this repository.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

ORDER = "RGBAUVXYZW"
"""Channels of a pass in the order of its array: U, V and then A would be alphabetical in the file"""


def read_passes(path: Path | str) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Passes by "ViewLayer.Pass", float32 (h, w) or (h, w, channels), row 0 at the top; and the file's metadata.

    A pass UV has u, v and 1 where there is a map. Raises OSError for a file that cannot be read.
    """
    channels, metadata = _channels(str(path))
    grouped: dict[str, dict[str, np.ndarray]] = {}
    for name, values in channels.items():
        group, _, channel = name.rpartition(".")
        grouped.setdefault(group, {})[channel] = values
    passes = {}
    for name, parts in grouped.items():
        order = "UVA" if "U" in parts else ORDER
        ordered = [parts[channel] for channel in sorted(parts, key=order.index)]
        passes[name] = ordered[0] if len(ordered) == 1 else np.stack(ordered, axis=-1)
    return passes, metadata


def object_names(metadata: dict[str, Any]) -> dict[int, str]:
    """Names of objects by their numbers in the passes Object and Mirror ID."""
    found: dict[int, str] = {}
    for name, value in metadata.items():
        if name.startswith("curvrefl.") and name.endswith(".objects"):
            found |= {int(number): title for number, title in json.loads(value).items()}
    return found


def _channels(path: str) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """(h, w) of each channel of all parts, by its whole name, and what the headers say."""
    if not Path(path).is_file():
        raise FileNotFoundError(f"{path} does not exist")
    try:
        import OpenEXR
    except ImportError:
        return _channels_by_oiio(path)
    found: dict[str, np.ndarray] = {}
    metadata: dict[str, Any] = {}
    with OpenEXR.File(path, separate_channels=True) as file:
        for part in file.parts:
            metadata |= part.header
            found |= {name: np.asarray(channel.pixels, np.float32) for name, channel in part.channels.items()}
    return found, metadata


def _channels_by_oiio(path: str) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    import OpenImageIO

    found: dict[str, np.ndarray] = {}
    metadata: dict[str, Any] = {}
    for part in range(OpenImageIO.ImageBuf(path).nsubimages):
        image = OpenImageIO.ImageBuf(path, part, 0)
        pixels = image.get_pixels(OpenImageIO.FLOAT)
        if pixels is None:
            raise OSError(image.geterror())
        found |= {name: pixels[..., index] for index, name in enumerate(image.spec().channelnames)}
        metadata |= {item.name: item.value for item in image.spec().extra_attribs}
    return found, metadata


def main(path: str) -> None:
    """Print a line for each pass: its size, and the range of its finite numbers."""
    passes, metadata = read_passes(path)
    for name, values in passes.items():
        finite = values[np.isfinite(values)]
        span = f"{finite.min():.6g} .. {finite.max():.6g}" if finite.size else "no finite number"
        print(f"{name:32} {' x '.join(map(str, values.shape)):16} {span}")
    for number, title in sorted(object_names(metadata).items()):
        print(f"object {number}: {title}")


if __name__ == "__main__":
    main(sys.argv[-1])
