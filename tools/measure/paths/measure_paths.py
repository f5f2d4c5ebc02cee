# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of paths at rough, glassy and leafy surfaces against Cycles, scene by scene, beside the numbers wanted.

    .venv/bin/python tools/measure/paths/measure_paths.py [NAME ..] [--sub-frames 16,64] [--keep DIR]
        [--references-only] [--quick]

A name may be a topic: metals, layers, glass, alpha, furnace. A scene's row: FLIP over what is judged at each number of
sub-frames; the same of Cycles with as many samples; the references' own noise, which counts where it is above a
quarter of what is measured; the largest relative error of the mean color over the three channels at the most
sub-frames, and Cycles' between its two seeds. `--quick`: references of 64 samples, to find what is wrong, not how far
off it is. `--keep` writes ours, Cycles and the error of each scene side by side.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402, F401  (before gpu)

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.command.inputs import STDOUT, dropped  # noqa: E402
from curvrefl.curvrefl_addon.errors import InputError  # noqa: E402
from curvrefl.curvrefl_addon.report.images import save_png  # noqa: E402
from curvrefl.curvrefl_addon.report.metrics import error_map  # noqa: E402
from scenes.paths import SCENES, TOPICS, PathScene  # noqa: E402
from scenes.paths.furnace import FURNACE_WORLD, ROUGHNESSES, ball_name  # noqa: E402
from scenes.paths.judged import References, inner, judged_numbers, open_scene, references  # noqa: E402
from scenes.paths.registry import GLASS_LIMIT  # noqa: E402

QUICK_SAMPLES = 64
MEAN_LIMIT = 0.01
GLASS_SHARE = 1.5
"""Largest FLIP at 64 sub-frames over that of Cycles with 64 samples, where that has more than 0.02"""
FURNACE_LIMIT = 0.005


def measure(scene: PathScene, numbers: list[int], keep: Path | None, references_only: bool) -> str:
    """Renders what is missing and returns the row."""
    with dropped(STDOUT):
        opened = open_scene(scene)
        cycles = references(scene)
    if references_only:
        kept(scene, cycles, {}, keep)
        return f"| {scene.name} | noise {cycles.noise:.4f} | Cycles {peers(cycles)} |"
    ours: dict[int, np.ndarray] = {}
    warnings: tuple[str, ...] = ()
    try:
        for number in numbers:
            ours[number], warnings = opened.picture(number)
    except InputError as error:
        return f"| {scene.name} | refused: {error} |"
    kept(scene, cycles, ours, keep)
    if scene.name.startswith("furnace"):
        return furnace_rows(scene, cycles, ours[numbers[-1]], warnings)
    flips = {number: cycles.flip(picture) for number, picture in ours.items()}
    mean, own = cycles.color_error(ours[numbers[-1]]), cycles.color_error(cycles.first, cycles.second)
    wanted = dict(zip((16, 64), scene.limits, strict=True))
    if scene.limits == GLASS_LIMIT and 64 in cycles.peers:
        wanted[64] = max(scene.limits[1], GLASS_SHARE * cycles.flip(cycles.peers[64]))
    verdicts = [flips[n] <= limit for n, limit in wanted.items() if limit is not None and n in flips]
    verdicts += [abs(mean) <= MEAN_LIMIT]
    noisy = " (reference too noisy)" if cycles.noise > 0.25 * min(flips.values()) else ""
    shown = " / ".join(f"{flip:.4f}" for flip in flips.values())
    limits = " / ".join("-" if limit is None else f"{limit:.3g}" for limit in wanted.values())
    said = "; ".join(warnings)
    return (
        f"| {scene.name} | {shown} | {limits} | {peers(cycles)} | {cycles.noise:.4f}{noisy} | {100 * mean:+.2f} % "
        f"| {100 * own:+.2f} % | {'met' if all(verdicts) else 'NOT MET'} | {said} |"
    )


def peers(cycles: References) -> str:
    """FLIP of Cycles with few samples."""
    return " / ".join(f"{cycles.flip(picture):.4f}" for picture in cycles.peers.values())


def furnace_rows(scene: PathScene, cycles: References, ours: np.ndarray, warnings: tuple[str, ...]) -> str:
    """A line for each row of balls: what each reflects of the world, ours and Cycles'."""
    lines = []
    with dropped(STDOUT):
        numbers = judged_numbers(scene.mirrors)
    for row in range(len(scene.mirrors) // len(ROUGHNESSES)):
        shares = []
        for column in range(len(ROUGHNESSES)):
            here = inner(numbers == scene.mirrors.index(ball_name(row, column)) + 1)
            mean = ours[here][:, :3].mean() / FURNACE_WORLD
            shares.append((mean, cycles.truth[here][:, :3].mean() / FURNACE_WORLD))
        worst = max(abs(mean - 1.0) for mean, _ in shares)
        both = ", ".join(f"{mean:.4f} ({theirs:.4f})" for mean, theirs in shares)
        verdict = "met" if worst <= FURNACE_LIMIT else "NOT MET"
        lines.append(f"| {scene.name} row {row} | {both} | worst {100 * worst:.2f} % | {verdict} |")
    return "\n".join([*lines, *(f"  {warning}" for warning in warnings)])


def kept(scene: PathScene, cycles: References, ours: dict[int, np.ndarray], keep: Path | None) -> None:
    """Cycles, ours with each number of sub-frames, and the error of the last, side by side."""
    if keep is None:
        return
    keep.mkdir(parents=True, exist_ok=True)
    parts = [cycles.truth[..., :3], *(picture[..., :3] for picture in ours.values())]
    if ours:
        from curvrefl.curvrefl_addon.report.display import inverse_display_transform

        parts.append(inverse_display_transform(error_map(parts[-1], parts[0])))
    save_png(keep / f"{scene.name}.png", np.concatenate(parts, axis=1).astype(np.float32))


def chosen(names: list[str]) -> list[PathScene]:
    """Scenes by name or topic, all where there is none."""
    topics: dict[str, ModuleType] = {topic.__name__.rpartition(".")[2]: topic for topic in TOPICS}
    found: dict[str, PathScene] = {}
    for name in names or list(SCENES):
        if name in SCENES:
            found[name] = SCENES[name]
        elif name in topics:
            found |= {key: scene for key, scene in SCENES.items() if _module(scene) == topics[name].__name__}
        else:
            raise SystemExit(f"There is no scene or topic {name}: choose from {', '.join([*topics, *SCENES])}.")
    return list(found.values())


def _module(scene: PathScene) -> str:
    build: Any = scene.build
    return getattr(build, "func", build).__module__


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--sub-frames", default="16,64")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--references-only", action="store_true", help="render what Cycles has to, and no more")
    parser.add_argument("--quick", action="store_true", help="noisy references")
    arguments = parser.parse_args()
    numbers = [int(number) for number in arguments.sub_frames.split(",")]
    if not arguments.references_only:
        print("| scene | FLIP | limits | Cycles 16 / 64 | noise | mean color | Cycles' seeds | | warnings |")
        print("|---|---|---|---|---|---|---|---|---|")
    for scene in chosen(arguments.names):
        if arguments.quick:
            scene = replace(scene, samples=min(scene.samples, QUICK_SAMPLES))
        print(measure(scene, numbers, arguments.keep, arguments.references_only), flush=True)


if __name__ == "__main__":
    main()
