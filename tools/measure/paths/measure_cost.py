# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a sub-frame of a rough mirror costs beside that of a sharp one, the two taking turns.

    .venv/bin/python tools/measure/paths/measure_cost.py [--size 640x480] [--repeats 15] [--roughness 0.1,0.3,0.5]

Of the sphere that tools/make_scenes.py makes, by `exact`. *Processor* is the time of all threads of a sub-frame, the
least of the repeats: of a software renderer that is its work, whatever else the machine is doing.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402

bootstrap.load_package()

from curvrefl.curvrefl_addon.command.inputs import STDOUT, dropped  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from scenes.awkward.stage import principled_node  # noqa: E402
from scenes.builders import mirror_sphere  # noqa: E402
from scenes.paths.judged import read_open  # noqa: E402

SUB_FRAMES = 2


def renderer_of(roughness: float, size: list[int]) -> tuple[Renderer, Any]:
    """A renderer of the sphere's scene, warm, and the view."""
    with dropped(STDOUT):
        reflector = mirror_sphere()
        material: Any = reflector.data.materials[0]
        principled_node(material).inputs["Roughness"].default_value = roughness
        scene: Any = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = size
        opened = read_open((reflector.name,))
        renderer = Renderer(opened.arrays, Settings(method="exact", samples=SUB_FRAMES))
        renderer.render(opened.view).color()
    return renderer, opened.view


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--repeats", type=int, default=15)
    parser.add_argument("--roughness", default="0.1,0.3,0.5")
    arguments = parser.parse_args()
    values = [0.0, *(float(value) for value in arguments.roughness.split(","))]
    size = [int(side) for side in arguments.size.split("x")]
    found = [renderer_of(value, size) for value in values]
    work: list[list[float]] = [[] for _ in values]
    times: list[list[float]] = [[] for _ in values]
    for _ in range(arguments.repeats):
        for number, (renderer, view) in enumerate(found):
            start, before = perf_counter(), process_time()
            renderer.render(view).color()
            times[number].append(1e3 * (perf_counter() - start) / SUB_FRAMES)
            work[number].append(1e3 * (process_time() - before) / SUB_FRAMES)
    print("| roughness | sub-frame, ms | processor, ms | over sharp |")
    print("|---|---|---|---|")
    for value, spent, worked in zip(values, times, work, strict=True):
        ratio = min(worked) / min(work[0])
        print(f"| {value:g} | {median(spent):.1f} | {min(worked):.1f} | {ratio:.2f} |")
    for renderer, _ in found:
        renderer.free()


if __name__ == "__main__":
    main()
