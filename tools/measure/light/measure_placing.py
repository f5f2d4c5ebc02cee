# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times what a mouse move costs in Python while a lamp is dragged over a mirror, in each mode.

    .venv/bin/python tools/measure/light/measure_placing.py FILE.blend --reflector Kettle[,B]

Lines of sight go over the whole picture of the file's camera; those that place the lamp count, in time of the processor
(other work of the machine does not).
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from time import process_time
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import bootstrap
import bpy
import numpy as np

bootstrap.load_package()

from curvrefl.curvrefl_addon import registration  # noqa: E402
from curvrefl.curvrefl_addon.design.lights.moved import Moved  # noqa: E402
from curvrefl.curvrefl_addon.design.lights.placing import Ask, Line, Placing  # noqa: E402
from curvrefl.curvrefl_addon.errors import InputError  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.blend_file import find_camera, open_blend, view_of_camera  # noqa: E402

MOVES = 400


def main() -> None:
    parser = argparse.ArgumentParser(description="Times what a mouse move costs while a lamp is dragged.")
    parser.add_argument("file", type=Path)
    parser.add_argument("--reflector", required=True)
    arguments = parser.parse_args()
    registration.register()
    open_blend(arguments.file)
    scene: Any = bpy.context.scene
    for name in arguments.reflector.split(","):
        mirror: Any = bpy.data.objects[name]
        mirror.curvrefl.is_mirror = True
    lamp: Any = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "AREA"))
    scene.collection.objects.link(lamp)
    lamp.location = find_camera(scene).matrix_world.translation
    depsgraph = bpy.context.evaluated_depsgraph_get()
    view = view_of_camera(scene, find_camera(scene), 640, 480, depsgraph)
    pixels = np.random.default_rng(0).uniform((0, 0), (view.width, view.height), (MOVES, 2))
    for mode in ("REFLECTION", "ILLUMINATION", "RIM"):
        placing = Placing(Moved(lamp), scene)
        times = []
        for x, y in pixels.tolist():
            start = process_time()
            try:
                placing.place(bpy.context.evaluated_depsgraph_get(), scene, Line.through(view, x, y), Ask(mode=mode))
            except InputError:
                continue
            times.append(1e3 * (process_time() - start))
        placing.moved.restore()
        # (The first ones build Blender's own hierarchies of the meshes.)
        later = times[8:]
        print(
            f"{mode:13} {np.median(later):.2f} ms, 99 of 100 under {np.percentile(later, 99):.2f}; {len(later)} moves"
        )
    registration.unregister()


if __name__ == "__main__":
    main()
