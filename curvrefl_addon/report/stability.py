# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where methods fail: motion, fuzzed input, the solver table and pictures, as a page.

Writes stability.json, solver_table.csv, solver_table.txt, stability.html and TRIAL_METHOD.png into a folder, all or
nothing.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict
from html import escape
from pathlib import Path
from typing import Any

import bpy
import gpu
import numpy as np

from ..errors import InputError
from ..optics.catalogue import METHODS
from ..output import checked_folder, folder_to_publish
from ..renderer.frame import Renderer, Settings
from .images import save_png
from .solver_table import readable, solver_table, write_csv
from .stability_fuzz import Fuzz, fuzz
from .stability_motion import Motion, measure_motion
from .stability_scenes import Trial, trials

MOVING = ("sphere", "ellipsoid", "bumpy", "saddle")
MOTION_VERTICES = 2000

type Progress = Callable[[str], None]


def measure_stability(output: Path | str, vertices: int, triples: int, progress: Progress) -> dict[str, Any]:
    """Measure all and write it into the folder `output`; returns what is in stability.json.

    `vertices` per regime of the solver table, `triples` of the fuzz. Raises InputError for a folder that cannot be
    written to.
    """
    with folder_to_publish(checked_folder(output)) as folder:
        progress(f"Fuzzing with {triples} eyes, vertices and reflectors a method")
        fuzzed = fuzz(triples)
        progress("Following slow paths")
        motions = measure_motion(MOVING, MOTION_VERTICES)
        rows, refusals = solver_table(vertices, progress=progress)
        write_csv(rows, folder / "solver_table.csv")
        (folder / "solver_table.txt").write_text(readable(rows, refusals), encoding="utf-8")
        pictures = []
        for trial in trials():
            progress(f"Drawing {trial.name}")
            pictures.append((trial, _draw(trial, folder)))
        report = {
            "blender": ".".join(str(part) for part in bpy.app.version),
            "gpu": gpu.platform.renderer_get(),
            "fuzz": [asdict(item) for item in fuzzed],
            "motion": [_plain(asdict(item)) for item in motions],
            "refused": [asdict(item) for item in refusals],
            "trials": {trial.name: {"sentence": trial.sentence, "methods": results} for trial, results in pictures},
        }
        (folder / "stability.html").write_text(_page(fuzzed, motions, pictures), encoding="utf-8")
        text = json.dumps(report, indent=1, allow_nan=False)
        (folder / "stability.json").write_text(text + "\n", encoding="utf-8")
    return report


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
    return "\n".join(lines)


def _draw(trial: Trial, folder: Path) -> dict[str, str]:
    """One picture per method; its file's name, or why there is none, by method."""
    results = {}
    for method in METHODS:
        try:
            renderer = Renderer(trial.scene, Settings(method=method, samples=4))
        except InputError as error:
            results[method] = str(error)
            continue
        try:
            color = renderer.render(trial.view).color()
        finally:
            renderer.free()
        results[method] = f"{trial.name.replace(' ', '_')}_{method}.png"
        save_png(folder / results[method], np.ascontiguousarray(color[..., :3]))
    return results


def _page(fuzzed: list[Fuzz], motions: list[Motion], pictures: list[tuple[Trial, dict[str, str]]]) -> str:
    parts = [
        "<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'><title>Where methods fail</title><style>"
        "body{font:15px/1.4 sans-serif;margin:2em;max-width:1400px}figure{display:inline-block;margin:.4em;width:320px;"
        "vertical-align:top}img{width:320px}figcaption{font-size:13px}td,th{padding:.15em .8em;text-align:right}"
        "td:first-child,th:first-child{text-align:left}</style></head><body><h1>Where methods fail</h1>"
    ]
    for trial, results in pictures:
        parts.append(f"<h2>{escape(trial.name.capitalize())}</h2><p>{escape(trial.sentence)}</p>")
        for method, result in results.items():
            label = escape(METHODS[method].label)
            if result.endswith(".png"):
                parts.append(
                    f"<figure><img src='{escape(result)}' alt='{label}'><figcaption>{label}</figcaption></figure>"
                )
            else:
                parts.append(f"<figure><figcaption>{label}: {escape(result)}</figcaption></figure>")
    parts.append("<h2>In motion</h2><table><tr><th>Method</th><th>Reflector</th><th>Path</th><th>Jitter p99, px</th>")
    parts.append("<th>Worst pop, px</th><th>Iterations, later frames</th><th>Identical at rest</th></tr>")
    for motion in motions:
        parts.append(
            f"<tr><td>{escape(METHODS[motion.method].label)}</td><td>{escape(motion.reflector)}</td><td>{motion.path}</td>"
            f"<td>{motion.jitter_p99_px:.3g}</td><td>{motion.worst_pop_px:.3g}</td><td>{motion.iterations_later:.1f}</td>"
            f"<td>{'yes' if motion.identical_at_rest else 'no'}</td></tr>"
        )
    parts.append("</table><h2>Any input</h2><table><tr><th>Method</th><th>Triples</th><th>Not finite</th><th>Off the ")
    parts.append("reflector</th><th>Without code</th><th>Unsolved</th></tr>")
    for item in fuzzed:
        parts.append(
            f"<tr><td>{escape(METHODS[item.method].label)}</td><td>{item.triples}</td><td>{item.not_finite}</td>"
            f"<td>{item.wild}</td><td>{item.without_code}</td><td>{item.unsolved / item.triples:.2%}</td></tr>"
        )
    parts.append(
        "</table><p>All reflectors and regimes: <a href='solver_table.txt'>solver_table.txt</a>.</p></body></html>"
    )
    return "".join(parts) + "\n"


def _plain(values: dict[str, Any]) -> dict[str, Any]:
    """JSON has no NaN."""
    return {name: None if isinstance(value, float) and np.isnan(value) else value for name, value in values.items()}


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"
