# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where following rays beats solving vertices: frames of scenes that stand still, move and deform.

    python tools/measure_methods.py --output DIR [--triangles 2000000] [--repeats 5]

A frame is what differs between the methods: following the scene (geometry, hierarchies), and what the mirror shows
(the walk of the rays; or the solve and the draw of solved triangles), not the surface buffer of what the eye sees, nor
the shading. One sub-frame, 640 x 480. Writes methods.csv, methods.png and methods.svg.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bootstrap
import bpy  # noqa: F401  (before gpu)

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer.exact import PathBuffer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.frame import Renderer, Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.gpu_objects import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.materials import Materials  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces import SurfaceBuffer, draw_primary, draw_reflected  # noqa: E402
from curvrefl.curvrefl_addon.renderer.view_block import view_block  # noqa: E402
from curvrefl.curvrefl_addon.report.benchmark_scenes import (  # noqa: E402
    deformed,
    hall,
    moved,
    view_of_mirror,
)
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays  # noqa: E402

SIZE = (640, 480)
MIRRORS = {"small": 60, "large": 300}
"""Pixels across"""
COUNTS = (1_000, 10_000, 125_000, 500_000, 2_000_000)
METHODS = ("exact", "newton", "secant_star")
KINDS = ("static", "moving", "deforming")
LONGEST_FRAME = 8.0
"""Seconds: larger scenes are left out after such a frame"""
type Change = Callable[[SceneArrays, int], SceneArrays]
CHANGES: dict[str, Change] = {
    "static": lambda scene, frame: scene,
    "moving": lambda scene, frame: moved(scene, 2, (0.02 * np.sin(frame), 0.02, 0.0)),
    "deforming": lambda scene, frame: deformed(scene, 2, 0.3 * frame),
}


class Frames:
    """One method in one scene, frame after frame."""

    def __init__(self, scene: SceneArrays, method: str, pixels: float) -> None:
        self.renderer = Renderer(scene, Settings(method=method, samples=1))
        self.scene, self.pixels, self.turn = scene, pixels, 0.0
        self.materials = Materials(scene)
        self.seen, self.shown = SurfaceBuffer(*SIZE), SurfaceBuffer(*SIZE)
        self.path = PathBuffer(*SIZE)
        self.first_ms = 1e3 * _timed(lambda: self.renderer.rays())[0] if method == "exact" else 0.0

    def frame(self, scene: SceneArrays) -> dict[str, tuple[float, float]]:
        """Wall and process seconds of each part."""
        self.turn += 0.002
        view = view_of_mirror(*SIZE, self.pixels, self.turn)
        uniforms = view_block(view)
        times = {"update": _timed(lambda: self.renderer.update(scene))}
        draw_primary(self.seen, self.renderer.geometry.seen(view), self.materials, uniforms)
        _wait(self.seen)
        mirror = self.renderer.mirrors[0]
        window = mirror.window(view)
        if self.renderer.settings.method == "exact":

            def walk() -> None:
                rays = self.renderer.rays()
                self.path.follow(self.seen, rays, self.materials, uniforms, window, False)
                _wait(self.path)

            times["show"] = _timed(walk)
            return times

        def solve_and_draw() -> None:
            reflection = self.renderer.reflect(view)
            self.shown.clear()
            parts = reflection.parts[0]
            draw_reflected(self.shown, self.seen, 1, None, parts, self.materials, uniforms, mirror.bound, window)
            _wait(self.shown)

        times["show"] = _timed(solve_and_draw)
        return times


def _wait(buffer: SurfaceBuffer) -> None:
    with buffer.frame_buffer.bind():
        buffer.frame_buffer.read_color(0, 0, 1, 1, 4, 0, "FLOAT")


def _timed(action: Callable[[], Any]) -> tuple[float, float]:
    wall, cpu = perf_counter(), process_time()
    action()
    return perf_counter() - wall, process_time() - cpu


