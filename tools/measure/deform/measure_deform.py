# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a frame costs in which a large mesh deforms before a mirror ball, stage by stage.

    python tools/measure/deform/measure_deform.py [--triangles 125000,2000000] [--frames 9] [--method exact]
        [--normals smooth] [--sun] [--profile]

A grid under a wave modifier lies below a large mirror ball; the frame is 640 x 480, one sub-frame, direct light, whole
picture, by the parts of the viewport (reader, renderer that is made by and by) without a window. Each stage waits for
the GPU. *Blender* is the evaluation of the modifier, which is not ours and not in the sum. Medians of frames, ms.
`--normals` chooses flat or smooth normals, or smooth with sharp edges; `--profile` prints where Python's time goes.
"""

from __future__ import annotations

import argparse
import cProfile
import pstats
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any
from unittest.mock import patch

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import bootstrap
import bpy

bootstrap.load_package()

import gpu  # noqa: E402
import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer import seen as seen_module  # noqa: E402
from curvrefl.curvrefl_addon.renderer.appearance import Appearance  # noqa: E402
from curvrefl.curvrefl_addon.renderer.geometry.scene_geometry import SceneGeometry  # noqa: E402
from curvrefl.curvrefl_addon.renderer.lighting.lighting import Lighting  # noqa: E402
from curvrefl.curvrefl_addon.renderer.rays.paths import PathBuffer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.rays.ray_scene import RayScene  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.shading.shade import ShadePass  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.looking import look_at  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from curvrefl.curvrefl_addon.scene.changes import Changes  # noqa: E402
from curvrefl.curvrefl_addon.scene.extract import SceneReader  # noqa: E402

WIDTH, HEIGHT = 640, 480
STAGES = (
    ("chunks", SceneGeometry, "update"),
    ("appearance", Appearance, "follow"),
    ("hierarchy", RayScene, "follow"),
)
"""Parts of `Renderer.update`: what else is in it is called the rest"""
PASSES = (
    ("shadows", Lighting, "prepare"),
    ("primary", seen_module, "draw_primary"),
    ("walk", PathBuffer, "follow"),
    ("shade", ShadePass, "add"),
)
"""Parts of a drawn frame"""


def build(triangles: int, normals: str, has_sun: bool) -> bpy.types.Object:
    """A mirror ball before a grid with a wave modifier; returns the grid."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene: Any = bpy.context.scene
    scene.cycles.diffuse_bounces = 0
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=1.5)
    mirror = bpy.context.object
    assert mirror is not None
    mirror.name = "Mirror"
    bpy.ops.object.shade_smooth()
    chrome = bpy.data.materials.new("Chrome")
    chrome.node_tree.nodes["Principled BSDF"].inputs["Metallic"].default_value = 1.0
    chrome.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.0
    mirror.data.materials.append(chrome)
    side = round(np.sqrt(triangles / 2))
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side, y_subdivisions=side, size=12.0, location=(0.0, 0.0, -2.0))
    grid = bpy.context.object
    assert grid is not None
    grid.name = "Grid"
    if normals != "flat":
        grid.data.shade_smooth()
    if normals == "sharp":
        sharp = np.arange(len(grid.data.edges)) % 101 == 0
        attribute: Any = grid.data.attributes.new("sharp_edge", "BOOLEAN", "EDGE")
        attribute.data.foreach_set("value", sharp)
    wave = grid.modifiers.new("Wave", "WAVE")
    wave.height, wave.width, wave.narrowness, wave.speed = 0.6, 1.6, 1.5, 0.4
    paint = bpy.data.materials.new("Paint")
    paint.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.7, 0.3, 0.1, 1.0)
    grid.data.materials.append(paint)
    if has_sun:
        bpy.ops.object.light_add(type="SUN", rotation=(0.6, 0.3, 0.0))
    world = bpy.data.worlds.new("World")
    scene.world = world
    bpy.context.view_layer.update()
    return grid


def view() -> View:
    """From 4 m away: the ball fills most of the picture."""
    angle = 2.0 * np.arctan(0.5 * WIDTH / HEIGHT)
    return look_at(np.array([0.0, -4.0, 1.2]), np.zeros(3), WIDTH, HEIGHT, angle, near=0.1, far=1000.0)


