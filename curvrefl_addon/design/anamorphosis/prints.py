# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of what is printed."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ...output import folder_to_publish
from ...scene.arrays import Float32Array
from ...scene.exr_files import save_exr
from ..stage import ChosenSurface
from .making import Making
from .png_file import png_bytes
from .sheet import Paper


def write_prints(making: Making, paper: Paper, folder: Path) -> list[str]:
    """For each surface NAME_print.png, NAME_print.svg with the picture and NAME_grid.svg with lines in its place; all
    of them or none. Returns sentences about them.

    Raises InputError where a surface cannot be printed, and where the files cannot be written.
    """
    with folder_to_publish(folder) as part:
        return [_write(making, surface, paper, part) for surface in making.stage.surfaces]


def _write(making: Making, surface: ChosenSurface, paper: Paper, folder: Path) -> str:
    sheet = making.sheet(surface, paper)
    stem = file_name(surface.name)
    (folder / f"{stem}_print.png").write_bytes(sheet.png())
    (folder / f"{stem}_print.svg").write_text(sheet.svg(surface.name), encoding="utf-8")
    (folder / f"{stem}_grid.svg").write_text(sheet.svg(surface.name, with_picture=False), encoding="utf-8")
    width, height = sheet.size
    foot = " x ".join(f"{side:.1f}" for side in sheet.footprint_size)
    size = "true size" if abs(sheet.scale - 1.0) < 1e-6 else f"{sheet.scale:.4g} of its size"
    return (
        f'The sheet of "{surface.name}" is {width:.1f} x {height:.1f} mm at {paper.dots_per_inch:g} dots per inch, '
        f"{size}, for a mirror that stands on {foot} mm."
    )


def image_file(folder: Path, name: str, pixels: Float32Array, is_encoded: bool) -> None:
    """A surface's image, pixels as `Placed` has them, as NAME.png, or NAME.exr where they are not on sRGB's curve."""
    if is_encoded:
        (folder / f"{file_name(name)}.png").write_bytes(png_bytes(pixels))
        return
    colors = np.concatenate([pixels[..., :3] * pixels[..., 3:], pixels[..., 3:]], axis=2)
    save_exr(folder / f"{file_name(name)}.exr", colors)


def file_name(name: str) -> str:
    """An object's name as that of a file."""
    return re.sub(r"[^\w. -]", "_", name).strip(". ") or "surface"
