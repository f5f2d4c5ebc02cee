# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One pot of chrome, brushed metal, lacquer and glass: ours above, Cycles below.

    .venv/bin/python tools/measure/paths/draw_materials.py OUT.jpg [--size 240x180] [--sub-frames 64] [--samples 128]

Both show direct light, mirrors and glass followed eight times. Needs Pillow.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.command.inputs import STDOUT, dropped  # noqa: E402
from curvrefl.curvrefl_addon.report.display import display_transform  # noqa: E402
from PIL import Image  # noqa: E402
from scenes.paths.judged import cycles_picture, read_open  # noqa: E402
from scenes.paths.registry import OBJECT  # noqa: E402
from scenes.paths.stage import clear, metal, of_principled, put_teapot, room  # noqa: E402

QUALITY = 88
RED = (0.45, 0.02, 0.02, 1.0)
MATERIALS: dict[str, Callable[[], bpy.types.Material]] = {
    "chrome": lambda: metal(0.0),
    "brushed metal": lambda: metal(0.3, (0.9, 0.72, 0.5), Anisotropic=0.7),
    "lacquer": lambda: of_principled("Lacquer", Base_Color=RED, Roughness=0.5, Coat_Weight=1.0, Coat_Roughness=0.03),
    "glass": lambda: clear(1.45, Base_Color=(0.9, 0.97, 1.0, 1.0)),
}


def pictures(material: str, size: list[int], sub_frames: int, samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Ours and Cycles', (h, w, 3), as the screen shows them, row 0 at the top."""
    with dropped(STDOUT):
        room(lens=58.0, target=(0.05, 0.0, 0.9), soft=True)
        put_teapot(MATERIALS[material]())
        scene: Any = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = size
        found = (read_open((OBJECT,)).picture(sub_frames)[0], cycles_picture(samples, 1))
    ours, cycles = (display_transform(picture[::-1, :, :3]) for picture in found)
    return ours, cycles


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=Path)
    parser.add_argument("--size", default="240x180", help="of each picture")
    parser.add_argument("--sub-frames", type=int, default=64)
    parser.add_argument("--samples", type=int, default=128, help="of Cycles")
    arguments = parser.parse_args()
    size = [int(side) for side in arguments.size.split("x")]
    columns = [np.concatenate(pictures(name, size, arguments.sub_frames, arguments.samples)) for name in MATERIALS]
    shown = np.round(255.0 * np.clip(np.concatenate(columns, axis=1), 0.0, 1.0)).astype(np.uint8)
    Image.fromarray(shown).save(arguments.output, quality=QUALITY)


if __name__ == "__main__":
    main()
