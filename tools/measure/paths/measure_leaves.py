# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts the pixels at which leaves by clip are not where Cycles has them, at one sample through the pixels' centers.

    .venv/bin/python tools/measure/paths/measure_leaves.py [--size 360x280] [--keep DIR]

Leaves are seen directly and in a sharp mirror; everything shines by itself, so that no light is left to chance. Cycles'
own sample lies up to `NEAR` from the center, so pixels count apart where a picture moved by that shows something else.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.command.inputs import STDOUT, dropped  # noqa: E402
from curvrefl.curvrefl_addon.report.images import save_png  # noqa: E402
from scenes.paths.alpha import emitting_leaves  # noqa: E402
from scenes.paths.judged import Opened, judged_pixels, read_open  # noqa: E402
from scenes.paths.one_sample import centers, wrong_pixels  # noqa: E402
from scenes.paths.registry import OBJECT  # noqa: E402

NEAR = 5e-3
"""Of a pixel"""
AROUND = [(NEAR * x, NEAR * y) for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y]


def moved(opened: Opened, x: float, y: float) -> Opened:
    """The same seen through points that lie this many pixels from the centers."""
    shift = np.eye(4)
    shift[0, 3], shift[1, 3] = 2.0 * x / opened.view.width, 2.0 * y / opened.view.height
    return replace(opened, view=replace(opened.view, view_to_clip=shift @ opened.view.view_to_clip))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", default="360x280")
    parser.add_argument("--keep", type=Path)
    arguments = parser.parse_args()
    with dropped(STDOUT):
        emitting_leaves()
        scene: Any = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = (int(side) for side in arguments.size.split("x"))
        opened = read_open((OBJECT,))
        cycles = centers()
        on_mirror = judged_pixels((OBJECT,))
        ours, warnings = opened.picture(1)
        wrong = wrong_pixels(ours, cycles)
        edge = np.zeros_like(wrong)
        for x, y in AROUND:
            edge |= wrong_pixels(moved(opened, x, y).picture(1)[0], ours)
    print("| where | pixels | wrong | wrong, but at an edge |")
    print("|---|---|---|---|")
    for name, where in (("seen", ~on_mirror), ("in the mirror", on_mirror)):
        print(f"| {name} | {where.sum():,} | {(wrong & ~edge & where).sum()} | {(wrong & edge & where).sum()} |")
    for warning in warnings:
        print(warning)
    if arguments.keep is not None:
        arguments.keep.mkdir(parents=True, exist_ok=True)
        marks = np.repeat(np.where(wrong, np.where(edge, 0.2, 1.0), 0.0)[..., None], 3, -1)
        parts = [cycles[..., :3], ours[..., :3], marks]
        save_png(arguments.keep / "leaves.png", np.concatenate(parts, axis=1).astype(np.float32))


if __name__ == "__main__":
    main()
