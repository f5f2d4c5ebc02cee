# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts the wrong pixels of `exact` on every kind of mirror, against every ray cast at every triangle in float64.

    .venv/bin/python tools/measure/measure_exact.py [--pixels N]

Rays that pass within a millionth of a triangle's size of its edge may go either way and are counted apart.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "tests"))

import bootstrap
import bpy  # noqa: F401  (before gpu)

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from scenes.exactness import judge  # noqa: E402
from scenes.mirror_halls import MIRRORS, hall  # noqa: E402
from scenes.views import look_at  # noqa: E402

WIDTH, HEIGHT = 320, 240


def main() -> None:
    parser = argparse.ArgumentParser(description="Counts the wrong pixels of the exact method.")
    parser.add_argument("--pixels", type=int, default=1_000_000, help="mirror pixels in all (%(default)s)")
    wanted = parser.parse_args().pixels
    require_gpu()
    totals = {name: np.zeros(3, int) for name in MIRRORS}
    seed = 0
    while sum(total[0] for total in totals.values()) < wanted:
        rng = np.random.default_rng(seed)
        eye = rng.normal(size=3)
        eye *= rng.uniform(3.0, 5.0) / np.linalg.norm(eye)
        for name, total in totals.items():
            scene = hall(name, seed, clutter=12)
            view = look_at(eye, np.zeros(3), WIDTH, HEIGHT, 0.6)
            renderer = Renderer(scene, Settings(method="exact", samples=1))
            verdict = judge(scene, view, renderer.render(view))
            renderer.free()
            total += (verdict.pixels, verdict.wrong, verdict.ties)
        seed += 1
    print(f"{'mirror':<10} {'pixels':>9} {'wrong':>6} {'edges':>6}")
    for name, total in [*totals.items(), ("all", np.sum(list(totals.values()), axis=0))]:
        print(f"{name:<10} {total[0]:>9,} {total[1]:>6} {total[2]:>6}")


if __name__ == "__main__":
    main()
