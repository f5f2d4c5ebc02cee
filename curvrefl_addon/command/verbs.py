# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the verbs of the command line do; `cli` parses and calls.

Each takes the parsed options and returns an exit code. All raise InputError for what the user can put right. Blender
and the renderer are imported inside, so that bad usage is answered at once.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, TextIO

from ..errors import InputError
from ..optics.catalogue import METHODS
from ..output import checked_file, checked_folder, folder_to_publish
from ..settings_table import Settings

if TYPE_CHECKING:
    import bpy

    from ..report.compare import Comparison
    from ..scene.arrays import SceneArrays
    from ..scene.view import View
    from ..study.charts.chart import ChartFile

DEMO_SAMPLES = 64
"""Of the demo's reference: two cores need about two minutes in all"""
STDOUT, STDERR = 1, 2
ROOT = Path(__file__).resolve().parent.parent.parent
LAYERS = ("unit", "blender", "gui")
SETTING = "setting_"
"""Before the names of settings among the parsed options"""
PASSES = ("color", "position", "object", "iterations")


def say(text: str) -> None:
    """A line on stderr: stdout is for results."""
    print(f"curvrefl: {text}", file=sys.stderr, flush=True)


def render(options: argparse.Namespace) -> int:
    """Render the file's picture, and what is behind it as passes."""
    passes = _names(options.passes, "pass")
    _known(passes, PASSES, "pass")
    reflectors = _names(options.reflector, "reflector")
    output = checked_file(options.output, (".png", ".exr"))
    _start_gpu()
    scene = _open_scene(options.file, options.frame)
    view = _view(options, scene)
    arrays = _read_scene(scene, reflectors)

    from ..renderer.renderer import Renderer
    from ..report.images import save_exr, save_png

    renderer = Renderer(arrays, chosen_settings(options))
    try:
        frame = renderer.render(view)
        _warn(frame.warnings)
        if not frame.mask().any():
            _warn(["No reflector is in view: the picture has no reflections."])
        with folder_to_publish(output.parent) as folder:
            if "color" in passes:
                save = save_png if output.suffix.lower() == ".png" else save_exr
                save(folder / output.name, frame.color())
            arrays_of = {
                "position": frame.reflected_position,
                "object": lambda: frame.reflected_object().astype("float32"),
                "iterations": frame.iterations,
            }
            for name in passes:
                if name != "color":
                    save_exr(folder / f"{output.stem}_{name}.exr", arrays_of[name]())
    finally:
        renderer.free()
    if "object" in passes:
        names = {instance.object_id: instance.object_name for instance in arrays.instances}
        print("\n".join(f"object {number}: {name}" for number, name in sorted(names.items())))
    return 0


def compare(options: argparse.Namespace) -> int:
    """Compare methods with Cycles and peers; see `report.compare`."""
    methods = list(METHODS) if options.method.strip() == "all" else _names(options.method, "method")
    _known(methods, list(METHODS), "method")
    peers = [] if options.peers.strip() == "none" else _names(options.peers, "peer")
    reflectors = _names(options.reflector, "reflector")
    output = checked_folder(options.output)
    _start_gpu()

    from ..report.compare import Comparison

    comparison = Comparison(
        methods=tuple(methods),
        samples=options.samples,
        light=options.light,
        peers=tuple(peers),
        settings=chosen_settings(options),
    )
    scene = _open_scene(options.file, options.frame)
    width, height = _resolution(options, scene)
    comparison = replace(comparison, width=width, height=height)
    _compare_and_print(scene, reflectors, comparison, output, options.camera)
    return 0


def chart(options: argparse.Namespace) -> int:
    """Time against error, and against vertices; see `study.charts.chart`."""
    methods = list(METHODS) if options.method.strip() == "all" else _names(options.method, "method")
    _known(methods, list(METHODS), "method")
    peers = [] if options.peers.strip() == "none" else _names(options.peers, "peer")
    reflectors = [] if options.reflector is None else _names(options.reflector, "reflector")
    output = checked_folder(options.output)
    _start_gpu()

    from ..report.compare import Comparison
    from ..study.charts.chart import chart_steps
    from ..study.charts.chart_draw import require_matplotlib
    from ..study.charts.chart_table import format_chart

    require_matplotlib()
    comparison = Comparison(methods=tuple(methods), samples=options.samples, light=options.light, peers=tuple(peers))
    # All files are looked at first: what is wrong with the last one shows before minutes of Cycles.
    files = [_chart_file(options, file, name, reflectors) for file, name in _scene_names(options.files)]
    with _dropped(STDOUT) as stdout:
        steps = chart_steps(files, comparison, options.vertices, output)
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                charts = end.value
                break
            print(f"{100.0 * step.done:3.0f} %  {step.label}", file=stdout, flush=True)
    _warn(charts.warnings)
    print(format_chart(charts))
    print(f"Charts: {output / 'chart.png'}")
    return 0


