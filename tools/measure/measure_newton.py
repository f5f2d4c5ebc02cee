# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints how the GPU's `newton` does around smooth convex mirrors, cold and warm, beside `secant_star`.

python tools/measure/measure_newton.py [--cases N] [--map TEXELS] [--methods newton,secant_star]

Every case is made from its reflection point, or from the point where the segment to it enters the mirror: on a convex
mirror there is no other answer, so that no search is needed for the truth. Regimes: `study/solvers/regimes.py`.
Rows are shapes, regimes and eyes over all others of them. Wrong is what is more than half a pixel off its point,
whatever it was called. A tie is called hidden though shown, or the other way round, with the point in its place: the
horizon runs between.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import bpy  # noqa: F401  (before the package)
import numpy as np

bootstrap.load_package()

from curvrefl.curvrefl_addon.optics import status  # noqa: E402
from curvrefl.curvrefl_addon.optics.fermat import sample, towards_eye  # noqa: E402
from curvrefl.curvrefl_addon.optics.screen import Screen  # noqa: E402
from curvrefl.curvrefl_addon.optics.surfaces.radial_surfaces import Bumpy, Ellipsoid, Float64Array, RadialSurface, unit  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.study.solvers.solver_table import OFF, study_view  # noqa: E402
from curvrefl.curvrefl_addon.study.solvers.study_reflector import StudyReflector  # noqa: E402
from curvrefl.curvrefl_addon.study.solvers.study_surfaces import Study  # noqa: E402

SCALES = (1e-4, 1.0, 1e4)
EYES = {"usual": (4.1, (2.3, -2.9, 1.8)), "close": (1.03, (0.3, -0.4, 1.1)), "far": (30.0, (-1.7, 0.6, -0.9))}
"""Distances in the mirror's radii there, and directions"""
REGIMES = ("far", "near", "contact", "grazing", "silhouette", "axis, corner, pole", "hidden")
MOVED = 0.009
"""Of the eye's distance from the center, or from the surface where it is close, that it moves before a warm solve"""
REPEATS = 5
TIMED = 1 << 18
MOST_TRIES = 60


def shapes(scale: float) -> dict[str, RadialSurface]:
    return {
        "sphere": Ellipsoid(scale, scale, scale),
        "ellipsoid 2:1:0.5": Ellipsoid(scale, 0.5 * scale, 0.25 * scale),
        "ellipsoid 1:0.6:0.4": Ellipsoid(scale, 0.6 * scale, 0.4 * scale),
        "mild bumps": Bumpy(0.03, scale),
    }


def special_directions(random: np.random.Generator, count: int) -> Float64Array:
    """Axes, edges and corners of the cube, exactly."""
    grid = np.array(np.meshgrid(*[[-1.0, 0.0, 1.0]] * 3, indexing="ij")).reshape(3, -1).T
    chosen = unit(grid[np.abs(grid).sum(axis=1) > 0.0])
    return chosen[random.integers(len(chosen), size=count)]


def make_cases(
    surface: RadialSurface, eye: Float64Array, regime: str, count: int, random: np.random.Generator
) -> tuple[Float64Array, Float64Array]:
    """Vertices (n, 3) exact in float32, and their points P (n, 3)."""
    found: list[tuple[Float64Array, ...]] = []
    total = 0
    # An eye close to the mirror may see no corner of the cube at all.
    for _ in range(MOST_TRIES):
        if total >= count:
            break
        size = 8 * count
        u = unit(random.normal(size=(size, 3))) if regime != "axis, corner, pole" else special_directions(random, size)
        at = sample(surface, u)
        to_eye = towards_eye(eye, at.position)
        cosine = np.einsum("ij,ij->i", at.normal, to_eye)
        ray = 2.0 * cosine[:, None] * at.normal - to_eye
        distance = np.exp(random.uniform(np.log(0.1), np.log(3.0), size))
        kept = cosine > 1e-4
        if regime == "far":
            distance = np.exp(random.uniform(np.log(10.0), np.log(100.0), size))
        elif regime == "contact":
            distance = np.exp(random.uniform(np.log(1e-3), np.log(2e-2), size)) / np.maximum(cosine, 0.05)
            kept = cosine > 0.05
        elif regime == "grazing":
            kept = (cosine > 0.02) & (cosine < 0.17)
        elif regime == "silhouette":
            kept = (cosine > 1e-4) & (cosine < 0.02)
        elif regime == "hidden":
            ray, distance = -to_eye, np.exp(random.uniform(np.log(1e-2), np.log(10.0), size))
        rows = np.flatnonzero(kept)[: count - total]
        found.append((at.position[rows] + (surface.bound * distance[rows])[:, None] * ray[rows], at.position[rows]))
        total += len(rows)
    vertices, points = (np.concatenate(part) for part in zip(*found, strict=True))
    return vertices.astype(np.float32).astype(np.float64), points


