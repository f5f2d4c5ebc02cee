# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws one picture of what `./curvrefl stability` has written: a row per trial, a column per method.

python tools/measure/draw_stability.py FOLDER PICTURE.jpg [--trial NAME]

With `--trial` that trial alone, in rows of four whole pictures. Needs matplotlib.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import matplotlib
import numpy as np

bootstrap.load_package()

from curvrefl.curvrefl_addon.optics.catalog import label_of  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

SOLVING = ("exact", "newton", "secant_star", "secant_uv", "bisector_cube", "bisector_grid", "bisector_screen", "planar")
COLUMNS = (*SOLVING, "environment_cube", "environment_parallax")
"""Automatic shows what Exact or Newton does, and the other lookups what Environment Cube does"""
CUT = 340
"""Pixels in the middle of a picture that hold the mirror"""
INCHES = 1.05
QUALITY = 72


def draw_all(report: dict[str, Any], folder: Path, output: Path) -> None:
    """Every trial, cut to the mirror."""
    names = list(report["trials"])
    figure, axes = pyplot.subplots(
        len(names), len(COLUMNS), figsize=(INCHES * len(COLUMNS) + 0.3, INCHES * len(names) + 0.2), squeeze=False
    )
    for row, name in zip(axes, names, strict=True):
        row[0].set_ylabel(name, fontsize=7)
        for axis, method in zip(row, COLUMNS, strict=True):
            _draw(axis, report["trials"][name]["methods"][method], folder, CUT)
    for axis, method in zip(axes[0], COLUMNS, strict=True):
        axis.set_title(label_of(method).replace(" on ", "\non ").replace(" in ", "\nin "), fontsize=6)
    _save(figure, output)


def draw_trial(report: dict[str, Any], name: str, folder: Path, output: Path) -> None:
    """One trial, all methods."""
    methods = report["trials"][name]["methods"]
    rows = math.ceil(len(methods) / 4)
    figure, axes = pyplot.subplots(rows, 4, figsize=(14, 2.8 * rows), squeeze=False)
    for axis in axes.ravel():
        axis.axis("off")
    for axis, (method, result) in zip(axes.ravel(), methods.items(), strict=False):
        _draw(axis, result, folder, 0)
        axis.set_title(label_of(method), fontsize=9)
    _save(figure, output)


def _draw(axis: Any, result: dict[str, Any], folder: Path, cut: int) -> None:
    axis.set_xticks([])
    axis.set_yticks([])
    if not result["file"]:
        axis.text(0.5, 0.5, "refused", ha="center", va="center", fontsize=7, transform=axis.transAxes)
        return
    picture = pyplot.imread(folder / result["file"])
    if cut:
        top, left = ((size - cut) // 2 for size in picture.shape[:2])
        picture = picture[top : top + cut, left : left + cut]
    axis.imshow(np.clip(picture, 0.0, 1.0), interpolation="antialiased")
    axis.set_xlabel(f"{result['differs']:.1%}", fontsize=6, labelpad=1)


def _save(figure: Any, output: Path) -> None:
    figure.tight_layout(pad=0.3, h_pad=0.2, w_pad=0.2)
    figure.savefig(output, dpi=150, pil_kwargs={"quality": QUALITY} if output.suffix in (".jpg", ".jpeg") else None)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--trial", default="")
    options = parser.parse_args()
    report = json.loads((options.folder / "stability.json").read_text(encoding="utf-8"))
    if options.trial:
        draw_trial(report, options.trial, options.folder, options.output)
    else:
        draw_all(report, options.folder, options.output)


if __name__ == "__main__":
    main()
