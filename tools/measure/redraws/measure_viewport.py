# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the viewport costs in Python, apart from the GPU: first picture, orbit, moving one of many, a large scene.

    python tools/measure/redraws/measure_viewport.py [--repeats 20] [--scene NAME]

The parts of `viewport.py` run without a window: reader, renderer, one sub-frame. *Wall* is a whole redraw. *Python* is
the same redraw with draws, dispatches and clearing left out: on a software renderer these do the GPU's work themselves
and leave the caches cold for what comes after.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from statistics import median
from time import perf_counter, thread_time
from typing import Any
from unittest.mock import patch

TOOLS = Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(TOOLS), str(TOOLS / "measure")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402

bootstrap.load_package()

import gpu  # noqa: E402
import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.renderer.reflection import Reflection  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.renderer.settings import Settings  # noqa: E402
from curvrefl.curvrefl_addon.renderer.surfaces.canvas import Canvas  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.looking import look_at  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from curvrefl.curvrefl_addon.scene.changes import Changes  # noqa: E402
from curvrefl.curvrefl_addon.scene.extract import SceneReader  # noqa: E402
from curvrefl.curvrefl_addon.viewport.region import LOADING_SECONDS  # noqa: E402

WIDTH, HEIGHT = 1280, 800
ANGLE = 2.0 * np.arctan(0.5 * WIDTH / HEIGHT)
"""Field of view across, radians: half as high as it is far away"""