def measure(kind: str, count: int, mirror: str, method: str, repeats: int) -> dict[str, Any]:
    """Medians of frames after the first one, milliseconds."""
    scene = hall(count, as_one=kind == "deforming")
    frames = Frames(scene, method, MIRRORS[mirror])
    try:
        if method == "exact" and kind == "static":
            # As in a viewport that has rested.
            frames.renderer.rays().finish()
        frames.frame(scene)
        results = []
        for number in range(1, repeats + 1):
            scene = CHANGES[kind](scene, number)
            results.append(frames.frame(scene))
        row: dict[str, Any] = {
            "scene": kind,
            "mirror": mirror,
            "triangles": sum(len(scene.meshes[item.mesh].triangles) for item in scene.instances[1:]),
            "method": method,
        }
        for part in ("update", "show"):
            row[f"{part}_ms"] = 1e3 * median(result[part][0] for result in results)
        row["frame_ms"] = 1e3 * median(result["update"][0] + result["show"][0] for result in results)
        row["frame_cpu_ms"] = 1e3 * median(result["update"][1] + result["show"][1] for result in results)
        row["first_build_ms"] = frames.first_ms
        return row
    finally:
        frames.renderer.free()


def crossings(rows: list[dict[str, Any]], other: str) -> list[str]:
    """Where `exact` and another method take the same time, from lines through what was measured (logarithms)."""
    lines = []
    for kind in KINDS:
        for mirror in MIRRORS:
            times = {
                method: {
                    r["triangles"]: r["frame_cpu_ms"]
                    for r in rows
                    if (r["scene"], r["mirror"], r["method"]) == (kind, mirror, method)
                }
                for method in ("exact", other)
            }
            both = sorted(set(times["exact"]) & set(times[other]))
            if not both:
                continue
            gain = [np.log(times["exact"][n] / times[other][n]) for n in both]
            found = []
            for a, b, x, y in zip(both[:-1], both[1:], gain[:-1], gain[1:], strict=True):
                if (x > 0) != (y > 0):
                    found.append(f"{np.exp(np.interp(0.0, sorted((x, y)), np.log((a, b) if x < y else (b, a)))):,.0f}")
            faster = other if gain[-1] > 0 else "exact"
            lines.append(
                f"{kind}, {mirror} mirror: "
                + (f"the lines cross at {', '.join(found)} triangles; beyond " if found else "everywhere ")
                + f"{faster} is faster than {other if faster == 'exact' else 'exact'}"
            )
    return lines


def draw(rows: list[dict[str, Any]], folder: Path) -> None:
    """methods.png and methods.svg"""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(2, 3, figsize=(12.0, 7.0), sharex=True, sharey=True, layout="constrained")
    styles = {"exact": ("#CC6677", "o"), "newton": ("#332288", "s"), "secant_star": ("#000000", "^")}
    for row, mirror in enumerate(MIRRORS):
        for column, kind in enumerate(KINDS):
            panel = panels[row][column]
            for method, (color, marker) in styles.items():
                chosen = [r for r in rows if (r["scene"], r["mirror"], r["method"]) == (kind, mirror, method)]
                counts = [r["triangles"] for r in chosen]
                panel.loglog(counts, [r["frame_cpu_ms"] for r in chosen], color=color, marker=marker, label=method)
            panel.set_title(f"{kind}, mirror {MIRRORS[mirror]} pixels across", fontsize=10)
            panel.grid(True, which="major", color="#DDDDDD")
            panel.set_xlabel("triangles" if row else "")
            panel.set_ylabel("processor time, ms" if column == 0 else "")
    panels[0][0].legend()
    figure.savefig(folder / "methods.png", dpi=100)
    figure.savefig(folder / "methods.svg")


def main() -> None:
    """Measure, write and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--triangles", type=int, default=COUNTS[-1], help="of the largest scene (%(default)s)")
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    require_gpu()
    options.output.mkdir(parents=True, exist_ok=True)
    rows: list[dict[str, Any]] = []
    for kind in KINDS:
        for mirror in MIRRORS:
            for method in METHODS:
                for count in [n for n in COUNTS if n <= options.triangles]:
                    row = measure(kind, count, mirror, method, options.repeats)
                    rows.append(row)
                    print(
                        f"{kind:10}{mirror:6}{row['triangles']:>10,} {method:12} update {row['update_ms']:8.1f}  "
                        f"show {row['show_ms']:8.1f}  cpu {row['frame_cpu_ms']:8.1f} ms",
                        flush=True,
                    )
                    if row["frame_ms"] > 1e3 * LONGEST_FRAME:
                        break
    with (options.output / "methods.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    draw(rows, options.output)
    for other in METHODS[1:]:
        print("\n".join(crossings(rows, other)))


if __name__ == "__main__":
    main()
