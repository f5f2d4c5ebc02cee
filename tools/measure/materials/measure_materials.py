# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What many textured materials cost beside one, and a frame with one beside plain colors, taking turns.

    .venv/bin/python tools/measure/materials/measure_materials.py [--count 100] [--size 640x480] [--repeats 11]

A hall of cubes around a mirror ball, each with a material of an image, noise or both: none, one for all, so many of one
shape of tree, so many of 20 shapes. *Processor* is the time of all threads of a sub-frame, the least of the repeats.
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
from scenes.awkward.stage import principled_node  # noqa: E402
from scenes.builders import mirror_sphere  # noqa: E402
from scenes.paths.judged import read_open  # noqa: E402

SUB_FRAMES = 2
SIDE = 64
"""Of the images, in pixels"""


def image(number: int) -> bpy.types.Image:
    made = bpy.data.images.new(f"image {number}", SIDE, SIDE)
    pixels = np.random.default_rng(number).random((SIDE, SIDE, 4), np.float32)
    pixels[..., 3] = 1.0
    made.pixels.foreach_set(pixels.ravel())  # type: ignore[arg-type]
    return made


def textured(number: int, shape: int) -> bpy.types.Material:
    """A material whose base color is an image, changed by as many nodes as its `shape` says."""
    material = bpy.data.materials.new(f"material {number}")
    tree: Any = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image(number)
    color = node.outputs["Color"]
    for _ in range(shape):
        gamma = tree.nodes.new("ShaderNodeGamma")
        gamma.inputs["Gamma"].default_value = 1.0 + 0.01 * number
        tree.links.new(color, gamma.inputs["Color"])
        color = gamma.outputs["Color"]
    tree.links.new(color, principled_node(material).inputs["Base Color"])
    return material


def renderer_of(kind: str, count: int, size: list[int]) -> tuple[Renderer, Any, int]:
    """A warm renderer of the hall, the view, and how many programs it has."""
    with dropped(STDOUT):
        reflector = mirror_sphere()
        plain = bpy.data.materials.new("plain")
        one = textured(0, 0)
        for number in range(count):
            turn = 2.0 * np.pi * number / count
            place = (2.5 * np.cos(turn), 2.5 * np.sin(turn), 0.6 * (number % 4) - 0.9)
            bpy.ops.mesh.primitive_cube_add(size=0.35, location=place)
            material = {"plain": plain, "one": one}.get(kind)
            if material is None:
                material = textured(number, number % 20 if kind == "shapes" else 0)
            cube: Any = bpy.context.object
            cube.data.materials.append(material)
        scene: Any = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = size
        opened = read_open((reflector.name,))
        renderer = Renderer(opened.arrays, Settings(method="exact", samples=SUB_FRAMES))
        renderer.render(opened.view).color()
    materials = renderer._appearance.materials
    return renderer, opened.view, len(materials.programs.shapes) if materials.has_programs else 0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--repeats", type=int, default=11)
    arguments = parser.parse_args()
    size = [int(side) for side in arguments.size.split("x")]
    kinds = ("plain", "one", "many", "shapes")
    found = {kind: renderer_of(kind, arguments.count, size) for kind in kinds}
    least = dict.fromkeys(kinds, (np.inf, np.inf))
    for _ in range(arguments.repeats):
        for kind, (renderer, view, _) in found.items():
            wall, processor = perf_counter(), process_time()
            renderer.render(view).color()
            spent = (perf_counter() - wall) / SUB_FRAMES, (process_time() - processor) / SUB_FRAMES
            least[kind] = (min(least[kind][0], spent[0]), min(least[kind][1], spent[1]))
    print(f"{'materials':10} {'programs':>8} {'wall ms':>8} {'processor ms':>12} {'beside one':>10}")
    for kind in kinds:
        wall, processor = least[kind]
        share = processor / least["one"][1]
        print(f"{kind:10} {found[kind][2]:8} {1e3 * wall:8.1f} {1e3 * processor:12.1f} {share:10.2f}")


if __name__ == "__main__":
    main()
