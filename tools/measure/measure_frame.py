# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture's time goes into, pass by pass, beside Cycles with one sample in the same run.

    python tools/measure/measure_frame.py SCENES/sphere.blend SCENES/dungeon.blend:Suzanne:full ..
        [--method exact,auto] [--samples 1] [--repeats 9] [--dump DIR]

A file may name its mirrors (else `Mirror`, or `Kettle`) and its light, `direct` (else) or `full`, as for the verb
`compare`. *Frame* is a whole picture as `Renderer.render` makes it: forward pass, mirrors, shading. Frames of all
methods and Cycles' take turns, so that what else the machine does counts against all, and the *ratio* is the median of
the turns' own. The passes are those of other pictures, in which each waits for the GPU (one pixel is read), so that
they do not overlap: their sum is more than the frame. All numbers are medians, milliseconds. *First* times are of a
renderer's first picture, with shaders compiled. Cycles' time is that of its whole render call, as for the peers of
`compare`. *Processor* is the time of all threads of one frame, the least of the repeats: of a software renderer that is
its work, whatever else the machine is doing. `--dump` saves the pictures, to compare what two versions draw
(`--against DIR` prints the difference to an earlier dump).
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import Any
from unittest.mock import patch

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import bootstrap
import bpy

bootstrap.load_package()

import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer import seen as frame_module  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from curvrefl.curvrefl_addon.renderer.geometry.scene_geometry import SceneGeometry  # noqa: E402
from curvrefl.curvrefl_addon.renderer.indirect.gather import GatherPicture  # noqa: E402
from curvrefl.curvrefl_addon.renderer.lighting.lighting import Lighting  # noqa: E402
from curvrefl.curvrefl_addon.renderer.rays.paths import PathBuffer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.shading.shade import ShadePass  # noqa: E402
from curvrefl.curvrefl_addon.renderer.shown import vertices as vertices_module  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.pixel_classes import PixelClasses  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.surface_buffer import SurfaceBuffer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.tracing import tracer as tracer_module  # noqa: E402
from curvrefl.curvrefl_addon.renderer.tracing.path_light import PathLight  # noqa: E402
from curvrefl.curvrefl_addon.renderer.vertices.back_faces import BackFaces  # noqa: E402
from curvrefl.curvrefl_addon.renderer.vertices.mirror_solver import MirrorSolver  # noqa: E402
from curvrefl.curvrefl_addon.report.cycles_reference import LIGHTS, render_still, use_cycles, use_still_output  # noqa: E402
from curvrefl.curvrefl_addon.report.direct_light import in_direct_light, mirrors_met  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.blend_file import open_blend  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_scene  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.temporary_settings import temporary_settings  # noqa: E402

WIDTH, HEIGHT = 640, 480


def wait(target: Any) -> None:
    """Return when the GPU has finished with a frame buffer."""
    with target.bind():
        target.read_color(0, 0, 1, 1, 4, 0, "FLOAT")


def wait_for_depth(buffer: Any) -> None:
    """Return when the GPU has finished with the depth of what has a frame buffer without colors."""
    with buffer.frame_buffer.bind():
        buffer.frame_buffer.read_depth(0, 0, 1, 1)


class Stopwatch:
    """Milliseconds by the name of a pass, summed over what is called the same in one picture."""

    def __init__(self) -> None:
        self.times: dict[str, float] = {}

    def timed(self, name: str, act: Callable[..., Any], target_of: Callable[..., Any]) -> Callable[..., Any]:
        """`act` with its time taken; `target_of` its arguments is the frame buffer it draws to, or None."""

        def run(*arguments: Any, **named: Any) -> Any:
            start = perf_counter()
            result = act(*arguments, **named)
            target = target_of(*arguments, **named)
            if target is not None:
                wait(target)
            self.times[name] = self.times.get(name, 0.0) + 1e3 * (perf_counter() - start)
            return result

        return run


def _nothing(*_arguments: Any, **_named: Any) -> None:
    """For passes whose work is done when they return: compute on a software renderer, and what waits by itself."""


def _of_buffer(buffer: Any, *_arguments: Any, **_named: Any) -> Any:
    return buffer.frame_buffer


def _of_second(_self: Any, buffer: Any, *_arguments: Any, **_named: Any) -> Any:
    return buffer.frame_buffer


def _of_met(_around: Any, _vertices: Any, classes: Any, met: Any, *_arguments: Any) -> Any:
    return met.target(classes)


