# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo: a chrome kettle in the corner of a room in the evening sun, and the whole room in the kettle.

Book, ball, table and the kettle's own wooden parts touch it. Heights are over the table that it stands on.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy

from ..written_files import error_in
from .data_blocks import add_camera, start_empty_scene
from .furniture import add_unseen_things
from .kettle import KETTLE, add_kettle
from .lights import add_lights
from .room import add_outside, add_room
from .table import JAR, add_table, add_things

MIRRORS = (KETTLE, JAR)
"""Names of the reflectors, the largest first"""


def build_demo(path: Path) -> None:
    """Replace the open file by the demo scene and save it as the .blend `path`, whose folder must exist.

    Raises OSError when the file cannot be written.
    """
    scene: Any = start_empty_scene()
    # Light that the kettle focuses is a few bright dots in Cycles, as artists know, who switch it off.
    scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = False
    add_room()
    add_outside()
    add_table()
    add_kettle()
    add_things()
    add_lights()
    add_unseen_things()
    add_camera(eye=(0.33, -0.63, 0.245), target=(0.008, 0.0, 0.147), lens=44.5)
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True)
    except RuntimeError as error:
        raise error_in(str(error), path) from error
