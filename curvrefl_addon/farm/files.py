# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the open .blend file reads beside itself, for farms that send files to their workers."""

from __future__ import annotations

import glob
import os
import re
from pathlib import Path

import bpy


def files_read() -> tuple[Path, ...]:
    """Absolute paths of linked files, images, fonts, sounds, movies and caches that are there, sorted.

    Of tiles and sequences all files of that name, with other numbers in it. What is packed is left out.
    """
    patterns = {glob.escape(name) for name in bpy.utils.blend_paths(absolute=True, packed=False, local=False)}
    for image in bpy.data.images:
        if image.packed_file is None and image.source in ("SEQUENCE", "TILED"):
            folder, name = os.path.split(bpy.path.abspath(image.filepath, library=image.library))
            # (Of sequences the last digits of the name are the frame's.)
            is_tiled = image.source == "TILED"
            number = r"<U[A-Z]+>" if is_tiled else r"[0-9]+(?=[^0-9]*$)"
            patterns.add(os.path.join(glob.escape(folder), re.sub(number, "[0-9]*", glob.escape(name))))
    found = {Path(path) for pattern in patterns for path in glob.glob(pattern)}
    return tuple(sorted(path.absolute() for path in found if path.is_file()))
