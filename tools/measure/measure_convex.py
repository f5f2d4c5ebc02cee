# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether `auto` keeps its word: random closed convex mirrors, its picture beside `exact`, pixel by pixel.

    python tools/measure/measure_convex.py [--cases 1000] [--first 0] [--most-pixels 1228800] [--verbose] [--force]
        [--cost]

A case is over its tolerance where the 99th percentile of the errors of the mirror's pixels is. `--force` takes
reflection points wherever the choice by cost alone would not: the bound must hold there too. `--cost` compares
processor times instead: of `auto`, of rays, and of reflection points where their picture is under the tolerance
whatever the bound says; a line for each mirror on which `auto` takes over 1.1 times the cheapest right way, with what
`auto` says. *Bound* are those where it does not trust reflection points, whatever they would cost.
"""

from __future__ import annotations

import argparse
import sys
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from statistics import median
from time import process_time
from unittest.mock import patch

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "tests"))

import bootstrap

bootstrap.load_package()

import bpy  # noqa: E402, F401
import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer import choice as choices  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from scenes.convex_mirrors import Case, convex_case, pixel_errors  # noqa: E402


def judge(case: Case) -> tuple[str, float, float]:
    """What was chosen, the 99th percentile of the pixels' errors, and the share of pixels that show another object."""
    renderer = Renderer(case.scene, Settings(method="auto", samples=1, pixel_tolerance=case.tolerance))
    frame = renderer.render(case.view)
    assert frame.choice is not None
    method = str(frame.choice["method"])
    if method == choices.RAYS:
        renderer.free()
        return method, 0.0, 0.0
    frame.surfaces  # noqa: B018  (read back before the renderer draws again)
    other = Renderer(case.scene, Settings(method="exact", samples=1))
    exact = other.render(case.view)
    errors = pixel_errors(frame, exact)
    wrong = (frame.reflected_object() != exact.reflected_object())[exact.mask() > 0]
    renderer.free()
    other.free()
    return method, float(np.percentile(errors, 99)) if len(errors) else 0.0, float(wrong.mean()) if len(wrong) else 0.0


def solved_anyway(case: Case) -> Renderer | None:
    """Reflection points without a bound, with the settings that `auto` would give them; None where they are wrong."""
    names = {"MOST_SHARE": 1e9, "MAP_SHARE": 1e9, "SHARPEST_SPLIT": np.inf, "THINNEST_SHARE": 0.0}
    with ExitStack() as stack:
        for name, value in names.items():
            stack.enter_context(patch.object(choices, name, value))
        auto = Renderer(case.scene, Settings(method="auto", samples=1, pixel_tolerance=case.tolerance))
        chosen = auto.reflect(case.view, is_still=True).choice
        auto.free()
    assert chosen is not None
    if chosen.mirrors[0].method != choices.VERTICES:
        return None
    renderer = Renderer(case.scene, chosen.mirrors[0].settings)
    exact = Renderer(case.scene, Settings(method="exact", samples=1))
    errors = pixel_errors(renderer.render(case.view), exact.render(case.view))
    exact.free()
    return renderer if len(errors) and np.percentile(errors, 99) <= case.tolerance else None


def ratio_to_best(case: Case, rounds: int = 5) -> tuple[float, dict[str, float], str]:
    """Time of `auto` over the cheapest right way, the median processor milliseconds of all, and why `auto` took its."""
    settings = Settings(method="auto", samples=1, pixel_tolerance=case.tolerance)
    ways = {"auto": Renderer(case.scene, settings), "exact": Renderer(case.scene, replace(settings, method="exact"))}
    if (points := solved_anyway(case)) is not None:
        ways["points"] = points
    times: dict[str, list[float]] = {name: [] for name in ways}
    why = ""
    for name, renderer in ways.items():
        choice = renderer.render(case.view).choice
        why = str(choice["why"]) if name == "auto" and choice is not None else why
        renderer.hierarchies.finish()
    for _ in range(rounds):
        for name, renderer in ways.items():
            start = process_time()
            renderer.render(case.view)
            times[name].append(1e3 * (process_time() - start))
    for renderer in ways.values():
        renderer.free()
    medians = {name: median(found) for name, found in times.items()}
    return medians["auto"] / min(medians.values()), medians, why


def print_costs(first: int, cases: int, most_pixels: int) -> None:
    """Of so many mirrors."""
    ratios, bound = [], 0
    for seed in range(first, first + cases):
        case = convex_case(seed, most_pixels)
        ratio, medians, why = ratio_to_best(case)
        ratios.append(ratio)
        if ratio > 1.1:
            is_bound = " vertices to solve cost " not in why
            bound += is_bound
            print(
                f"{seed:5} {case.text}: {ratio:.2f} "
                + ", ".join(f"{key} {ms:.0f}" for key, ms in medians.items())
                + (f"; bound: {why}" if is_bound else f"; {why}"),
                flush=True,
            )
    shares = np.percentile(ratios, (50, 90, 99))
    print(
        f"{cases} mirrors, auto over the cheapest right way: median {shares[0]:.2f}, 90 of 100 under "
        f"{shares[1]:.2f}, 99 under {shares[2]:.2f}; over 1.1 on {sum(ratio > 1.1 for ratio in ratios)}, "
        f"{bound} of them the bound's"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--most-pixels", type=int, default=1280 * 960)
    parser.add_argument("--verbose", action="store_true")
    parser.add_argument("--force", action="store_true")
    parser.add_argument("--cost", action="store_true")
    options = parser.parse_args()
    require_gpu()
    if options.cost:
        print_costs(options.first, options.cases, options.most_pixels)
        return
    if options.force:
        choices.MOST_SHARE = 1e9
    over, solved = 0, 0
    for seed in range(options.first, options.first + options.cases):
        case = convex_case(seed, options.most_pixels)
        method, p99, wrong = judge(case)
        solved += method != choices.RAYS
        is_over = p99 > case.tolerance
        over += is_over
        if is_over or (options.verbose and method != choices.RAYS):
            print(
                f"{'OVER' if is_over else 'ok':5}{seed:5} {case.text}: {method}, p99 {p99:.2f} px, "
                f"{100 * wrong:.1f} % another object",
                flush=True,
            )
    print(f"{options.cases} mirrors: {solved} by reflection points, {over} over the tolerance")


if __name__ == "__main__":
    main()
