# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where following rays beats solving vertices: frames of scenes that stand still, move and deform.

    python tools/measure/measure_methods.py --output DIR [--counts 1000,..] [--pixels 60,300] [--kinds static,..]
        [--repeats 5]
    python tools/measure/measure_methods.py --output DIR --draw-only

A frame is what differs between the methods: following the scene (geometry, hierarchies), and what the mirror shows
(the walk of the rays; or the solve and the draw of solved triangles), not the surface buffer of what the eye sees, nor
the shading. One sub-frame, 640 x 480. `footprint` is no method of the extension: see footprints/. The methods take
turns, frame by frame. Writes methods.csv as it goes, then methods.png and methods.svg.
"""

from __future__ import annotations

import argparse
import csv
import os
import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import Any

# (numpy's products of small matrices go faster alone than in threads that wait for each other on a busy machine)
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import bpy  # noqa: F401  (before gpu)

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.measured.hall import THINGS, hall, view_of_mirror  # noqa: E402
from curvrefl.curvrefl_addon.renderer.rays.paths import IN_THE_OPEN, PathBuffer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.reflection import Reflection  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.materials import Materials  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.primary import draw_primary  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.surface_buffer import SurfaceBuffer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.view_block import view_block  # noqa: E402
from curvrefl.curvrefl_addon.renderer.vertices.reflected import draw_reflected  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays  # noqa: E402
from curvrefl.curvrefl_addon.study.benchmark.scenes import deformed, moved  # noqa: E402
from footprints.method import Footprints  # noqa: E402

SIZE = (640, 480)
PIXELS = (60, 300)
"""Mirrors, pixels across"""
COUNTS = (1_000, 10_000, 125_000, 500_000, 2_000_000)
METHODS = ("exact", "newton", "secant_star", "footprint")
KINDS = ("static", "moving", "deforming")
LONGEST_FRAME = 8.0
"""Seconds: a method is left out of larger scenes after such a frame"""
LONGEST_ROUNDS = 20.0
"""Seconds: no further round of frames begins after so long"""
NUMBERS = ("update_ms", "show_ms", "frame_ms", "update_cpu_ms", "show_cpu_ms", "frame_cpu_ms", "first_build_ms")
COLUMNS = ("scene", "mirror", "triangles", "method", "repeats", *NUMBERS)
type Change = Callable[[SceneArrays, int], SceneArrays]
CHANGES: dict[str, Change] = {
    "static": lambda scene, frame: scene,
    "moving": lambda scene, frame: moved(scene, 2, (0.02 * np.sin(frame), 0.02, 0.0)),
    "deforming": lambda scene, frame: deformed(scene, 2, 0.3 * frame),
}
type Times = dict[str, tuple[float, float]]


class Frames:
    """One method in one scene, frame after frame."""

    def __init__(self, scene: SceneArrays, method: str) -> None:
        self.method, self.turn = method, 0.0
        self.renderer = Renderer(scene, Settings(method="newton" if method == "footprint" else method, samples=1))
        self.materials = Materials(scene)
        self.footprints = Footprints(self.renderer, self.materials)
        self.seen, self.shown = SurfaceBuffer(*SIZE), SurfaceBuffer(*SIZE)
        self.path = PathBuffer(*SIZE)
        self.last: Reflection | None = None
        """Of the frame before, where solving starts"""
        self.first_ms = 1e3 * _timed(lambda: self.renderer.rays())[0] if method == "exact" else 0.0

    def frame(self, scene: SceneArrays, pixels: float) -> Times:
        """Wall and process seconds of each part, with a mirror of so many pixels."""
        self.turn += 0.002
        view = view_of_mirror(*SIZE, pixels, self.turn)
        uniforms = view_block(view)
        times = {"update": _timed(lambda: self.renderer.update(scene))}
        draw_primary(self.seen, self.renderer.geometry.seen(view), self.materials, uniforms)
        self.seen.wait()
        mirror = self.renderer.mirrors[0]
        window = mirror.window(view)

        def walk() -> None:
            rays = self.renderer.rays()
            self.path.follow(self.seen, rays, self.materials, uniforms, window, IN_THE_OPEN)
            self.path.wait()

        def bound_and_draw() -> None:
            self.footprints.draw(self.shown, self.seen, view, uniforms)
            self.shown.wait()

        def solve_and_draw() -> None:
            reflection = self.last = self.renderer.reflect(view, last=self.last)
            self.shown.clear()
            parts, bound = reflection.parts[0], mirror.shape(self.renderer.settings.map_resolution).bound
            draw_reflected(self.shown, self.seen, 1, None, parts, self.materials, uniforms, bound, window)
            self.shown.wait()

        times["show"] = _timed({"exact": walk, "footprint": bound_and_draw}.get(self.method, solve_and_draw))
        return times


def _timed(action: Callable[[], Any]) -> tuple[float, float]:
    wall, cpu = perf_counter(), process_time()
    action()
    return perf_counter() - wall, process_time() - cpu


def measure(
    kind: str, count: int, things: int, mirrors: list[int], methods: list[str], repeats: int
) -> list[dict[str, Any]]:
    """A row per mirror, in pixels, and method: medians of frames after the first one, milliseconds."""
    scene = hall(count, things, as_one=kind == "deforming")
    triangles = sum(len(scene.meshes[item.mesh].triangles) for item in scene.instances[1:])
    runs = {method: Frames(scene, method) for method in methods}
    rows = []
    try:
        if "exact" in runs:
            # As in a viewport that has rested before.
            runs["exact"].renderer.rays().finish()
        number = 0
        for pixels in mirrors:
            results: dict[str, list[Times]] = {method: [] for method in methods}
            for method in methods:
                runs[method].frame(scene, pixels)
            start = perf_counter()
            for _ in range(repeats):
                number += 1
                scene = CHANGES[kind](scene, number)
                for method in methods:
                    results[method].append(runs[method].frame(scene, pixels))
                if perf_counter() - start > LONGEST_ROUNDS:
                    break
            for method in methods:
                row = {"scene": kind, "mirror": pixels, "triangles": triangles, "method": method}
                rows.append(row | _medians(results[method]) | {"first_build_ms": runs[method].first_ms})
        return rows
    finally:
        for run in runs.values():
            run.renderer.free()


def _medians(results: list[Times]) -> dict[str, Any]:
    row: dict[str, Any] = {"repeats": len(results)}
    for clock, unit in enumerate(("ms", "cpu_ms")):
        for part in ("update", "show"):
            row[f"{part}_{unit}"] = 1e3 * median(result[part][clock] for result in results)
        row[f"frame_{unit}"] = 1e3 * median(result["update"][clock] + result["show"][clock] for result in results)
    return row


def crossings(rows: list[dict[str, Any]], other: str) -> list[str]:
    """Where `exact` and another method take the same time, from lines through what was measured (logarithms)."""
    lines = []
    for kind in KINDS:
        for mirror in sorted({row["mirror"] for row in rows}):
            exact, times = (dict(curve(rows, kind, mirror, method)) for method in ("exact", other))
            both = sorted(set(exact) & set(times))
            if not both:
                continue
            gain = [np.log(exact[n] / times[n]) for n in both]
            found = []
            for a, b, x, y in zip(both[:-1], both[1:], gain[:-1], gain[1:], strict=True):
                if (x > 0) != (y > 0):
                    found.append(f"{np.exp(np.log(a) + x / (x - y) * np.log(b / a)):,.0f}")
            faster = other if gain[-1] > 0 else "exact"
            lines.append(
                f"{kind}, mirror of {mirror} pixels: "
                + (f"the lines cross at {', '.join(found)} triangles; beyond " if found else "everywhere ")
                + f"{faster} is faster than {other if faster == 'exact' else 'exact'}"
            )
    return lines


def curve(rows: list[dict[str, Any]], kind: str, mirror: int, method: str) -> list[tuple[int, float]]:
    """(triangles, processor milliseconds of a frame)"""
    return [
        (row["triangles"], row["frame_cpu_ms"])
        for row in rows
        if (row["scene"], row["mirror"], row["method"]) == (kind, mirror, method)
    ]


def draw(rows: list[dict[str, Any]], folder: Path) -> None:
    """methods.png and methods.svg"""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    mirrors = sorted({row["mirror"] for row in rows})
    figure, panels = pyplot.subplots(
        len(mirrors),
        len(KINDS),
        figsize=(12.0, 3.5 * len(mirrors)),
        sharex=True,
        sharey=True,
        layout="constrained",
        squeeze=False,
    )
    styles = {
        "exact": ("#CC6677", "o", "-"),
        "newton": ("#332288", "s", "-"),
        "secant_star": ("#000000", "^", "-"),
        "footprint": ("#117733", "D", "--"),
    }
    for row, mirror in enumerate(mirrors):
        for column, kind in enumerate(KINDS):
            panel = panels[row][column]
            for method, (color, marker, line) in styles.items():
                points = curve(rows, kind, mirror, method)
                panel.loglog(
                    *zip(*points, strict=True) if points else ((), ()), line, color=color, marker=marker, label=method
                )
            panel.set_title(f"{kind}, mirror {mirror} pixels across", fontsize=10)
            panel.grid(True, which="major", color="#DDDDDD")
            panel.set_xlabel("triangles" if row == len(mirrors) - 1 else "")
            panel.set_ylabel("a frame's processor time, ms" if column == 0 else "")
    panels[0][0].legend()
    figure.savefig(folder / "methods.png", dpi=100)
    figure.savefig(folder / "methods.svg")


def read(path: Path) -> list[dict[str, Any]]:
    """Rows of methods.csv."""
    with path.open(newline="", encoding="utf-8") as file:
        return [
            row
            | {name: float(row[name]) for name in NUMBERS}
            | {name: int(row[name]) for name in ("mirror", "triangles")}
            for row in csv.DictReader(file)
        ]


def main() -> None:
    """Measure, write and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--counts", type=_numbers, default=COUNTS, help="triangles of the scenes, about")
    parser.add_argument("--things", type=int, default=THINGS, help="objects of a scene (%(default)s)")
    parser.add_argument("--pixels", type=_numbers, default=PIXELS, help="widths of the mirrors")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--kinds", default=",".join(KINDS), help="(%(default)s)")
    parser.add_argument("--methods", default=",".join(METHODS), help="(%(default)s)")
    parser.add_argument("--draw-only", action="store_true", help="of the methods.csv that is there")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    path = options.output / "methods.csv"
    if not options.draw_only:
        require_gpu()
        with path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            for kind in options.kinds.split(","):
                methods = options.methods.split(",")
                for count in options.counts:
                    rows = measure(kind, count, options.things, options.pixels, methods, options.repeats)
                    writer.writerows(rows)
                    file.flush()
                    for row in rows:
                        print(_line(row), flush=True)
                    slow = {row["method"] for row in rows if row["frame_ms"] > 1e3 * LONGEST_FRAME}
                    methods = [method for method in methods if method not in slow]
    rows = read(path)
    draw(rows, options.output)
    for other in METHODS[1:]:
        print("\n".join([other, *crossings(rows, other)]))


def _numbers(text: str) -> list[int]:
    return [int(part) for part in text.split(",")]


def _line(row: dict[str, Any]) -> str:
    return (
        f"{row['scene']:10}{row['mirror']:4}{row['triangles']:>10,} {row['method']:12} update {row['update_ms']:8.1f}  "
        f"show {row['show_ms']:8.1f}  cpu {row['frame_cpu_ms']:8.1f} ms"
    )


if __name__ == "__main__":
    main()