def stability(options: argparse.Namespace) -> int:
    """Where methods fail; see `study.stability.stability`."""
    output = checked_folder(options.output)
    _start_gpu()

    from ..study.stability.stability import format_stability, measure_stability

    with _dropped(STDOUT) as stdout:
        report = measure_stability(
            output, options.vertices, options.fuzz, lambda line: print(line, file=stdout, flush=True)
        )
    print(format_stability(report))
    print(f"Page: {output / 'stability.html'}")
    return 0


def benchmark(options: argparse.Namespace) -> int:
    """Solves and rays per second; see `study.benchmark.benchmark`."""
    output = checked_folder(options.output)
    _start_gpu()

    from ..study.benchmark.benchmark import Limits, format_benchmark, measure_benchmark

    output.mkdir(parents=True, exist_ok=True)
    with _dropped(STDOUT) as stdout:
        report = measure_benchmark(
            options.vertices,
            options.triangles,
            Limits(options.bandwidth, options.flops),
            output,
            lambda line: print(line, file=stdout, flush=True),
        )
    print(format_benchmark(report))
    print(f"Numbers: {output / 'benchmark.json'}")
    return 0


def _scene_names(files: Sequence[str]) -> list[tuple[str, str]]:
    """The files, once each, with their names in a chart: the name of the file, or its path where two share it."""
    stems = [Path(file).stem for file in dict.fromkeys(files)]
    return [
        (file, stem if stems.count(stem) == 1 else file) for file, stem in zip(dict.fromkeys(files), stems, strict=True)
    ]


def _chart_file(options: argparse.Namespace, file: str, name: str, reflectors: Sequence[str]) -> ChartFile:
    """What to chart of a file. Raises InputError where that cannot be."""
    from ..scene.blend_file import find_camera, find_reflectors
    from ..study.charts.chart import ChartFile

    scene = _open_scene(file)
    find_camera(scene)
    chosen = list(reflectors) or _marked_mirrors(scene)
    if not chosen:
        raise InputError(
            f'No object of "{file}" is marked as a mirror: mark one in Blender, or name it by --reflector.'
        )
    find_reflectors(scene, chosen)
    return ChartFile(name, Path(file), tuple(chosen), *_resolution(options, scene))


def _marked_mirrors(scene: bpy.types.Scene) -> list[str]:
    """Names of the objects whose Mirror switch is on."""
    import bpy

    from .. import registration
    from ..options import marked_mirrors

    # In the installed extension the switch is there already; in a plain Python Blender does not know it yet.
    is_known = hasattr(bpy.types.Object, "curvrefl")
    if not is_known:
        registration.register()
    try:
        return [mirror.name for mirror in marked_mirrors(scene)]
    finally:
        if not is_known:
            registration.unregister()


def bake(options: argparse.Namespace) -> int:
    """Bake one reflector, save its maps, and print how well they fit."""
    reflectors = _names(options.reflector, "reflector")
    if len(reflectors) > 1:
        raise InputError("Name one reflector: the maps of each go to a folder of its own.")
    output = checked_folder(options.output)
    _start_gpu()
    scene = _open_scene(options.file, options.frame)
    arrays = _read_scene(scene, reflectors)

    from ..renderer.mirrors.reflector_bake import bake_reflector
    from ..renderer.mirrors.reflector_files import save
    from ..renderer.mirrors.reflector_map import pixel_error

    baked = bake_reflector(arrays, arrays.reflectors[0], chosen_settings(options).map_resolution)
    _warn(baked.warnings)
    with folder_to_publish(output) as folder:
        save(baked, folder)
    for sentence in baked.describe():
        print(sentence)
    if scene.camera is not None:
        view = _view(options, scene)
        error = pixel_error(baked, view)
        print(f"error in pixels at {view.width}x{view.height}: median {error.median:.3g}, largest {error.max:.3g}")
    return 0


def demo(options: argparse.Namespace) -> int:
    """Build the demo scene, save it, and compare its picture."""
    output = checked_folder(options.output)
    _start_gpu()

    from ..demo.scene import KETTLE, build_demo
    from ..report.compare import Comparison

    print("Building the demo scene", flush=True)
    file = output / "demo.blend"
    with folder_to_publish(output) as folder, _dropped(STDOUT):
        build_demo(folder / file.name)
    _compare_and_print(_open_scene(file), [KETTLE], Comparison(samples=DEMO_SAMPLES), output)
    print(f"Scene: {file}")
    return 0


def _compare_and_print(
    scene: bpy.types.Scene,
    reflectors: Sequence[str],
    comparison: Comparison,
    output: Path,
    camera: str | None = None,
) -> None:
    """Compare the open scene, write the report into `output`, print its table."""
    import bpy

    from ..report.compare import compare_open_scene
    from ..report.table import format_table

    view_layer = bpy.context.view_layer
    assert view_layer is not None, "an open scene has a view layer"
    with _dropped(STDOUT) as stdout:

        def progress(text: str) -> None:
            print(text, file=stdout, flush=True)

        report = compare_open_scene(scene, view_layer, reflectors, comparison, output, camera=camera, progress=progress)
    print(format_table(report))
    print(f"Report: {output / 'report.html'}")


