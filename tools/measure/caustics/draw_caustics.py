# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws scenes with caustics by our engine, and by Cycles with many samples; says how long each took.

    .venv/bin/python tools/measure/caustics/draw_caustics.py FOLDER [NAME ...] [--samples 16] [--cycles 128]
        [--patches 32768] [--size 320x240] [--repeats 1]

Times are those of whole renders, the scene's reading among them; of several the first compiles shaders.

`./curvrefl images caustics.jpg` calls it.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import bootstrap
import bpy

bootstrap.load_package()

from curvrefl.curvrefl_addon import registration  # noqa: E402
from curvrefl.curvrefl_addon.engine.job import Job  # noqa: E402
from curvrefl.curvrefl_addon.engine.still import render_still  # noqa: E402
from curvrefl.curvrefl_addon.settings_table import Settings  # noqa: E402
from stages import STAGES  # type: ignore[import-not-found]  # noqa: E402


def draw_cycles(scene: Any, samples: int, size: tuple[int, int], path: Path) -> None:
    """As shown."""
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_adaptive_sampling = samples, False
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)


def main() -> None:
    parser = argparse.ArgumentParser(description="Draws scenes with caustics by our engine and by Cycles.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", default=list(STAGES), metavar="NAME")
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--cycles", type=int, default=128, help="its samples; 0: none of its pictures")
    parser.add_argument("--patches", type=int, default=32768)
    parser.add_argument("--size", default="320x240", metavar="WxH")
    parser.add_argument("--repeats", type=int, default=1, help="of our pictures")
    arguments = parser.parse_args()
    width, height = map(int, arguments.size.split("x"))
    folder = arguments.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    registration.register()
    for name in arguments.names:
        mirrors = STAGES[name]()
        scene: Any = bpy.context.scene
        for mirror in mirrors:
            thing: Any = bpy.data.objects[mirror]
            thing.curvrefl.is_mirror = True
        settings = Settings(
            method="auto", samples=arguments.samples, bounces=6, caustics=True, caustic_patches=arguments.patches
        )
        for _ in range(arguments.repeats):
            begin = time.perf_counter()
            render_still(scene, Job(mirrors, settings), width, height, folder / f"{name}.png", None)
            print(f"{name}: {time.perf_counter() - begin:.1f} s", flush=True)
        if arguments.cycles:
            begin = time.perf_counter()
            draw_cycles(scene, arguments.cycles, (width, height), folder / f"{name}_cycles.png")
            print(f"{name} by Cycles: {time.perf_counter() - begin:.1f} s", flush=True)
    registration.unregister()


if __name__ == "__main__":
    main()
