# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All that is asked of a graphics card, in one run of under ten minutes: proofs, costs, solves, rays, frames, choices.

    python tools/measure/measure_device.py --output DIR [--vertices 1000000] [--triangles 125000]
        [--frame-triangles 100000] [--size 1920x1080] [--seconds 540]

On a machine without a window, Blender as a module needs a driver with EGL. Each part is printed and written to DIR as
soon as it is there, so that a run that is stopped leaves what it has. A part that fails says so, and the next one
begins; none begins after so many seconds. Times are milliseconds by the clock.

1. *Proofs*: whether the device's results are right, and what goes another way.
2. *Costs*: what `auto` counts with, measured three times, beside those that ship.
3. *Solves*: `newton` cold, warm and still, and the draw of what was solved, per million vertices.
4. *Rays*: of a mirror of 300 pixels among so many triangles, per second.
5. *Frames*: whole pictures of a view that moves, one sub-frame each, and their parts: the solve, and what is drawn;
   *python* is until all is asked for.
6. *Passes*: what the eye sees, walk, draw and solve apart, of many between two waits.
7. *Choices*: what `auto` takes in halls, by both tables, beside the times of both ways.
"""

from __future__ import annotations

import argparse
import json
import sys
import traceback
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import bpy  # noqa: F401  (before gpu)

bootstrap.load_package()

from curvrefl.curvrefl_addon.renderer.costs.table import NAMES, SHIPPED, Costs  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import platform_facts, require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.measured.hall import hall, view_of_mirror  # noqa: E402
from curvrefl.curvrefl_addon.renderer.measured.hall_passes import HallPasses  # noqa: E402
from curvrefl.curvrefl_addon.renderer.proofs.proving import prove_all  # noqa: E402
from curvrefl.curvrefl_addon.renderer.proofs.report import summary  # noqa: E402
from curvrefl.curvrefl_addon.renderer.proofs.verdict import take_verdict  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas  # noqa: E402
from curvrefl.curvrefl_addon.study.benchmark.rays import measure_rays  # noqa: E402
from curvrefl.curvrefl_addon.study.benchmark.solves import STATES, measure_solves  # noqa: E402
from measure_auto import TALL, Case, measure, measured_costs  # noqa: E402

HALLS = (400, 8_000, 125_000)
SIZES = ((640, 480), (1920, 1080))
TURN = 0.002
"""Of the eye between two frames, radians"""
type Part = Callable[[dict[str, Any]], Any]


def proofs(_found: dict[str, Any]) -> dict[str, Any]:
    """What the device gets right, and use what it says."""
    proving = prove_all()
    take_verdict(proving.verdict)
    print(summary(proving.verdict))
    return {"proofs": proving.found, **proving.verdict.as_json()}


def costs(_found: dict[str, Any]) -> dict[str, float]:
    """Medians of three, and how long a run takes."""
    start = perf_counter()
    measured_costs(1, perf_counter)
    first = perf_counter() - start
    start = perf_counter()
    found = asdict(measured_costs(3, perf_counter))
    print(f"a run of {first:.2f} s with its shaders, {(perf_counter() - start) / 3.0:.2f} s without")
    for name, cost in found.items():
        print(f"{name:28}{cost:>12.4g}{getattr(SHIPPED, name):>12.4g}")
    return found


def solves(vertices: int, _found: dict[str, Any]) -> list[dict[str, Any]]:
    """Of `newton` alone."""
    rows = []
    for row in measure_solves((vertices,), _say):
        if row["method"] != "newton":
            break
        rows.append(row)
        if row["left_out"]:
            print(f"left out: {row['left_out']}")
            continue
        million = 1e6 / row["solved"]
        times = ", ".join(f"{state} {row[f'{state}_ms'] * million:.3f}" for state in STATES)
        print(f"{row['solved']:,} vertices: solve {times}; draw {row['draw_ms'] * million:.3f} ms a million")
    return rows


def rays(triangles: int, _found: dict[str, Any]) -> list[dict[str, Any]]:
    """With hierarchies as they are at first, and at rest."""
    rows = list(measure_rays((triangles,), _say))
    for row in rows:
        if row["left_out"]:
            print(f"left out: {row['left_out']}")
            continue
        for state in ("quick", "best"):
            rate, time = row[f"{state}_rays_per_second"], row[f"{state}_ms"]
            print(
                f"{row['in_scene']:,} triangles, {state}: {row['rays']:,} rays in {time:.3f} ms, {1e-9 * rate:.3f} G/s"
            )
    return rows


def frames(triangles: int, size: tuple[int, int], seconds: float, _found: dict[str, Any]) -> list[dict[str, Any]]:
    """Of `exact`, `newton` and `auto`; medians."""
    rows = []
    scene = hall(triangles)
    count = sum(len(scene.meshes[item.mesh].triangles) for item in scene.instances)
    print(f"{count:,} triangles, {size[0]} x {size[1]}, milliseconds")
    for method in ("exact", "newton", "auto"):
        renderer = Renderer(scene, Settings(method=method, samples=1))
        try:
            rows.append({"method": method, "triangles": count} | _frame_times(renderer, size, seconds / 3.0))
        finally:
            renderer.free()
        cells = ", ".join(f"{name} {value:.3f}" for name, value in rows[-1].items() if isinstance(value, float))
        print(f"{method:8} {rows[-1]['shown by']:8} {cells}", flush=True)
    return rows


def _frame_times(renderer: Renderer, size: tuple[int, int], seconds: float) -> dict[str, Any]:
    """Of a view that moves a little in each frame: whole, and taken apart, where each part waits for the GPU."""
    views = [view_of_mirror(*size, TALL * size[1], turn) for turn in (0.0, TURN)]
    canvas = Canvas.of_size(*size)
    last = None
    times: dict[str, list[float]] = {"frame": [], "solve": [], "draw and shade": [], "python": []}
    for index in range(3):
        last = renderer.reflect(views[index % 2], last=last)
        renderer.add_sub_frame(canvas, last, 0, 1.0)
        canvas.wait()
    renderer.settle()
    begin, number = perf_counter(), 0
    while perf_counter() - begin < seconds and number < 60:
        number += 1
        start = perf_counter()
        last = renderer.reflect(views[number % 2], last=last)
        if number % 2:
            last.wait()
            solved = perf_counter()
            times["solve"].append(1e3 * (solved - start))
        renderer.add_sub_frame(canvas, last, 0, 1.0)
        asked = perf_counter()
        canvas.wait()
        done = perf_counter()
        if number % 2:
            times["draw and shade"].append(1e3 * (done - solved))
        else:
            times["frame"].append(1e3 * (done - start))
            times["python"].append(1e3 * (asked - start))
    assert last is not None
    medians = {name: median(found) for name, found in times.items() if found}
    return {"shown by": "+".join(dict.fromkeys(last.methods)), **medians}


def passes(size: tuple[int, int], triangles: int, _found: dict[str, Any]) -> dict[str, float]:
    """What the eye sees, walk and draw apart, each the mean of many between two waits."""
    one = HallPasses(triangles)
    try:
        one.look(max(size))
        one.see()
        parts = one.reflect().parts[0]
        one.wait_for_points()
        one.renderer.settle()
        times = {}
        for name, act, target in (
            ("seen", one.see, one.seen),
            ("walk", one.walk, one.path),
            ("draw", partial(one.draw, parts), one.shown),
            ("solve", one.reflect, None),
        ):
            wait = one.wait_for_points if target is None else target.wait
            act()
            wait()
            start = perf_counter()
            for _ in range(20):
                act()
            wait()
            times[name] = 1e3 * (perf_counter() - start) / 20.0
        pixels = one.mirror_pixels()
        print(f"{one.triangles:,} triangles, {max(size)} x {max(size)}, {pixels:,} mirror pixels: ", end="")
        print(", ".join(f"{name} {time:.3f} ms" for name, time in times.items()))
        return times | {"pixels": float(pixels)}
    finally:
        one.renderer.free()


def choices(
    halls: tuple[int, ...], sizes: tuple[tuple[int, int], ...], found: dict[str, Any]
) -> list[dict[str, float]]:
    """By the costs that ship and those that were measured before."""
    tables = {"shipped": SHIPPED}
    if isinstance(found.get("costs"), dict):
        tables["measured"] = Costs(**{name: found["costs"][name] for name in NAMES})
    taken = []
    for width, height in sizes:
        for count in halls:
            case = Case(f"hall {count}", hall(count), partial(view_of_mirror, width, height, TALL * height))
            taken.append(measure(case, Settings(method="auto", samples=1), 9, True, tables, perf_counter))
    return taken


def _say(line: str) -> None:
    print(f"  ({line})", flush=True)


def run(parts: dict[str, Part], folder: Path, seconds: float) -> dict[str, Any]:
    """All parts in turn; returns, and keeps in device.json, what each has found."""
    begin = perf_counter()
    found: dict[str, Any] = {"device": platform_facts()}
    print(", ".join(found["device"].values()), flush=True)
    for name, part in parts.items():
        if perf_counter() - begin > seconds:
            print(f"\n{name}: left out, as the time is over")
            found[name] = "left out"
            continue
        print(f"\n{name}", flush=True)
        start = perf_counter()
        try:
            found[name] = part(found)
        except Exception as error:
            # (The machine is lent for minutes: what comes next may work.)
            traceback.print_exc()
            found[name] = f"failed: {error}"
        print(f"({perf_counter() - start:.1f} s)", flush=True)
        (folder / "device.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    return found


def main() -> None:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--vertices", type=int, default=1_000_000)
    parser.add_argument("--triangles", type=int, default=125_000)
    parser.add_argument("--frame-triangles", type=int, default=100_000)
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--seconds", type=float, default=540.0, help="no part begins after so many (%(default)s)")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    require_gpu()
    width, height = map(int, options.size.split("x"))
    is_whole = (width, height) == SIZES[-1]
    parts: dict[str, Part] = {
        "proofs": proofs,
        "costs": costs,
        "solves": partial(solves, options.vertices),
        "rays": partial(rays, options.triangles),
        "frames": partial(frames, options.frame_triangles, (width, height), 30.0),
        "passes": partial(passes, (width, height), options.frame_triangles),
        "choices": partial(choices, HALLS if is_whole else HALLS[:1], SIZES if is_whole else ((width, height),)),
    }
    run(parts, options.output, options.seconds)


if __name__ == "__main__":
    main()
