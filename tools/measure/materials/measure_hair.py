# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What hair costs: the first picture of a scene with it, and a frame beside one without, taking turns.

    .venv/bin/python tools/measure/materials/measure_hair.py [--strands 20000] [--segments 8] [--size 640x480]

A ball of fur before a mirror ball. *Processor* is the time of all threads, the least of the repeats.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402
import numpy as np  # noqa: E402

bootstrap.load_package()

from curvrefl.curvrefl_addon.command.inputs import STDOUT, dropped  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from scenes.builders import mirror_sphere  # noqa: E402
from scenes.paths.judged import read_open  # noqa: E402

RADIUS, LENGTH, BEND = 0.4, 0.25, 0.15
CENTER = (1.6, -1.2, -0.4)
REPEATS = 7


def add_fur(strands: int, segments: int) -> None:
    """Strands that bend downwards, evenly about a ball."""
    data: Any = bpy.data.hair_curves.new("fur")
    data.add_curves([segments + 1] * strands)
    numbers = np.arange(strands) + 0.5
    height, turn = 1.0 - 2.0 * numbers / strands, np.pi * (1.0 + 5.0**0.5) * numbers
    flat = np.sqrt(1.0 - height**2)
    out = np.column_stack([flat * np.cos(turn), flat * np.sin(turn), height])
    along = np.linspace(0.0, 1.0, segments + 1)
    places = out[:, None] * (RADIUS + LENGTH * along[:, None])
    places[..., 2] -= BEND * along**2
    data.points.foreach_set("position", places.astype(np.float32).ravel())
    fur: Any = bpy.data.objects.new("fur", data)
    fur.location = CENTER
    scene: Any = bpy.context.scene
    scene.collection.objects.link(fur)


def first_picture(with_hair: bool, arguments: argparse.Namespace) -> tuple[Renderer, Any, float, float]:
    """A renderer that has drawn a picture, the view, and the seconds from the open scene to it: wall and processor."""
    with dropped(STDOUT):
        reflector = mirror_sphere()
        if with_hair:
            add_fur(arguments.strands, arguments.segments)
        scene: Any = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = (int(side) for side in arguments.size.split("x"))
        wall, processor = perf_counter(), process_time()
        opened = read_open((reflector.name,))
        renderer = Renderer(opened.arrays, Settings(method="exact", samples=1))
        renderer.render(opened.view).color()
    return renderer, opened.view, perf_counter() - wall, process_time() - processor


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--strands", type=int, default=20000)
    parser.add_argument("--segments", type=int, default=8)
    parser.add_argument("--size", default="640x480")
    arguments = parser.parse_args()
    found = {with_hair: first_picture(with_hair, arguments) for with_hair in (False, True)}
    least = dict.fromkeys(found, (np.inf, np.inf))
    for _ in range(REPEATS):
        for with_hair, (renderer, view, _, _) in found.items():
            wall, processor = perf_counter(), process_time()
            renderer.render(view).color()
            spent = perf_counter() - wall, process_time() - processor
            least[with_hair] = (min(least[with_hair][0], spent[0]), min(least[with_hair][1], spent[1]))
    for with_hair, (renderer, _, wall, processor) in found.items():
        triangles = sum(len(mesh.triangles) for mesh in renderer.scene.meshes)
        frame, work = least[with_hair]
        print(
            f"{'with' if with_hair else 'without'} hair: {triangles} triangles, first picture {wall:.2f} s (processor "
            f"{processor:.2f} s), frame {1e3 * frame:.0f} ms (processor {1e3 * work:.0f} ms)"
        )
    print(f"a frame with hair takes {least[True][1] / least[False][1]:.1f} times the work of one without")


if __name__ == "__main__":
    main()
