# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether `auto` takes the faster way: its frames beside those of the methods that it chooses among.

    python tools/measure/measure_auto.py SCENES/sphere.blend .. [--halls 400,8000] [--reflector Mirror]
        [--tolerance 0.5] [--rounds 9] [--sub-frames 1] [--sizes 320x240,640x480] [--measured 3] [--moving]

Vertex methods work with what `auto` would give them (edges split to less than the tolerance, the map that the mirror's
size wants), so that all meet the tolerance. The methods take turns, a frame each and in another order each round, so
that what else the machine does counts against all of them. Times are medians of processor milliseconds, of all threads,
and so are costs that are measured; with `--wall` of a clock, as for a graphics card. *Overhead* is the median, over the
rounds, of `auto`'s time over that of the method that it chose. *Model* is what `auto` takes solving to cost, over what
it takes rays to cost.

`--halls`: scenes made of numpy with about so many triangles, a mirror of nine tenths of the picture's height in the
middle. `--measured`: measure the costs of this device so many times first, and say how choices by their medians compare
with those by the costs that ship. `--moving`: the eye goes round a little in each frame, which begins from the last.
"""

from __future__ import annotations

import argparse
import random
import re
import sys
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from statistics import fmean, median
from time import perf_counter, process_time
from unittest.mock import patch

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import bpy

bootstrap.load_package()

from curvrefl.curvrefl_addon.renderer import choice as choices  # noqa: E402
from curvrefl.curvrefl_addon.renderer.choice import MirrorChoice  # noqa: E402
from curvrefl.curvrefl_addon.renderer.costs.table import NAMES, SHIPPED, Costs, use_costs  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import platform_facts, require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.measured import timing  # noqa: E402
from curvrefl.curvrefl_addon.renderer.measured.hall import hall, view_of_mirror  # noqa: E402
from curvrefl.curvrefl_addon.renderer.measured.spread_run import SpreadRun, Task  # noqa: E402
from curvrefl.curvrefl_addon.renderer.measured.unit_costs import measure_costs  # noqa: E402
from curvrefl.curvrefl_addon.renderer.reflection import Reflection  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from curvrefl.curvrefl_addon.scene.extract import extract_scene  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.blend_file import find_camera, find_reflectors, open_blend, view_of_camera  # noqa: E402

OTHERS = ("exact", "newton", "secant_star")
SHARE = re.compile(r"cost (?:about|at least) ([\d.]+) times")
TURN = 0.002
"""Of the eye between two frames, radians"""
TALL = 0.9
"""Of a hall's picture by the mirror"""
type Sight = Callable[[float], View]
"""A view, with the eye gone round so far"""


@dataclass(frozen=True, slots=True)
class Case:
    """A scene and how it is looked at."""

    name: str
    arrays: SceneArrays
    sight: Sight


class Frames:
    """One way to show a case, frame after frame."""

    def __init__(self, case: Case, settings: Settings, is_moving: bool) -> None:
        self.renderer = Renderer(case.arrays, settings)
        self._case, self._is_moving, self._turn = case, is_moving, 0.0
        self._last: Reflection | None = None
        view = case.sight(0.0)
        self._canvas = Canvas.of_size(view.width, view.height)

    def frame(self) -> None:
        """As a still, or as a viewport that moves draws one."""
        if not self._is_moving:
            self._last = self.renderer.render(self._case.sight(0.0)).reflection
            return
        self._turn = TURN - self._turn
        self._last = self.renderer.reflect(self._case.sight(self._turn), last=self._last)
        self._canvas.clear()
        self.renderer.add_sub_frame(self._canvas, self._last, 0, 1.0, mirrors_only=True)
        self._canvas.wait()

    @property
    def choice(self) -> MirrorChoice:
        """Of the last frame, by `auto`."""
        assert self._last is not None and self._last.choice is not None
        return self._last.choice.mirrors[0]


def choice_by(costs: Costs, case: Case, settings: Settings, is_moving: bool) -> MirrorChoice:
    """What `auto` does at once with these costs."""
    use_costs(costs)
    renderer = Renderer(case.arrays, settings)
    try:
        found = renderer.reflect(case.sight(0.0), is_still=not is_moving).choice
    finally:
        renderer.free()
        use_costs(SHIPPED)
    assert found is not None
    return found.mirrors[0]


def solving_settings(case: Case, settings: Settings, is_moving: bool) -> Settings:
    """Those that `auto` would solve vertices with."""
    before, choices.MOST_SHARE = choices.MOST_SHARE, 1e9
    try:
        return choice_by(SHIPPED, case, settings, is_moving).settings
    finally:
        choices.MOST_SHARE = before


def measured_costs(times: int, clock: Callable[[], float]) -> Costs:
    """Medians, unit by unit."""
    found: list[Costs] = []
    with patch.object(timing, "perf_counter", clock):
        for _ in range(times):
            run = SpreadRun([Task("Measuring", lambda: measure_costs(lambda costs, _unrest: found.append(costs)))])
            run.finish()
            if run.failure:
                raise RuntimeError(run.failure)
    return Costs(**{name: median(getattr(costs, name) for costs in found) for name in NAMES})


