# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo as a .blend file in which the camera goes on a little from frame to frame: for a picture of motion vectors.

.venv/bin/python tools/measure/truth/moving_demo.py OUT.blend
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402

bootstrap.load_package()

from curvrefl.curvrefl_addon.demo.scene import build_demo  # noqa: E402

STEP = 0.01
"""Meters a frame, to the right"""


def main(path: Path) -> None:
    build_demo(path)
    scene = bpy.context.scene
    camera = scene.camera
    start = camera.location.x
    for frame in (0, 1, 2):
        camera.location.x = start + STEP * (frame - 1)
        camera.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True, check_existing=False)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
