# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture's time goes into, pass by pass, beside Cycles with one sample in the same run.

    python tools/measure/measure_frame.py SCENES/sphere.blend .. [--reflector Mirror] [--method secant_star]
        [--samples 1,2] [--repeats 15] [--cycles 5] [--dump DIR]

*Frame* is a whole picture as `Renderer.render` makes it: forward pass, mirrors, shading. The passes are those of
another render, in which each waits for the GPU (one pixel is read), so that they do not overlap: their sum is more than
the frame. All numbers are medians, milliseconds. *First* times are of a renderer's first picture, with shaders
compiled. Cycles' time is that of its whole render call, as for the peers of `compare`. *Processor* is the time of all
threads of one frame, the least of the repeats: of a software renderer that is its work, whatever else the machine is
doing. `--dump` saves the pictures, to compare what two versions draw (`--against DIR` prints the difference to an
earlier dump).
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
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
from curvrefl.curvrefl_addon.report.cycles_reference import render_peer  # noqa: E402
from curvrefl.curvrefl_addon.scene.arrays import SceneArrays  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from curvrefl.curvrefl_addon.scene.extract import extract_scene  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.blend_file import find_camera, find_reflectors, open_blend, view_of_camera  # noqa: E402

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


def _of_met(_around: Any, _vertices: Any, _scalars: Any, classes: Any, met: Any, *_arguments: Any) -> Any:
    return met.targets(classes)["all"]


def _of_canvas(_self: Any, canvas: Any, *_arguments: Any, **_named: Any) -> Any:
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
    ]
    with ExitStack() as stack:
        for owner, attribute, name, act, target_of in passes:
            stack.enter_context(patch.object(owner, attribute, watch.timed(name, act, target_of)))
        yield


def extracted(reflectors: list[bpy.types.Object]) -> SceneArrays:
    """The open scene, read anew."""
    scene = bpy.context.scene
    assert scene is not None
    return extract_scene(bpy.context.evaluated_depsgraph_get(), scene, reflectors)


def passes_of(renderer: Renderer, view: View, repeats: int) -> dict[str, float]:
    """Median time of each pass of a picture."""
    runs = []
    for _ in range(repeats):
        watch = Stopwatch()
        with taken_apart(watch):
            renderer.render(view)
        runs.append(watch.times)
    return {name: median(run.get(name, 0.0) for run in runs) for name in runs[0]}


def measure(path: Path, reflector: str, arguments: argparse.Namespace) -> None:
    """Print the lines of one scene."""
    open_blend(path)
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    assert scene is not None and view_layer is not None
    reflectors = find_reflectors(scene, [reflector])
    view = view_of_camera(scene, find_camera(scene), WIDTH, HEIGHT)
    times = []
    for _ in range(3):
        start = perf_counter()
        arrays = extracted(reflectors)
        times.append(1e3 * (perf_counter() - start))
    triangles = sum(len(arrays.meshes[instance.mesh].triangles) for instance in arrays.instances)
    cycles = render_peer(scene, view_layer, "cycles1", WIDTH, HEIGHT, "direct", arguments.cycles, 60.0)
    print(
        f"{path.stem}: {triangles} triangles; extract {median(times):.1f}; Cycles 1 sample {cycles.timing.median:.0f} "
        f"({cycles.timing.low:.0f} to {cycles.timing.high:.0f})"
    )
    for samples in [int(number) for number in arguments.samples.split(",")]:
        settings = Settings(method=arguments.method, samples=samples)
        warm = Renderer(arrays, settings)
        warm.render(view)
        warm.free()
        start = perf_counter()
        renderer = Renderer(arrays, settings)
        made = 1e3 * (perf_counter() - start)
        watch = Stopwatch()
        with taken_apart(watch):
            first = renderer.render(view).times_ms["frame"]
        renderer.settle()
        frames, processor = [], []
        for _ in range(arguments.repeats):
            before = process_time()
            frames.append(renderer.render(view).times_ms["frame"])
            processor.append(1e3 * (process_time() - before))
        passes = passes_of(renderer, view, arguments.repeats)
        frame = median(frames)
        print(
            f"  {samples} sub-frames: frame {frame:.1f} ({np.percentile(frames, 25):.1f} to "
            f"{np.percentile(frames, 75):.1f}), processor {min(processor):.0f}, "
            f"{cycles.timing.median / frame:.1f} times faster than Cycles 1 sample"
        )
        print("    " + ", ".join(f"{name} {time:.1f}" for name, time in passes.items()))
        bake = sum(shape.bake_ms for mirror in renderer.mirrors for shape in mirror.baked)
        print(f"    first: made {made:.0f} (bake {bake:.0f}), frame {first:.0f}, shadows {watch.times['shadows']:.0f}")
        compare(renderer, view, f"{path.stem}_{samples}.npz", arguments.dump, arguments.against)
        renderer.free()


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
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--reflector", default="", help="default: Mirror, or Kettle where there is no Mirror")
    parser.add_argument("--method", default="secant_star")
    parser.add_argument("--samples", default="1,2")
    parser.add_argument("--repeats", type=int, default=15)
    parser.add_argument("--cycles", type=int, default=5)
    parser.add_argument("--dump", type=Path)
    parser.add_argument("--against", type=Path)
    arguments = parser.parse_args()
    require_gpu()
    for path in arguments.files:
        open_blend(path)
        reflector = arguments.reflector or next(name for name in ("Mirror", "Kettle") if name in bpy.data.objects)
        measure(path, reflector, arguments)


if __name__ == "__main__":
    main()