def measure(
    case: Case, settings: Settings, rounds: int, is_moving: bool, tables: dict[str, Costs], clock: Callable[[], float]
) -> dict[str, float]:
    """Print a line; returns how many times the best way each table's choice takes, where there is a choice."""
    solving = solving_settings(case, settings, is_moving)
    all_settings = {"auto": settings, "exact": replace(settings, method="exact")}
    if solving.method != "exact":
        all_settings |= {method: replace(solving, method=method) for method in OTHERS[1:]}
    runs = {method: Frames(case, chosen, is_moving) for method, chosen in all_settings.items()}
    times: dict[str, list[float]] = {method: [] for method in runs}
    order = list(runs)
    try:
        for run in runs.values():
            run.frame()
            run.renderer.settle()
            run.frame()
        for _ in range(rounds):
            random.shuffle(order)
            for method in order:
                start = clock()
                runs[method].frame()
                times[method].append(1e3 * (clock() - start))
        chosen = runs["auto"].choice
    finally:
        for run in runs.values():
            run.renderer.free()
    medians = {method: median(found) for method, found in times.items()}
    ways = {method: time for method, time in medians.items() if method in ("exact", "newton")}
    overhead = median(auto / own for auto, own in zip(times["auto"], times[chosen.method], strict=True))
    view = case.sight(0.0)
    by_table = {name: choice_by(costs, case, settings, is_moving) for name, costs in tables.items()}
    taken = {name: ways[item.method] / min(ways.values()) for name, item in by_table.items() if len(ways) > 1}
    print(
        f"{case.name:12} {view.width}x{view.height}: auto took {chosen.method}, {medians['auto']:.1f}; "
        + ", ".join(f"{method} {medians[method]:.1f}" for method in medians if method != "auto")
        + f"; overhead {overhead:.3f}; "
        + "; ".join(f"by the {name} costs {item.method}, {_model(item)}" for name, item in by_table.items()),
        flush=True,
    )
    return taken


def _model(chosen: MirrorChoice) -> str:
    share = SHARE.search(chosen.why)
    return f"model {share.group(1)}" if share else chosen.why


def cases_of(options: argparse.Namespace, width: int, height: int) -> list[Case]:
    """Files and halls, in pictures of this size."""
    cases = []
    for path in options.files:
        open_blend(path)
        scene = bpy.context.scene
        assert scene is not None
        name = options.reflector or next(name for name in ("Mirror", "Kettle") if name in bpy.data.objects)
        arrays = extract_scene(bpy.context.evaluated_depsgraph_get(), scene, find_reflectors(scene, [name]))
        view = view_of_camera(scene, find_camera(scene), width, height)
        cases.append(Case(path.stem, arrays, partial(_moved, view)))
    for count in options.halls:
        cases.append(Case(f"hall {count}", hall(count), partial(view_of_mirror, width, height, TALL * height)))
    return cases


def _moved(view: View, turn: float) -> View:
    """A file's view, whose picture plane moves about as far as by a turn."""
    return view.jittered(turn * view.width, 0.0)


def main() -> None:
    """Measure every scene at every size."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--halls", type=lambda text: [int(part) for part in text.split(",")], default=[])
    parser.add_argument("--reflector", default="", help="default: Mirror, or Kettle where there is no Mirror")
    parser.add_argument("--tolerance", type=float, default=0.5, help="pixels (%(default)s)")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--sub-frames", type=int, default=1)
    parser.add_argument("--sizes", default="320x240,640x480")
    parser.add_argument("--measured", type=int, default=0, metavar="TIMES")
    parser.add_argument("--moving", action="store_true")
    parser.add_argument("--wall", action="store_true", help="time by a clock, not by the processor's work")
    options = parser.parse_args()
    require_gpu()
    clock = perf_counter if options.wall else process_time
    tables = {"shipped": SHIPPED}
    print(", ".join(platform_facts().values()))
    if options.measured:
        tables["measured"] = measured_costs(options.measured, clock)
        for name, costs in tables.items():
            print(f"{name}: " + ", ".join(f"{unit} {cost:.4g}" for unit, cost in asdict(costs).items()), flush=True)
    settings = Settings(method="auto", samples=options.sub_frames, pixel_tolerance=options.tolerance, bounces=1)
    taken: list[dict[str, float]] = []
    for size in options.sizes.split(","):
        width, height = map(int, size.split("x"))
        for case in cases_of(options, width, height):
            taken.append(measure(case, settings, options.rounds, options.moving, tables, clock))
    decided = [item for item in taken if item]
    for name in tables if decided else ():
        times = [item[name] for item in decided]
        right = sum(time == 1.0 for time in times)
        mean, worst = fmean(times), max(times)
        print(f"{name} costs: the faster way in {right} of {len(times)}, {mean:.3f} of its time, at worst {worst:.2f}")


if __name__ == "__main__":
    main()