class Session:
    """What a viewport holds."""

    def __init__(self) -> None:
        self.changes = Changes(everything=True)
        self.reader = SceneReader()
        self.renderer: Renderer | None = None
        self.reflection: Reflection | None = None
        """Of the last picture"""
        self.canvas = Canvas.of_size(WIDTH // 2, HEIGHT // 2)
        bpy.app.handlers.depsgraph_update_post.append(self._note)

    def _note(self, _scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        self.changes.add(depsgraph.updates)

    def end(self) -> None:
        """Let go of all."""
        bpy.app.handlers.depsgraph_update_post.remove(self._note)
        if self.renderer is not None:
            self.renderer.free()

    def redraw(self, angle: float, settings: Settings) -> None:
        """One picture at half the resolution, as while something moves."""
        if self.changes:
            changes, self.changes = self.changes, Changes()
            depsgraph = bpy.context.evaluated_depsgraph_get()
            scene = bpy.context.scene
            assert scene is not None
            arrays = self.reader.read(depsgraph, scene, [bpy.data.objects["Mirror"]], changes)
            if self.renderer is None:
                self.renderer = Renderer(arrays, settings, is_gradual=True)
            else:
                self.renderer.update(arrays)
        assert self.renderer is not None
        self.renderer.load_some(LOADING_SECONDS)
        self.reflection = self.renderer.reflect(orbit(angle), last=self.reflection)
        self.renderer.add_sub_frame(self.canvas, self.reflection, 0, 1.0, mirrors_only=True)

    def rest(self, angle: float, settings: Settings) -> None:
        """Redraw until nothing is left to do: what the first redraws of a session do is not what an orbit does."""
        self.redraw(angle, settings)
        assert self.renderer is not None
        while self.renderer.is_loading or self.renderer.hierarchies.can_improve:
            self.renderer.hierarchies.improve()
            self.redraw(angle, settings)


def orbit(angle: float) -> View:
    """From 6 m away, at the origin."""
    place = 6.0 * np.array([np.cos(angle), np.sin(angle), 0.5])
    return look_at(place, np.zeros(3), WIDTH // 2, HEIGHT // 2, ANGLE, near=0.1, far=1000.0)


def mesh_of(vertices: int) -> bpy.types.Mesh:
    """A grid with so many vertices, not quite flat."""
    side = max(int(np.sqrt(vertices)), 2)
    x, y = np.meshgrid(np.linspace(-1, 1, side), np.linspace(-1, 1, side))
    places = np.column_stack([x.ravel(), y.ravel(), 0.2 * np.sin(3 * x.ravel()) * np.cos(3 * y.ravel())])
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    quads = np.column_stack([first, first + 1, first + side + 1, first + side])
    mesh = bpy.data.meshes.new("grid")
    mesh.vertices.add(len(places))
    mesh.vertices.foreach_set("co", places.ravel().astype(np.float32))
    mesh.loops.add(quads.size)
    mesh.loops.foreach_set("vertex_index", quads.ravel().astype(np.int32))
    mesh.polygons.add(len(quads))
    mesh.polygons.foreach_set("loop_start", np.arange(0, quads.size, 4, dtype=np.int32))
    mesh.update(calc_edges=True)
    mesh.shade_smooth()
    return mesh


def build(count: int, vertices: int) -> None:
    """A mirror and `count` instances of one mesh around it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    mirror = bpy.context.object
    assert mirror is not None
    mirror.name = "Mirror"
    bpy.ops.object.shade_smooth()
    material = bpy.data.materials.new("Chrome")
    material.node_tree.nodes["Principled BSDF"].inputs["Metallic"].default_value = 1.0
    material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.0
    mirror.data.materials.append(material)
    mesh = mesh_of(vertices)
    rng = np.random.default_rng(1)
    for index in range(count):
        obj = bpy.data.objects.new(f"item {index}", mesh)
        direction = rng.normal(size=3)
        obj.location = (direction / np.linalg.norm(direction) * rng.uniform(3.0, 12.0)).tolist()
        obj.scale = (0.2, 0.2, 0.2)
        bpy.context.scene.collection.objects.link(obj)
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "AREA"))
    lamp.location.z = 8.0
    lamp.data.energy = 1000.0
    bpy.context.scene.collection.objects.link(lamp)
    world = bpy.data.worlds.new("World")
    bpy.context.scene.world = world
    bpy.context.view_layer.update()


class NoBatch:
    """In place of a GPUBatch."""

    def draw(self, _shader: Any) -> None:
        """Nothing."""


class FrameBuffer:
    """In place of a GPUFrameBuffer: a software renderer clears with the processor."""

    made = gpu.types.GPUFrameBuffer
    clears = True
    """(What is found once, as a mirror's map, must be of a clear one.)"""

    def __init__(self, **slots: Any) -> None:
        self._made = self.made(**slots)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._made, name)

    def clear(self, **values: Any) -> None:
        if self.clears:
            self._made.clear(**values)


@contextmanager
def without_gpu_work() -> Iterator[None]:
    """Batches made here are not drawn, and nothing is dispatched."""
    with ExitStack() as stack:
        for name, made in (("indexed_batch", lambda _: NoBatch()), ("full_screen_triangle", NoBatch)):
            for module in [module for module in sys.modules.values() if hasattr(module, name)]:
                stack.enter_context(patch.object(module, name, made))
        stack.enter_context(patch.object(gpu.compute, "dispatch", lambda *_: None))
        stack.enter_context(patch.object(gpu.types, "GPUFrameBuffer", FrameBuffer))
        yield


def measured(
    session: Session,
    repeats: int,
    act: Callable[[int], float],
    settings: Settings,
    clock: Callable[[], float] = perf_counter,
) -> float:
    """Median ms of a redraw after `act(i)`, which returns the angle of view."""
    times = []
    for index in range(repeats):
        angle = act(index)
        start = clock()
        session.redraw(angle, settings)
        times.append(1e3 * (clock() - start))
    return median(times)


def turn(index: int) -> float:
    """Orbit."""
    return 0.01 * (index + 1)


def move(_index: int) -> float:
    """One object, in an eye that stands."""
    bpy.data.objects["item 0"].location.x += 0.001
    bpy.context.view_layer.update()
    return 0.0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=20)
    parser.add_argument("--scene", choices=[name for name, *_ in SCENES], help="this one alone")
    options = parser.parse_args()
    repeats = options.repeats
    gpu.init()
    settings = Settings(samples=8)
    print(f"{'scene':20} {'act':20} {'wall ms':>9} {'Python ms':>10}  read per redraw")
    for name, count, vertices in SCENES:
        if options.scene not in (None, name):
            continue
        build(count, vertices)
        session = Session()
        start = perf_counter()
        session.redraw(0.0, settings)
        print(f"{name:20} {'first picture':20} {1e3 * (perf_counter() - start):9.0f}")
        session.rest(0.0, settings)
        assert session.renderer is not None
        light = session.renderer.bounced_light
        print(f"{name:20} {'at rest':20} {1e3 * (perf_counter() - start):9.0f}             light: {light}")
        walls = [measured(session, repeats, act, settings) for act in (turn, move)]
        session.end()
        with without_gpu_work():
            session = Session()
            session.rest(0.0, settings)
            for label, act, wall in zip(("orbit", "move one object"), (turn, move), walls, strict=True):
                session.rest(0.0, settings)
                before = session.reader.reads
                with patch.object(FrameBuffer, "clears", False):
                    # (of this thread alone: what else runs on the machine does not count)
                    python = measured(session, repeats, act, settings, thread_time)
                read = {key: (value - before[key]) / repeats for key, value in session.reader.reads.items()}
                read = {key: value for key, value in read.items() if value}
                print(f"{name:20} {label:20} {wall:9.1f} {python:10.2f}  {read or 'nothing'}")
        session.end()


SCENES = (("5k triangles", 10, 180), ("2000 instances", 2000, 64), ("1M vertices", 1, 1_000_000))
"""Name, instances around the mirror, vertices of each"""

if __name__ == "__main__":
    main()
