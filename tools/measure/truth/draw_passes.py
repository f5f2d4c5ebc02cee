# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of a multilayer file side by side, as colors.

    .venv/bin/python tools/measure/truth/draw_passes.py FILE.exr OUT.jpg

Needs Pillow.
"""

from __future__ import annotations

import argparse
import runpy
import sys
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402, F401  (OpenImageIO comes with it)

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.report.display import display_transform  # noqa: E402
from PIL import Image, ImageDraw, ImageFont  # noqa: E402
from rendered import open_image_io  # noqa: E402

QUALITY = 88
MARGIN = 8
"""Pixels about the mirrors that are shown"""
COLUMNS = 4
BACKGROUND = 0.12
"""Where no mirror is seen"""
LOW, HIGH = np.array([0.05, 0.1, 0.35]), np.array([1.0, 0.85, 0.3])


def signed(values: np.ndarray) -> np.ndarray:
    """Directions as colors."""
    return 0.5 + 0.5 * values[..., :3]


def scaled(values: np.ndarray) -> np.ndarray:
    """From dark to light between the 1st and 99th percentile of what is finite."""
    known = values[(values != 0.0) & (values < 1e9)]
    low, high = np.percentile(known, (1, 99)) if known.size else (0.0, 1.0)
    share = np.clip((values - low) / max(high - low, 1e-9), 0.0, 1.0)[..., None]
    return LOW + share * (HIGH - LOW)


def plain(values: np.ndarray) -> np.ndarray:
    """As it is, with a blue of 0."""
    return np.concatenate([values[..., :2] % 1.0, 0.4 * values[..., 2:3]], axis=-1)


def moved(values: np.ndarray) -> np.ndarray:
    """Ways in the picture: to the right is red, up is green, none is gray."""
    reach = max(float(np.percentile(np.abs(values[..., :2]), 99)), 1e-9)
    return np.clip(0.5 + 0.5 * np.concatenate([values[..., :2], 0.0 * values[..., :1]], axis=-1) / reach, 0.0, 1.0)


def numbered(values: np.ndarray) -> np.ndarray:
    """A color for each number."""
    return np.stack([(values * factor) % 1.0 for factor in (0.618, 0.377, 0.751)], axis=-1)


DRAWN: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "Combined": lambda values: display_transform(values[..., :3]),
    "Normal": signed,
    "Albedo": display_transform,
    "UV": plain,
    "Depth": scaled,
    "Incidence": scaled,
    "Object": numbered,
    "Vector": moved,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--width", type=int, default=264, help="of each picture, pixels")
    arguments = parser.parse_args()
    open_image_io()
    passes, _ = runpy.run_path(str(ROOT / "examples" / "read_passes.py"))["read_passes"](arguments.file)
    by_name = {name.partition(".")[2]: values for name, values in passes.items()}
    mirrors = by_name["Mirror ID"] > 0.0
    rows_seen, columns_seen = (np.flatnonzero(mirrors.any(axis=axis)) for axis in (1, 0))
    about = (
        slice(max(rows_seen[0] - MARGIN, 0), rows_seen[-1] + MARGIN),
        slice(max(columns_seen[0] - MARGIN, 0), columns_seen[-1] + MARGIN),
    )
    cells = []
    for name, draw in DRAWN.items():
        if name not in by_name:
            continue
        shown = draw(by_name[name])
        if name != "Combined":
            shown = np.where(mirrors[..., None], shown, BACKGROUND)
        shown = shown[about]
        picture = Image.fromarray(np.round(255.0 * np.clip(shown, 0.0, 1.0)).astype(np.uint8))
        size = (arguments.width, round(arguments.width * picture.height / picture.width))
        picture = picture.resize(size, Image.Resampling.LANCZOS)
        ImageDraw.Draw(picture).text((6, 4), name, (255, 255, 255), ImageFont.load_default(14))
        cells.append(picture)
    rows = -(-len(cells) // COLUMNS)
    grid = Image.new("RGB", (COLUMNS * cells[0].width, rows * cells[0].height))
    for number, cell in enumerate(cells):
        row, column = divmod(number, COLUMNS)
        grid.paste(cell, (column * cell.width, row * cell.height))
    grid.save(arguments.output, quality=QUALITY)


if __name__ == "__main__":
    main()
