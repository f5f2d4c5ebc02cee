# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether `auto` takes the faster way: its frames beside those of the methods that it chooses among.

    python tools/measure/measure_auto.py SCENES/sphere.blend .. [--reflector Mirror] [--tolerance 0.5] [--rounds 9]
        [--sub-frames 1] [--sizes 320x240,640x480]

Vertex methods work with what `auto` would give them (edges split to less than the tolerance, the map that the mirror's
size wants), so that all meet the tolerance. The methods take turns, a frame each and in another order each round, so
that what else the machine does counts against all of them. Times are medians of processor milliseconds, of all threads.
*Model* is what `renderer/choice.py` takes solving to cost, over what it takes rays to cost.
"""

from __future__ import annotations

import argparse
import random
import re
import sys
from dataclasses import replace
from pathlib import Path
from statistics import median
from time import process_time

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import bpy

bootstrap.load_package()

from curvrefl.curvrefl_addon.renderer import choice as choices  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from curvrefl.curvrefl_addon.scene.extract import extract_scene  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.blend_file import find_camera, find_reflectors, open_blend, view_of_camera  # noqa: E402

OTHERS = ("exact", "newton", "secant_star")
SHARE = re.compile(r"cost about ([\d.]+) times")


def solving_settings(arrays: SceneArrays, settings: Settings, view: View) -> Settings:
    """Those that `auto` would solve vertices with."""
    before, choices.MOST_SHARE = choices.MOST_SHARE, 1e9
    try:
        renderer = Renderer(arrays, settings)
        chosen = renderer.render(view).reflection.choice
        renderer.free()
    finally:
        choices.MOST_SHARE = before
    assert chosen is not None
    return chosen.mirrors[0].settings


def measure(name: str, arrays: SceneArrays, view: View, settings: Settings, rounds: int) -> None:
    """Print a line."""
    solving = solving_settings(arrays, settings, view)
    all_settings = {"auto": settings, "exact": replace(settings, method="exact")}
    if solving.method != "exact":
        all_settings |= {method: replace(solving, method=method) for method in OTHERS[1:]}
    renderers = {method: Renderer(arrays, chosen) for method, chosen in all_settings.items()}
    times: dict[str, list[float]] = {method: [] for method in renderers}
    order = list(renderers)
    try:
        frames = {}
        for method, renderer in renderers.items():
            renderer.render(view)
            renderer.settle()
            frames[method] = renderer.render(view)
        for _ in range(rounds):
            random.shuffle(order)
            for method in order:
                start = process_time()
                renderers[method].render(view)
                times[method].append(1e3 * (process_time() - start))
        choice = frames["auto"].reflection.choice
    finally:
        for renderer in renderers.values():
            renderer.free()
    medians = {method: median(found) for method, found in times.items()}
    best = min((method for method in medians if method != "auto"), key=medians.__getitem__)
    assert choice is not None
    (chosen,) = choice.mirrors
    share = SHARE.search(chosen.why)
    print(
        f"{name:12} {view.width}x{view.height}: auto took {chosen.method}, {medians['auto']:.0f}; "
        + ", ".join(f"{method} {medians[method]:.0f}" for method in medians if method != "auto")
        + f"; auto over the best ({best}) {medians['auto'] / medians[best]:.2f}"
        + (f"; model {share.group(1)}" if share else f"; {chosen.why}"),
        flush=True,
    )


def main() -> None:
    """Measure every scene at every size."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--reflector", default="", help="default: Mirror, or Kettle where there is no Mirror")
    parser.add_argument("--tolerance", type=float, default=0.5, help="pixels (%(default)s)")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--sub-frames", type=int, default=1)
    parser.add_argument("--sizes", default="320x240,640x480")
    options = parser.parse_args()
    require_gpu()
    settings = Settings(method="auto", samples=options.sub_frames, pixel_tolerance=options.tolerance, bounces=1)
    for path in options.files:
        open_blend(path)
        scene = bpy.context.scene
        assert scene is not None
        name = options.reflector or next(name for name in ("Mirror", "Kettle") if name in bpy.data.objects)
        arrays = extract_scene(bpy.context.evaluated_depsgraph_get(), scene, find_reflectors(scene, [name]))
        for size in options.sizes.split(","):
            width, height = map(int, size.split("x"))
            view = view_of_camera(scene, find_camera(scene), width, height)
            measure(path.stem, arrays, view, settings, options.rounds)


if __name__ == "__main__":
    main()