@dataclass
class Tally:
    """Sums over batches of one method, cold or warm."""

    cases: int = 0
    ties: int = 0
    wrong: int = 0
    unsolved: int = 0
    errors: list[Float64Array] = field(default_factory=list)
    iterations: list[Float64Array] = field(default_factory=list)

    def add(
        self,
        regime: str,
        error: Float64Array,
        code: np.ndarray,
        iterations: np.ndarray,
        counted: np.ndarray,
    ) -> None:
        """`counted` (n,) are those whose iterations count."""
        self.cases += len(code)
        expected = status.HIDDEN if regime == "hidden" else status.REFLECTED
        solved = code < status.UNSOLVED
        # Where the segment pierces the mirror is found to less than the mirror image there needs.
        off = (error > OFF) & ((code == status.REFLECTED) | (expected == status.REFLECTED))
        self.wrong += int((solved & off).sum())
        self.ties += int((solved & ~off & (code != expected)).sum())
        self.unsolved += int((~solved).sum())
        both = (code == status.REFLECTED) & (regime != "hidden")
        self.errors.append(error[both])
        self.iterations.append(iterations[both & counted].astype(np.float64))

    def line(self) -> str:
        error = np.concatenate(self.errors) if self.errors else np.zeros(0)
        steps = np.concatenate(self.iterations) if self.iterations else np.zeros(0)
        p50, p99, p9999, worst = np.percentile(error, [50, 99, 99.99, 100]) if len(error) else [np.nan] * 4
        mean, most = (steps.mean(), np.percentile(steps, 99)) if len(steps) else (np.nan, np.nan)
        return (
            f"{self.cases:9} {self.ties:6} {self.wrong:6} {self.unsolved:8}  {p50:8.5f} {p99:8.4f} {p9999:8.4f} "
            f"{worst:8.4f}  {mean:6.2f} {most:4.0f}"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=1_050_000)
    parser.add_argument("--map", type=int, default=256, help="texels along an edge of the radial map")
    parser.add_argument("--methods", default="newton,secant_star")
    options = parser.parse_args()
    names = [f"{name} cold" for name in options.methods.split(",")] + ["newton warm"]
    combinations = len(shapes(1.0)) * len(SCALES) * len(EYES) * len(REGIMES)
    wanted = -(-options.cases // combinations)
    tallies: dict[tuple[str, str], Tally] = {}
    for scale in SCALES:
        for shape, surface in shapes(scale).items():
            reflector = StudyReflector(Study(surface, (2.3, -2.9, 1.8)), options.map)
            for eye_number, (eye_name, (distance, direction)) in enumerate(EYES.items()):
                axis = unit(np.array([direction]))
                eye = np.append(distance * surface.radius(axis)[0] * axis[0], 1.0)
                before = eye.copy()
                away = (distance - 1.0 if eye_name == "close" else distance) * surface.radius(axis)[0][0]
                before[:2] += MOVED * away * unit(np.array([[-eye[1], eye[0]]]))[0]
                view, view_before = study_view(eye), study_view(before)
                screen = Screen(eye, view.focal_pixels)
                for regime_number, regime in enumerate(REGIMES):
                    seed = [list(shapes(1.0)).index(shape), eye_number, regime_number]
                    vertices, points = make_cases(surface, eye, regime, wanted, np.random.default_rng(seed))
                    if len(vertices) == 0:
                        continue
                    previous = reflector.solve("newton", view_before, Settings(method="newton"), vertices)
                    started = previous.read()[1] == status.REFLECTED
                    for name in names:
                        method, kind = name.split()
                        start = previous if kind == "warm" else None
                        solution = reflector.solve(method, view, Settings(method=method), vertices, start)
                        found, code, iterations, _ = solution.read()
                        error = np.linalg.norm(screen.pixels(points, found.astype(np.float64) - points), axis=1)
                        for key in (shape, regime, eye_name + " eye", "all"):
                            tallies.setdefault((key, name), Tally()).add(
                                regime, error, code, iterations, started | (kind == "cold")
                            )
    print(f"{options.map} texels along an edge of the map; scales {', '.join(f'{scale:g}' for scale in SCALES)}")
    print(f"{'':35}    cases   ties  wrong unsolved  px: p50      p99   p99.99      max  steps  p99")
    for (key, name), tally in sorted(tallies.items(), key=lambda item: (item[0][0] == "all", item[0])):
        print(f"{key:20} {name:16}{tally.line()}")
    print(f"\nMilliseconds per million vertices, {TIMED} of all regimes in one solve, median of {REPEATS}:")
    for shape, surface in shapes(1.0).items():
        times = measure_times(surface, options.map, names)
        print(f"  {shape:20} " + "   ".join(f"{name} {time:.0f}" for name, time in times.items()))


def measure_times(surface: RadialSurface, texels: int, names: list[str]) -> dict[str, float]:
    reflector = StudyReflector(Study(surface, (2.3, -2.9, 1.8)), texels)
    eye = np.array([2.3, -2.9, 1.8, 1.0])
    before = eye.copy()
    before[:2] += MOVED * np.linalg.norm(eye[:3]) * unit(np.array([[-eye[1], eye[0]]]))[0]
    random = np.random.default_rng(0)
    vertices = np.concatenate(
        [make_cases(surface, eye, regime, TIMED // len(REGIMES), random)[0] for regime in REGIMES]
    )
    previous = reflector.solve("newton", study_view(before), Settings(method="newton"), vertices)
    solvers = {name: reflector.solver(name.split()[0], Settings(method=name.split()[0]), vertices) for name in names}
    times: dict[str, list[float]] = {name: [] for name in names}
    for repeat in range(REPEATS + 1):
        for name in names:
            begin = perf_counter()
            solvers[name](study_view(eye), previous if name.endswith("warm") else None).wait()
            if repeat > 0:
                times[name].append(1e9 * (perf_counter() - begin) / len(vertices))
    return {name: float(np.median(values)) for name, values in times.items()}


if __name__ == "__main__":
    main()