def test(options: argparse.Namespace) -> int:
    """Run the checks of the source; see tools/run_tests.py."""
    _known(options.layers, LAYERS, "layer of tests")
    return int(_repository_tool("run_tests", "test").run(options.layers or LAYERS))


def check(options: argparse.Namespace) -> int:
    """Check the source without Blender; see tools/checks/source.py."""
    tool = _repository_tool("checks/source", "check")
    _known(options.checks, tool.NAMES, "check")
    return int(tool.run(options.checks or tool.NAMES))


def images(options: argparse.Namespace) -> int:
    """Make the pictures of the documents; see tools/make_images.py."""
    tool = _repository_tool("make_images", "images")
    tool.make(options.images or list(tool.IMAGES))
    return 0


def release(options: argparse.Namespace) -> int:
    """Make a release of the source; see tools/release.py."""
    output = checked_folder(options.output)
    print(_repository_tool("release", "release").release(options.version, output, options.tag, options.images))
    return 0


def build(options: argparse.Namespace) -> int:
    """Pack the extension; see tools/build_extension.py."""
    output = checked_folder(options.output)
    tool = _repository_tool("build_extension", "build")
    with folder_to_publish(output) as folder:
        name = tool.build(folder).name
    print(output / name)
    return 0


def _open_scene(file: Path | str, frame: int | None = None) -> bpy.types.Scene:
    """Open the file and go to a frame of it; returns the file's active scene."""
    import bpy

    from ..scene.blend_file import open_blend

    with _dropped(STDOUT):
        open_blend(file)
    scene = bpy.context.scene
    assert scene is not None, "an open file has a scene"
    if frame is not None:
        scene.frame_set(frame)
    return scene


def _resolution(options: argparse.Namespace, scene: bpy.types.Scene) -> tuple[int, int]:
    """The chosen width and height, or those that the scene renders with."""
    if options.resolution:
        return options.resolution
    scale = scene.render.resolution_percentage / 100.0
    return max(int(scene.render.resolution_x * scale), 1), max(int(scene.render.resolution_y * scale), 1)


def _read_scene(scene: bpy.types.Scene, reflectors: Sequence[str]) -> SceneArrays:
    """The open scene at its frame, with these mirrors."""
    import bpy

    from ..scene.blend_file import find_reflectors
    from ..scene.extract import extract_scene

    chosen = find_reflectors(scene, reflectors)
    return extract_scene(bpy.context.evaluated_depsgraph_get(), scene, chosen, for_render=True)


def _view(options: argparse.Namespace, scene: bpy.types.Scene) -> View:
    """What the chosen camera sees in the chosen resolution."""
    from ..scene.blend_file import find_camera, view_of_camera

    return view_of_camera(scene, find_camera(scene, options.camera), *_resolution(options, scene))


def chosen_settings(options: argparse.Namespace) -> Settings:
    """Those that the verb's arguments set; the others are as by default."""
    return Settings(
        **{name.removeprefix(SETTING): value for name, value in vars(options).items() if name.startswith(SETTING)}
    )


def _names(text: str, what: str) -> list[str]:
    """The parts of a list with commas, once each. Raises InputError when there are none."""
    names = list(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
    if not names:
        raise InputError(f"Name at least one {what}.")
    return names


def _known(names: Sequence[str], known: Sequence[str], what: str) -> None:
    for name in names:
        if name not in known:
            raise InputError(f'There is no {what} "{name}": choose from {", ".join(known)}.')


def _warn(warnings: Sequence[str]) -> None:
    for warning in dict.fromkeys(warnings):
        say(f"Warning: {warning}")


@contextlib.contextmanager
def _dropped(descriptor: int) -> Iterator[TextIO]:
    """What Blender and C libraries write to STDOUT or STDERR meanwhile goes nowhere; yields the way past that."""
    stream = sys.stdout if descriptor == STDOUT else sys.stderr
    stream.flush()
    kept = os.dup(descriptor)
    with open(kept, "w", encoding="utf-8") as past:
        try:
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, descriptor)
            os.close(nowhere)
            yield past
        finally:
            stream.flush()
            os.dup2(kept, descriptor)


def _start_gpu() -> None:
    """Make the GPU context. Raises InputError, with how to get one, where there is none."""
    import bpy  # noqa: F401  (with the wheel, before gpu)

    from ..renderer.device.context import GpuUnavailableError, require_gpu

    try:
        # EGL tries configurations that do not match and says so, at length, though all is well.
        with _dropped(STDERR):
            require_gpu()
    except GpuUnavailableError as error:
        message = str(error).rstrip(".")
        raise InputError(f"{message[:1].upper()}{message[1:]}.") from error


def _repository_tool(name: str, verb: str) -> ModuleType:
    """`tools/<name>.py`, which is there in a copy of the source and not in the installed extension."""
    path = ROOT / "tools" / f"{name}.py"
    spec = importlib.util.spec_from_file_location(f"curvrefl_tools_{path.stem}", path) if path.is_file() else None
    if spec is None or spec.loader is None:
        raise InputError(f"The verb {verb} needs a copy of Curvrefl's source: call ./curvrefl {verb} there.")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
