# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Six different mirrors in one view: what the first step of their rays costs, and so what any other way could save.

    python tools/measure/measure_mirrors.py [--size 640x480] [--repeats 9] [--picture FILE.png]

A sphere, a bevelled slab, a torus, a bowl, a flat mirror and a vase, among cubes. Every mirror is seen in others, so
what they show has to be followed on from mirror to mirror, and points of one mirror can take the place of the first
step of its rays alone. *Bound* is the frame's time over that without the first step: no way for each mirror can be
faster than that, even if it cost nothing. The second bound leaves the first step to the torus, the bowl and the vase,
which show points several times, by their share of the mirrors' pixels. Processor milliseconds, least of the repeats.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from time import process_time
from typing import Any
from unittest.mock import patch

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "tests"))

import bootstrap

bootstrap.load_package()

import bpy  # noqa: E402, F401
import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.rays.paths import PathBuffer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.report.images import save_png  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from scenes.six_mirrors import MIRROR_NAMES, six_mirrors, six_mirrors_view  # noqa: E402


def frame_and_steps(renderer: Renderer, view: View) -> tuple[float, list[float]]:
    """Processor milliseconds of a picture, and of each step of its rays; each step waits for the GPU."""
    steps: list[float] = []
    follow = PathBuffer.follow

    def timed(path: PathBuffer, *arguments: Any, **named: Any) -> None:
        renderer_targets = arguments[0]
        renderer_targets.wait()
        start = process_time()
        follow(path, *arguments, **named)
        path.wait()
        steps.append(1e3 * (process_time() - start))

    with patch.object(PathBuffer, "follow", timed):
        start = process_time()
        renderer.render(view)
        return 1e3 * (process_time() - start), steps


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--picture", type=Path)
    options = parser.parse_args()
    require_gpu()
    width, height = map(int, options.size.split("x"))
    scene, view = six_mirrors(), six_mirrors_view(width, height)
    for method in ("exact", "auto"):
        renderer = Renderer(scene, Settings(method=method, samples=1))
        frame = renderer.render(view)
        renderer.hierarchies.finish()
        runs = [frame_and_steps(renderer, view) for _ in range(options.repeats)]
        total = min(run[0] for run in runs)
        steps = np.min([run[1] for run in runs], axis=0) if runs[0][1] else np.zeros(1)
        mask = frame.mask()
        share = np.isin(mask, (1, 2, 5)).sum() / (mask > 0).sum()
        bounds = [total / (total - part * steps[0]) for part in (1.0, share)]
        print(f"{method}: {dict(zip(MIRROR_NAMES, frame.reflection.methods, strict=True))}")
        print(
            f"  frame {total:.0f} ms, steps of the rays {', '.join(f'{ms:.0f}' for ms in steps)}; "
            f"bound {bounds[0]:.2f}, {bounds[1]:.2f} without sphere, slab and flat ({100 * share:.0f} % of the pixels)"
        )
        if options.picture:
            save_png(options.picture, frame.color()[..., :3])
        renderer.free()


if __name__ == "__main__":
    main()