def _of_canvas(_self: Any, canvas: Any, *_arguments: Any, **_named: Any) -> Any:
    return canvas.frame_buffer


def _of_third(_self: Any, _by: Any, canvas: Any, *_arguments: Any, **_named: Any) -> Any:
    return canvas.frame_buffer


@contextmanager
def taken_apart(watch: Stopwatch) -> Iterator[None]:
    """Every pass waits for the GPU and tells its time."""

    def solve(solver: MirrorSolver, *arguments: Any, **named: Any) -> Any:
        parts, found = original_solve(solver, *arguments, **named)
        for part in parts:
            part.solution.wait()
        return parts, found

    def sort(classes: PixelClasses, *arguments: Any, **named: Any) -> None:
        original_sort(classes, *arguments, **named)
        wait_for_depth(classes)

    original_solve, original_sort = MirrorSolver.solve, PixelClasses.sort
    passes: list[tuple[Any, str, str, Callable[..., Any], Callable[..., Any]]] = [
        (SceneGeometry, "refine", "split", SceneGeometry.refine, _nothing),
        (MirrorSolver, "solve", "solve", solve, _nothing),
        (MirrorSolver, "with_curved_edges", "edges", MirrorSolver.with_curved_edges, _nothing),
        (frame_module, "draw_primary", "primary", frame_module.draw_primary, _of_buffer),
        (SurfaceBuffer, "clear", "clear", SurfaceBuffer.clear, _of_buffer),
        (BackFaces, "draw", "back faces", BackFaces.draw, _of_buffer),
        (vertices_module, "draw_reflected", "reflected", vertices_module.draw_reflected, _of_buffer),
        (PathBuffer, "follow", "walk", PathBuffer.follow, _of_buffer),
        (Lighting, "prepare", "shadows", Lighting.prepare, _nothing),
        (PixelClasses, "sort", "classes", sort, _nothing),
        (ShadePass, "_add_others", "shade", ShadePass._add_others, _of_second),
        (ShadePass, "_add_shown", "shade", ShadePass._add_shown, _of_second),
        (ShadePass, "_add_front", "front", ShadePass._add_front, _of_second),
        (tracer_module, "follow", "step", tracer_module.follow, _of_met),
        (PathLight, "add", "light", PathLight.add, _of_canvas),
        (GatherPicture, "add", "gather", GatherPicture.add, _of_third),
    ]
    with ExitStack() as stack:
        for owner, attribute, name, act, target_of in passes:
            stack.enter_context(patch.object(owner, attribute, watch.timed(name, act, target_of)))
        yield


def passes_of(renderer: Renderer, view: View, repeats: int) -> dict[str, float]:
    """Median time of each pass of a picture."""
    runs = []
    for _ in range(repeats):
        watch = Stopwatch()
        with taken_apart(watch):
            renderer.render(view)
        runs.append(watch.times)
    return {name: median(run.get(name, 0.0) for run in runs) for name in runs[0]}


@dataclass(frozen=True)
class Measured:
    """One method at one number of sub-frames."""

    method: str
    samples: int
    renderer: Renderer
    first: str
    """What its first picture took"""
    frames: list[float] = field(default_factory=list)
    processor: list[float] = field(default_factory=list)

    @property
    def name(self) -> str:
        return f"{self.method}, {self.samples} sub-frame{'s' if self.samples > 1 else ''}"

    def take_turn(self, view: View) -> None:
        before = process_time()
        self.frames.append(self.renderer.render(view).times_ms["frame"])
        self.processor.append(1e3 * (process_time() - before))


def started(arrays: SceneArrays, view: View, settings: Settings) -> Measured:
    """With everything compiled and loaded."""
    warm = Renderer(arrays, settings)
    warm.render(view)
    warm.free()
    start = perf_counter()
    renderer = Renderer(arrays, settings)
    made = 1e3 * (perf_counter() - start)
    watch = Stopwatch()
    with taken_apart(watch):
        first = renderer.render(view).times_ms["frame"]
    renderer.hierarchies.finish()
    bake = sum(shape.bake_ms for mirror in renderer.mirrors for shape in mirror.baked)
    text = f"made {made:.0f} (bake {bake:.0f}), frame {first:.0f}, shadows {watch.times.get('shadows', 0.0):.0f}"
    return Measured(settings.method, settings.samples, renderer, text)


