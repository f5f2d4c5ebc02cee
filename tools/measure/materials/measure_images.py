# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a scene's images take from their files to the first picture, and how much memory.

    .venv/bin/python tools/measure/materials/measure_images.py [--count 41] [--side 2048] [--format JPEG] [--cap 1024]

So many cubes around a mirror ball, each with an image of its own from a file. *Steps* are those of a viewport, which
reads and copies for a moment in each redraw: the longest and how many.
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
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
from curvrefl.curvrefl_addon.viewport.region import LOADING_SECONDS  # noqa: E402
from scenes.awkward.stage import principled_node  # noqa: E402
from scenes.builders import mirror_sphere  # noqa: E402
from scenes.paths.judged import read_open  # noqa: E402

ENDINGS = {"JPEG": "jpg", "PNG": "png"}


def write_images(folder: Path, count: int, side: int, kind: str) -> list[Path]:
    """Files of smooth noise, as photographs have."""
    paths = []
    for number in range(count):
        image = bpy.data.images.new(f"made {number}", side, side)
        coarse = np.random.default_rng(number).random((side // 8, side // 8, 4), np.float32)
        pixels = coarse.repeat(8, axis=0).repeat(8, axis=1)
        image.pixels.foreach_set(pixels.ravel())  # type: ignore[arg-type]
        image.filepath_raw = str(folder / f"{number}.{ENDINGS[kind]}")
        image.file_format = kind  # type: ignore[assignment]
        image.save()
        paths.append(Path(image.filepath_raw))
        bpy.data.images.remove(image)
    return paths


def build(paths: list[Path]) -> str:
    """The scene; the mirror's name."""
    reflector = mirror_sphere()
    for number, path in enumerate(paths):
        turn = 2.0 * np.pi * number / len(paths)
        bpy.ops.mesh.primitive_cube_add(size=0.35, location=(2.5 * np.cos(turn), 2.5 * np.sin(turn), 0.0))
        material = bpy.data.materials.new(path.stem)
        tree: Any = material.node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.load(str(path))
        tree.links.new(node.outputs["Color"], principled_node(material).inputs["Base Color"])
        cube: Any = bpy.context.object
        cube.data.materials.append(material)
    return str(reflector.name)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=41)
    parser.add_argument("--side", type=int, default=2048)
    parser.add_argument("--format", choices=sorted(ENDINGS), default="JPEG")
    parser.add_argument("--cap", type=int, default=1024)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, dropped(STDOUT):
        paths = write_images(Path(folder), arguments.count, arguments.side, arguments.format)
        mirror = build(paths)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        wall, processor = perf_counter(), process_time()
        opened = read_open((mirror,))
        Renderer(opened.arrays, Settings(method="exact", samples=1), arguments.cap << 20).render(opened.view).color()
        spent = perf_counter() - wall, process_time() - processor
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        gradual = Renderer(opened.arrays, Settings(method="exact", samples=1), arguments.cap << 20, is_gradual=True)
        steps = []
        while gradual.is_loading:
            start = perf_counter()
            gradual.load_some(LOADING_SECONDS)
            steps.append(perf_counter() - start)
    megapixels = arguments.count * arguments.side**2 / 1e6
    print(f"{arguments.count} images, {megapixels:.0f} million pixels, {arguments.format}")
    print(f"to the first picture {spent[0]:.1f} s, processor {spent[1]:.1f} s")
    print(f"peak of memory {peak / 1024:.0f} MB, {before / 1024:.0f} MB before")
    print(f"{len(steps)} steps, the longest {max(steps):.2f} s, half of them under {np.median(steps):.2f} s")
    print(*gradual.warnings, sep="\n")


if __name__ == "__main__":
    main()
