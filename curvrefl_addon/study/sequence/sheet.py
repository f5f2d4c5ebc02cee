# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A contact sheet of a comparison over frames: a column for each chosen frame, the reference above, then pictures and
errors of each method; by matplotlib, which is imported where it is used."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..charts.chart_draw import PNG_DPI, drawing
from .curves import title_of
from .kept import REFERENCE, folder_of
from .summary import MEASURES, names_of
from .text import headline

COLUMNS = 8
WIDTH = 1.7
"""Inches of a picture"""
JUDGED = ("flicker", "pop", "flip")
"""Measures whose worst frames are among those shown"""
WORST_COLOR = "#CC3311"


def chosen_frames(report: Mapping[str, Any], most: int = COLUMNS) -> dict[int, list[str]]:
    """Frames to show, ascending, each with what it is the worst of: the worst of all methods by each measure, the
    first and the last, and others in the gaps."""
    frames = [entry["frame"] for entry in report["frames"]]
    found: dict[int, list[str]] = {}
    for key in JUDGED:
        for row in report["worst"][key][:1]:
            found.setdefault(row["frame"], []).append(f"worst: {MEASURES[key].label}")
    for frame in (frames[0], frames[-1]):
        found.setdefault(frame, [])
    while len(found) < min(most, len(frames)):
        # (In the middle of the widest gap.)
        farthest = max(frames, key=lambda frame: min(abs(frame - other) for other in found))
        found[farthest] = []
    return dict(sorted(found.items()))


def draw_sheet(report: Mapping[str, Any], folder: Path, path: Path) -> None:
    """The contact sheet of the frames in `folder` as a PNG file. Raises InputError without matplotlib."""
    chosen = chosen_frames(report)
    rows = [(REFERENCE, "Cycles")]
    for name in names_of(report["frames"], "methods"):
        rows += [(name, title_of(name)), (f"{name}_error", "difference x16")]
    width, height = report["resolution"]
    tall = WIDTH * height / width
    with drawing():
        from matplotlib.figure import Figure
        from matplotlib.image import imread

        size = (WIDTH * len(chosen) + 0.5, tall * len(rows) + 0.9)
        figure = Figure(figsize=size)
        panels = figure.subplots(len(rows), len(chosen), squeeze=False)
        figure.subplots_adjust(
            left=0.4 / size[0], right=1.0 - 0.1 / size[0], bottom=0.1 / size[1], top=1.0 - 0.8 / size[1],
            wspace=0.04, hspace=0.04 * width / height,
        )  # fmt: skip
        figure.suptitle(headline(report), fontsize=8, x=0.1 / size[0], y=1.0 - 0.1 / size[1], ha="left", va="top")
        for column, (frame, worst) in enumerate(chosen.items()):
            title = f"frame {frame}" + "".join(f"\n{what}" for what in worst[:2])
            panels[0][column].set_title(title, fontsize=7, color=WORST_COLOR if worst else "black", pad=3)
            for row, (name, label) in enumerate(rows):
                panel = panels[row][column]
                panel.set_xticks([])
                panel.set_yticks([])
                for side in panel.spines.values():
                    side.set(color=WORST_COLOR if worst else "#BBBBBB", linewidth=1.6 if worst else 0.4)
                if column == 0:
                    panel.set_ylabel(label, fontsize=7)
                picture = folder_of(folder, frame) / f"{name}.png"
                # (A method that cannot show the mirrors of a frame has no picture of it.)
                if picture.is_file():
                    panel.imshow(imread(picture), interpolation="antialiased", aspect="auto")
        figure.savefig(path, dpi=PNG_DPI)
