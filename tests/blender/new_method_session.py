# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a mirror ball by two methods of the copy of the repository that this file is in; prints what came of each.

Arguments: the two methods, and a folder for their pictures.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import bpy  # noqa: F401  (before gpu)
import numpy as np

COPY = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(COPY / "tools"), str(COPY / "tests")]

import bootstrap  # noqa: E402

bootstrap.load_package()

from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Ellipsoid  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from scenes.mirror_room import Room  # noqa: E402
from scenes.views import look_at  # noqa: E402


def main() -> None:
    *methods, folder = sys.argv[-3:]
    room = Room()
    room.add_mirror(Ellipsoid())
    room.add_rectangle((0.0, 0.0, -1.0), (8, 0, 0), (0, 8, 0))
    room.add_ball((1.3, -1.6, 0.1), 0.5)
    view = look_at(np.array([0.8, -4.0, 1.0]), np.zeros(3), 160, 120, np.radians(36))
    for method in methods:
        frame = Renderer(room.arrays(), Settings(method=method, samples=1, environment_resolution=64)).render(view)
        arrays = {"color": frame.color(), "mask": frame.mask(), "shown": frame.reflected_object()}
        np.savez(Path(folder) / f"{method}.npz", **arrays)
        print(json.dumps({"method": method, "solve": frame.solve}), flush=True)


main()
# Blender as a module may crash at Python's end.
os._exit(0)