def measure(path: Path, mirrors: list[str], light: str, arguments: argparse.Namespace) -> None:
    """Print the lines of the open file."""
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    assert scene is not None and view_layer is not None
    times = []
    for _ in range(3):
        start = perf_counter()
        arrays, view = read_render_scene(scene, view_layer, mirrors, WIDTH, HEIGHT)
        times.append(1e3 * (perf_counter() - start))
    if light == "direct":
        arrays = in_direct_light(arrays)
    triangles = sum(len(arrays.meshes[instance.mesh].triangles) for instance in arrays.instances)
    settings = [
        Settings(method=method, samples=int(samples))
        for method in arguments.method.split(",")
        for samples in arguments.samples.split(",")
    ]
    all_measured = [started(arrays, view, one) for one in settings]
    cycles: list[float] = []

    def cycles_turn() -> None:
        cycles.append(1e3 * render_still(scene, view_layer).seconds)

    with temporary_settings() as changes:
        use_still_output(changes, scene, WIDTH, HEIGHT)
        use_cycles(changes, scene, view_layer, 1, light, mirrors_met(arrays, settings[0].bounces))
        render_still(scene, view_layer)
        turns: list[Callable[[], None]] = [*(partial(one.take_turn, view) for one in all_measured), cycles_turn]
        for number in range(arguments.repeats):
            # (What comes after Cycles is slower than what does not.)
            first = number % len(turns)
            for turn in turns[first:] + turns[:first]:
                turn()
    print(
        f"{path.stem}, {', '.join(mirrors)}, {light} light: {triangles} triangles; extract {median(times):.1f}; "
        f"Cycles 1 sample {quartiles(cycles, 0)}"
    )
    for measured in all_measured:
        renderer = measured.renderer
        passes = passes_of(renderer, view, arguments.repeats)
        ratios = [peer / frame for peer, frame in zip(cycles, measured.frames, strict=True)]
        print(
            f"  {measured.name}: frame {quartiles(measured.frames, 1)}, processor {min(measured.processor):.0f}; "
            f"ratio {quartiles(ratios, 2)} to Cycles 1 sample"
        )
        print("    " + ", ".join(f"{name} {time:.1f}" for name, time in passes.items()))
        print(f"    first: {measured.first}", flush=True)
        name = f"{path.stem}_{measured.method}_{measured.samples}.npz"
        compare(renderer, view, name, arguments.dump, arguments.against)
        renderer.free()


def quartiles(values: list[float], digits: int) -> str:
    """The median, and the quartiles."""
    low, middle, high = np.percentile(values, (25, 50, 75))
    return f"{middle:.{digits}f} ({low:.{digits}f} to {high:.{digits}f})"


def given(text: str) -> tuple[Path, list[str], str]:
    """An argument FILE[:MIRROR[,MIRROR..][:LIGHT]]; without mirrors, those that the tests' scenes and the demo have."""
    path, _, rest = text.partition(":")
    names, _, light = rest.partition(":")
    if light and light not in LIGHTS:
        raise argparse.ArgumentTypeError(f"'{light}' is no light: choose from {', '.join(LIGHTS)}")
    return Path(path), names.split(",") if names else [], light or "direct"


def compare(renderer: Renderer, view: View, name: str, dump: Path | None, against: Path | None) -> None:
    """Save the picture and its buffers, and print how they differ from saved ones."""
    if dump is None and against is None:
        return
    frame = renderer.render(view)
    arrays = {"color": frame.color(), **frame.surfaces}
    if dump is not None:
        dump.mkdir(parents=True, exist_ok=True)
        np.savez(dump / name, allow_pickle=False, **arrays)
    if against is not None:
        with np.load(against / name) as before:
            for key, now in arrays.items():
                error = np.abs(now - before[key])
                different = int((error.max(axis=-1) > 0.0).sum())
                print(f"    {key}: {different} pixels differ, by at most {error.max():.2g}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=given, metavar="FILE[:MIRRORS[:LIGHT]]")
    parser.add_argument("--method", default="exact", help="several take turns (%(default)s)")
    parser.add_argument("--samples", default="1", help="sub-frames; several take turns (%(default)s)")
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--dump", type=Path)
    parser.add_argument("--against", type=Path)
    arguments = parser.parse_args()
    require_gpu()
    for path, names, light in arguments.files:
        open_blend(path)
        usual = [name for name in ("Mirror", "Kettle") if name in bpy.data.objects]
        measure(path, names or usual[:1], light, arguments)


if __name__ == "__main__":
    main()