class Stopwatch:
    """Milliseconds by stage, of one frame after the other."""

    def __init__(self, canvas: Canvas) -> None:
        self._canvas = canvas
        self.frames: list[dict[str, float]] = []

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """What is done within counts for it, the GPU's part too."""
        start = perf_counter()
        yield
        self._canvas.wait()
        self.frames[-1][name] = self.frames[-1].get(name, 0.0) + 1e3 * (perf_counter() - start)

    def timed(self, name: str, act: Callable[..., Any]) -> Callable[..., Any]:
        """`act` as a stage."""

        def run(*arguments: Any, **named: Any) -> Any:
            with self.stage(name):
                return act(*arguments, **named)

        return run

    def median(self, name: str) -> float:
        """Over all frames."""
        return median(frame.get(name, 0.0) for frame in self.frames)


class Session:
    """What a viewport holds."""

    def __init__(self, method: str) -> None:
        self.settings = Settings(samples=8, method=method)
        self.changes = Changes(everything=True)
        self.reader = SceneReader()
        self.renderer: Renderer | None = None
        self.canvas = Canvas.of_size(WIDTH, HEIGHT)
        handlers: Any = bpy.app.handlers
        handlers.depsgraph_update_post.append(self._note)
        handlers.frame_change_post.append(self._note)

    def _note(self, _scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        self.changes.add(depsgraph.updates)

    def frame(self, number: int, watch: Stopwatch) -> None:
        """Another frame of the scene, drawn."""
        watch.frames.append({})
        scene = bpy.context.scene
        assert scene is not None
        with watch.stage("Blender"):
            scene.frame_set(number)
            depsgraph = bpy.context.evaluated_depsgraph_get()
        changes, self.changes = self.changes, Changes()
        start = perf_counter()
        with watch.stage("read"):
            arrays = self.reader.read(depsgraph, scene, [bpy.data.objects["Mirror"]], changes)
        with watch.stage("update"):
            if self.renderer is None:
                self.renderer = Renderer(arrays, self.settings, is_gradual=True)
            else:
                self.renderer.update(arrays)
        with watch.stage("load"):
            self.renderer.load_some(0.01)
        with watch.stage("reflect"):
            reflection = self.renderer.reflect(view())
        with watch.stage("draw"):
            self.renderer.add_sub_frame(self.canvas, reflection, 0, 1.0)
        watch.frames[-1]["all"] = 1e3 * (perf_counter() - start)


def measure(triangles: int, options: argparse.Namespace) -> None:
    """One line for a mesh of so many triangles, and the profile where it is asked for."""
    build(triangles, options.normals, options.sun)
    session = Session(options.method)
    watch = Stopwatch(session.canvas)
    with ExitStack() as stack:
        for name, kind, method in (*STAGES, *PASSES):
            stack.enter_context(patch.object(kind, method, watch.timed(name, getattr(kind, method))))
        for number in range(30, 33):
            session.frame(number, watch)
        first = watch.frames[0]["all"]
        watch.frames.clear()
        profile = cProfile.Profile()
        if options.profile:
            profile.enable()
        for number in range(33, 33 + options.frames):
            session.frame(number, watch)
        profile.disable()
    names = [
        "Blender",
        "read",
        *[name for name, _, _ in STAGES],
        "rest",
        "load",
        "reflect",
        "draw",
        *[name for name, _, _ in PASSES],
        "all",
    ]
    for frame in watch.frames:
        frame["rest"] = frame["update"] - sum(frame.get(name, 0.0) for name, _, _ in STAGES)
    print(f"{triangles} triangles, {options.normals}{', sun' if options.sun else ''}: first {first:.0f} ms, then")
    print("  " + "  ".join(f"{name} {watch.median(name):.1f}" for name in names), flush=True)
    assert session.renderer is not None
    counters = {**session.reader.reads, **session.renderer.geometry.counters, **session.renderer.hierarchies.counters}
    print("  " + ", ".join(f"{name} {count}" for name, count in counters.items() if count))
    if options.profile:
        pstats.Stats(profile).sort_stats("tottime").print_stats(25)
    session.renderer.free()
    bpy.app.handlers.depsgraph_update_post.clear()
    bpy.app.handlers.frame_change_post.clear()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--triangles", default="125000,2000000")
    parser.add_argument("--frames", type=int, default=9)
    parser.add_argument("--method", default="exact")
    parser.add_argument("--normals", choices=("smooth", "flat", "sharp"), default="smooth")
    parser.add_argument("--sun", action="store_true", help="with a sun, which casts shadows")
    parser.add_argument("--profile", action="store_true")
    options = parser.parse_args()
    gpu.init()
    for count in options.triangles.split(","):
        measure(int(count), options)


if __name__ == "__main__":
    main()
