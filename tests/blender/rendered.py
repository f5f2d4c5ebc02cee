# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders by the engine, as F12 makes them, and what is in their files."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np

WIDTH, HEIGHT = 48, 36
SAMPLES = 4


def mark(scene: Any, *names: str) -> None:
    """The engine, small, with these mirrors."""
    scene.render.engine = "CURVREFL"
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.curvrefl.render_samples = SAMPLES
    for name in names:
        thing: Any = bpy.data.objects[name]
        thing.curvrefl.is_mirror = True


def render(path: Path, file_format: str = "OPEN_EXR", **keywords: Any) -> Path:
    """The open scene into a file of this format: 32 bits in EXR, 8 in PNG."""
    scene = bpy.context.scene
    settings = scene.render.image_settings
    settings.media_type = "MULTI_LAYER_IMAGE" if "MULTILAYER" in file_format else "IMAGE"
    settings.file_format = file_format
    settings.color_depth = "8" if file_format == "PNG" else "32"
    if "MULTILAYER" not in file_format:
        settings.color_mode = "RGBA"
    scene.render.filepath = str(path)
    scene.render.use_file_extension = False
    bpy.ops.render.render(write_still=True, **keywords)
    return path


def channels(path: Path) -> dict[str, np.ndarray]:
    """(h, w) of each channel of a file by name, of all its parts, row 0 at the top."""
    oiio = open_image_io()
    found: dict[str, np.ndarray] = {}
    parts = oiio.ImageBuf(str(path)).nsubimages
    for part in range(parts):
        buffer = oiio.ImageBuf(str(path), part, 0)
        pixels = buffer.get_pixels(oiio.FLOAT)
        assert pixels is not None, buffer.geterror()
        found |= {name: pixels[..., index] for index, name in enumerate(buffer.spec().channelnames)}
    return found


def pixels(path: Path) -> np.ndarray:
    """(h, w, 4), row 0 at the top, as they are in the file."""
    found = channels(path)
    return np.stack([found[name] for name in "RGBA"], axis=-1)


def open_image_io() -> Any:
    """The module that comes with Blender."""
    utils: Any = bpy.utils
    home = Path(utils.system_resource("PYTHON")) / "lib" / f"python3.{sys.version_info.minor}"
    folder = os.fspath(home / "site-packages")
    if folder not in sys.path:
        sys.path.append(folder)
    import OpenImageIO

    return OpenImageIO
