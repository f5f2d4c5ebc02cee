# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the verbs of the command line do; `cli` parses and calls.

Each takes the parsed options and returns an exit code. All raise InputError for what the user can put right. Blender
and the renderer are imported inside, so that bad usage is answered at once.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from ..output import checked_file, checked_folder, clean_up, folder_to_publish, numbered
from ..streams import STDOUT, dropped
from ..supervised import ended_softly
from ..written_files import is_whole
from .inputs import (
    chosen_settings,
    frames_left,
    open_scene,
    read_names,
    read_scene,
    registered,
    repository_tool,
    require_known,
    resolution_of,
    settings_of_file,
    start_gpu,
    view_layer_of,
    warn_of,
)
from .sequence_verbs import asked_comparison, compare_frames, compare_scene, merge, print_report

if TYPE_CHECKING:
    import bpy

DEMO_SAMPLES, DEMO_SUB_FRAMES = 32, 16
"""Of the demo's reference and of our pictures of it: two cores need about three minutes in all"""
DEMO_METHODS = ("auto", "secant_star", "environment_cube")
"""(`exact` is what `auto` chooses there.)"""
LAYERS = ("unit", "blender", "gui")
AWKWARD = "awkward"
"""A layer that runs only where it is asked for: the whole collection of awkward scenes, or those named after it"""
PASSES = (
    *("color", "position", "object", "iterations", "normal", "albedo", "depth", "distance", "path_length", "uv"),
    *("incidence", "images", "vector", "mirror_id"),
)
NUMBERED = {"object", "mirror_id"}
"""Passes with numbers of objects"""


def render(options: argparse.Namespace) -> int:
    """Render the file by the engine of F12, and what is behind the picture as passes: one frame, or a range."""
    passes = read_names(options.passes, "pass")
    require_known(passes, PASSES, "pass")
    reflectors = read_names(options.reflector, "reflector")
    output = checked_file(options.output, (".exr",) if options.multilayer else (".png", ".exr"))
    start_gpu()
    scene = open_scene(options.file, options.frame)

    from ..scene.opened.blend_file import find_reflectors

    find_reflectors(scene, reflectors)
    apart = () if options.multilayer else tuple(name for name in passes if name != "color")

    clean_up(output.parent)

    def is_done(frame: int) -> bool:
        path = numbered(output, frame)
        files = [_pass_file(path, name) for name in apart]
        if options.multilayer or "color" in passes:
            files.append(path)
        return all(is_whole(file) for file in files)

    numbers: dict[int, str] = {}
    with registered():
        if options.frames is None:
            numbers = _render_frame(options, scene, reflectors, passes, numbered(output, scene.frame_current, False))
        for frame in frames_left(options, scene, is_done):
            numbers |= _render_frame(options, scene, reflectors, passes, numbered(output, frame))
    if NUMBERED.intersection(passes):
        print("\n".join(f"object {number}: {name}" for number, name in sorted(numbers.items())))
    return 0


def _render_frame(
    options: argparse.Namespace, scene: bpy.types.Scene, reflectors: list[str], passes: list[str], output: Path
) -> dict[int, str]:
    """The present frame; returns the names of objects by their numbers in its passes. The extension is registered."""
    from ..engine.job import Job
    from ..engine.still import render_still
    from ..report.images import save_exr

    job = Job(
        reflectors=tuple(reflectors),
        settings=settings_of_file(options, scene),
        passes=tuple(name for name in passes if name != "color"),
        multilayer=options.multilayer,
        may_be_hidden=options.frames is not None,
    )
    with folder_to_publish(output.parent) as folder:
        with dropped(STDOUT):
            render_still(scene, job, *resolution_of(options, scene), folder / output.name, options.camera)
        warn_of(job.warnings)
        if job.convergence is not None:
            print(f"Sub-frames: {job.convergence}")
        if "color" not in passes and not options.multilayer:
            (folder / output.name).unlink()
        for name, pixels in job.arrays.items():
            save_exr(_pass_file(folder / output.name, name), pixels)
    return job.object_names


def _pass_file(picture: Path, name: str) -> Path:
    return picture.with_name(f"{picture.stem}_{name}.exr")


