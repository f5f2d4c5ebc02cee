# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles' pictures of the data set side by side, each with its name.

    .venv/bin/python tools/measure/truth/draw_dataset.py DIR OUT.jpg

Needs Pillow.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402, F401

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.report.display import display_transform  # noqa: E402
from curvrefl.curvrefl_addon.scene.exr_files import load_exr  # noqa: E402
from curvrefl.curvrefl_addon.study.dataset.dataset import CYCLES  # noqa: E402
from curvrefl.curvrefl_addon.study.dataset.scenes import SCENES  # noqa: E402
from PIL import Image, ImageDraw, ImageFont  # noqa: E402

QUALITY = 88
COLUMNS = 5


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--width", type=int, default=208, help="of each picture, pixels")
    arguments = parser.parse_args()
    height = 3 * arguments.width // 4
    grid = Image.new("RGB", (COLUMNS * arguments.width, -(-len(SCENES) // COLUMNS) * height))
    for number, name in enumerate(SCENES):
        shown = display_transform(load_exr(arguments.folder / name / CYCLES)[::-1, :, :3])
        picture = Image.fromarray(np.round(255.0 * np.clip(shown, 0.0, 1.0)).astype(np.uint8))
        picture = picture.resize((arguments.width, height), Image.Resampling.LANCZOS)
        font = ImageFont.load_default(14)
        ImageDraw.Draw(picture).text((6, 4), name, (255, 255, 255), font, stroke_width=2, stroke_fill=(0, 0, 0))
        row, column = divmod(number, COLUMNS)
        grid.paste(picture, (column * arguments.width, row * height))
    grid.save(arguments.output, quality=QUALITY)


if __name__ == "__main__":
    main()
