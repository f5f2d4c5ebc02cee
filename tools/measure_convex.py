# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether `auto` keeps its word: random closed convex mirrors, its picture beside `exact`, pixel by pixel.

    python tools/measure_convex.py [--cases 1000] [--first 0] [--most-pixels 1228800] [--verbose] [--force]

A case is over its tolerance where the 99th percentile of the errors of the mirror's pixels is. `--force` takes
reflection points wherever the choice by cost alone would not: the bound must hold there too.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

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


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--most-pixels", type=int, default=1280 * 960)
    parser.add_argument("--verbose", action="store_true")
    parser.add_argument("--force", action="store_true")
    options = parser.parse_args()
    require_gpu()
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