def compare(options: argparse.Namespace) -> int:
    """Compare methods with Cycles and peers; see `report.compare`. Frames are merged at the end."""
    if options.frames is not None:
        compare_frames(options)
        return merge(options)
    scene, reflectors, comparison, output = asked_comparison(options)
    print_report(compare_scene(scene, reflectors, comparison, output, options.camera), output)
    return 0


def stability(options: argparse.Namespace) -> int:
    """Where methods fail; see `study.stability.stability`."""
    output = checked_folder(options.output)
    start_gpu()

    from ..study.stability.stability import format_stability, measure_stability

    with dropped(STDOUT) as stdout:
        report = measure_stability(
            output, options.vertices, options.fuzz, lambda line: print(line, file=stdout, flush=True)
        )
    print(format_stability(report))
    print(f"Page: {output / 'stability.html'}")
    return 0


def bake(options: argparse.Namespace) -> int:
    """Bake one reflector, save its maps, and print how well they fit."""
    reflectors = read_names(options.reflector, "reflector")
    if len(reflectors) > 1:
        raise InputError("Name one reflector: the maps of each go to a folder of its own.")
    output = checked_folder(options.output)
    start_gpu()
    scene = open_scene(options.file, options.frame)

    from ..renderer.mirrors.reflector_bake import bake_reflector
    from ..renderer.mirrors.reflector_files import save
    from ..renderer.mirrors.reflector_map import pixel_error
    from ..scene.opened.render_depsgraph import read_rendered

    if options.camera is None and scene.camera is None:
        arrays, view = read_rendered(scene, view_layer_of(scene), reflectors), None
    else:
        arrays, view = read_scene(options, scene, reflectors)
    baked = bake_reflector(arrays, arrays.reflectors[0], chosen_settings(options).map_resolution)
    warn_of(baked.warnings)
    with folder_to_publish(output) as folder:
        save(baked, folder)
    for sentence in baked.describe():
        print(sentence)
    if view is not None:
        error = pixel_error(baked, view)
        print(f"error in pixels at {view.width}x{view.height}: median {error.median:.3g}, largest {error.max:.3g}")
    return 0


def demo(options: argparse.Namespace) -> int:
    """Build the demo scene, save it, and compare its picture."""
    output = checked_folder(options.output)
    start_gpu()

    from ..demo.scene import MIRRORS, build_demo
    from ..renderer.settings import Settings
    from ..report.compare import Comparison

    print("Building the demo scene", flush=True)
    file = output / "demo.blend"
    # (both or none)
    with folder_to_publish(output) as folder:
        with dropped(STDOUT):
            build_demo(folder / file.name)
        settings = Settings(samples=DEMO_SUB_FRAMES)
        comparison = Comparison(DEMO_METHODS, samples=DEMO_SAMPLES, settings=settings)
        report = compare_scene(open_scene(folder / file.name), list(MIRRORS), comparison, folder)
    print_report(report, output)
    print(f"Scene: {file}")
    return 0


def test(options: argparse.Namespace) -> int:
    """Run the checks and tests of the source, or try awkward scenes; see tools/run_tests.py."""
    if options.layers[:1] == [AWKWARD]:
        return int(repository_tool("run_tests", "test").try_awkward(options.layers[1:], options.keep))
    require_known(options.layers, LAYERS, "layer of tests")
    with ended_softly():  # (virtual screens among others)
        return int(repository_tool("run_tests", "test").run(options.layers or LAYERS))


def check(options: argparse.Namespace) -> int:
    """Check the source without Blender; see tools/checks/source.py."""
    tool = repository_tool("checks/source", "check")
    require_known(options.checks, tool.NAMES, "check")
    return int(tool.run(options.checks or tool.NAMES))


def images(options: argparse.Namespace) -> int:
    """Make the pictures of the documents; see tools/make_images.py."""
    tool = repository_tool("make_images", "images")
    with ended_softly():
        tool.make(options.images or list(tool.IMAGES))
    return 0


def release(options: argparse.Namespace) -> int:
    """Make a release of the source; see tools/release.py."""
    output = checked_folder(options.output)
    print(repository_tool("release", "release").release(options.version, output, options.tag, options.images))
    return 0


def build(options: argparse.Namespace) -> int:
    """Pack the extension; see tools/build_extension.py."""
    output = checked_folder(options.output)
    tool = repository_tool("build_extension", "build")
    with folder_to_publish(output) as folder:
        name = tool.build(folder).name
    print(output / name)
    return 0
