# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where methods fail: motion, fuzzed input, the solver table and pictures, as a page.

Writes stability.json, solver_table.csv, solver_table.txt, stability.html and TRIAL_METHOD.png into a folder, all or
nothing.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from typing import Any

import bpy
import numpy as np

from ...output import checked_folder, folder_to_publish
from ...renderer.device.context import renderer_name
from ..solvers.solver_table import readable, solver_table, write_csv
from .fuzz import fuzz
from .motion import measure_motion
from .page import stability_page
from .pictures import draw_trial
from .scenes import trials

MOVING = ("sphere", "ellipsoid", "bumpy", "saddle", "glass sphere", "bumpy glass")
MOTION_VERTICES = 2000

type Progress = Callable[[str], None]


def measure_stability(output: Path | str, vertices: int, triples: int, progress: Progress) -> dict[str, Any]:
    """Measure all and write it into the folder `output`; returns what is in stability.json.

    `vertices` per regime of the solver table, `triples` of the fuzz. Raises InputError for a folder that cannot be
    written to.
    """
    seconds: dict[str, float] = {}
    with folder_to_publish(checked_folder(output)) as folder:
        with _timed(seconds, "pictures"):
            pictures = [(trial, draw_trial(trial, folder, progress)) for trial in trials()]
        with _timed(seconds, "motion"):
            motions = measure_motion(MOVING, MOTION_VERTICES, progress)
        with _timed(seconds, "solver table"):
            rows, refusals = solver_table(vertices, progress=progress)
        with _timed(seconds, "fuzz"):
            fuzzed = fuzz(triples, progress=progress)
        write_csv(rows, folder / "solver_table.csv")
        (folder / "solver_table.txt").write_text(readable(rows, refusals), encoding="utf-8")
        blender, device = ".".join(str(part) for part in bpy.app.version), renderer_name()
        report = {
            "blender": blender,
            "gpu": device,
            "seconds": seconds,
            "fuzz": [asdict(item) for item in fuzzed],
            "motion": [_plain(asdict(item)) for item in motions],
            "refused": [asdict(item) for item in refusals],
            "trials": {
                trial.name: {
                    "sentence": trial.sentence,
                    "methods": {method: _plain(asdict(result)) for method, result in results.items()},
                }
                for trial, results in pictures
            },
        }
        page = stability_page(f"Blender {blender} on {device}.", fuzzed, motions, pictures)
        (folder / "stability.html").write_text(page, encoding="utf-8")
        text = json.dumps(report, indent=1, allow_nan=False)
        (folder / "stability.json").write_text(text + "\n", encoding="utf-8")
    return report


@contextmanager
def _timed(seconds: dict[str, float], part: str) -> Iterator[None]:
    start = perf_counter()
    yield
    seconds[part] = perf_counter() - start


def format_stability(report: dict[str, Any]) -> str:
    """What the command line prints."""
    lines = [f"{'':18} {'triples':>9} {'not finite':>10} {'wild':>6} {'no code':>8} {'unsolved':>9}"]
    for item in report["fuzz"]:
        share = item["unsolved"] / max(item["triples"], 1)
        lines.append(
            f"{item['method']:18} {item['triples']:9} {item['not_finite']:10} {item['wild']:6} "
            f"{item['without_code']:8} {share:9.2%}"
        )
    lines.append(
        f"\n{'':18} {'reflector':12} {'path':8} jitter px: median      p99  worst pop px  iterations: first  later"
        "  identical at rest"
    )
    for item in report["motion"]:
        lines.append(
            f"{item['method']:18} {item['reflector']:12} {item['path']:8} {_number(item['jitter_median_px']):>17} "
            f"{_number(item['jitter_p99_px']):>8} {_number(item['worst_pop_px']):>13} "
            f"{item['iterations_first']:18.1f} {item['iterations_later']:6.1f}  "
            f"{'yes' if item['identical_at_rest'] else 'NO'}"
        )
    times = ", ".join(f"{part} {value:.0f} s" for part, value in report["seconds"].items())
    lines.append(f"\nTook {times}.")
    return "\n".join(lines)


def _plain(values: dict[str, Any]) -> dict[str, Any]:
    """JSON has no NaN."""
    return {name: None if isinstance(value, float) and np.isnan(value) else value for name, value in values.items()}


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"
