# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints how well the float64 solver does around three shapes, and what its secant search alone would leave.

python tools/measure/measure_solver.py [--vertices N]
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import bpy  # noqa: F401  (before the package)
import numpy as np

bootstrap.load_package()

from curvrefl.curvrefl_addon.optics import status  # noqa: E402
from curvrefl.curvrefl_addon.optics.fermat import sample  # noqa: E402
from curvrefl.curvrefl_addon.optics.screen import Screen  # noqa: E402
from curvrefl.curvrefl_addon.optics.solvers import secant_star  # noqa: E402
from curvrefl.curvrefl_addon.optics.surfaces import sphere  # noqa: E402
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, RadialSurface, unit  # noqa: E402

SHAPES: dict[str, RadialSurface] = {
    "sphere": Ellipsoid(),
    "ellipsoid 2:1:0.5": Ellipsoid(1.0, 0.5, 0.25),
    "bumpy": Bumpy(0.15),
}
EYE = np.array([2.3, -2.9, 1.8, 1.0])
FOCAL = 240 / np.tan(np.radians(20))
"""Pixels: 480 rows at 40 degrees"""
LONG_SEARCH, FINE_TOLERANCE = 60, 0.1
"""Steps and pixels that the search alone is given: it cannot complain"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vertices", type=int, default=6000)
    count = parser.parse_args().vertices
    screen = Screen(EYE, FOCAL)
    print(f"{count} vertices at 0.01 to 10 R, eye at {np.linalg.norm(EYE[:3]):.1f} R, {FOCAL:.0f} pixels focal length")
    print(f"{'':18} search alone off   unsolved   iterations mean   p99")
    for name, surface in SHAPES.items():
        rng = np.random.default_rng(1)
        u = unit(rng.normal(size=(count, 3)))
        vertices = u * (surface.radius(u)[0] + 10 ** rng.uniform(-2, 1, count))[:, None]
        solved = secant_star.solve(surface, screen, vertices)
        reflected = solved.status == status.REFLECTED
        alone, _ = secant_star.secant_search(surface, screen, vertices, LONG_SEARCH, FINE_TOLERANCE)
        error = np.linalg.norm(
            screen.pixels(solved.at.position, sample(surface, alone).position - solved.at.position), axis=1
        )
        print(
            f"{name:18} {(error[reflected] > 0.5).mean():15.1%} {(solved.status == status.UNSOLVED).mean():10.2%} "
            f"{solved.iterations[reflected].mean():17.1f} {np.percentile(solved.iterations[reflected], 99):5.0f}"
        )
        if name == "sphere":
            truth = sphere.reflection_points(EYE[:3], vertices, 1.0)
            expected = np.isfinite(truth[:, 0])
            both = expected & reflected
            worst = np.linalg.norm(screen.pixels(truth[both], solved.at.position[both] - truth[both]), axis=1).max()
            print(
                f"{'':18} against the quartic: at most {worst:.4f} pixels off, {(expected & ~reflected).sum()} missed, "
                f"{(reflected & ~expected).sum()} hidden ones called reflected"
            )


if __name__ == "__main__":
    main()
