# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What each redraw costs from the moment that the box is ticked until the picture at rest is there.

    python tools/measure/redraws/measure_switch_on.py [--blend FILE --mirrors NAMES] [--vertices 1000000] [--studio]

The parts of `viewport/` run as the draw handlers run them, without a window: a scene that is read, a renderer, a
region's picture, composed into a frame buffer. For each redraw: milliseconds until the GPU is done, and what they went
to. Without a file: a mirror and one mesh of so many vertices. MESA_SHADER_CACHE_DISABLE=1 compiles as on a new machine.
With `--processor` times are those of the processor, all threads together: what else runs on the machine counts less.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from inspect import isgeneratorfunction
from pathlib import Path
from time import perf_counter, process_time, sleep
from typing import Any
from unittest.mock import patch

TOOLS = Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(TOOLS), str(TOOLS / "measure")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402

bootstrap.load_package()

import gpu  # noqa: E402
from curvrefl.curvrefl_addon import registration  # noqa: E402
from curvrefl.curvrefl_addon.options import current_options, settings_of  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.frame_buffers import frame_buffer, wait_for  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.textures import empty_texture  # noqa: E402
from curvrefl.curvrefl_addon.renderer.geometry.scene_geometry import SceneGeometry  # noqa: E402
from curvrefl.curvrefl_addon.renderer.indirect.indirect import IndirectLight  # noqa: E402
from curvrefl.curvrefl_addon.renderer.lighting.lighting import Lighting  # noqa: E402
from curvrefl.curvrefl_addon.renderer.lighting.shadow_maps import ShadowMaps  # noqa: E402
from curvrefl.curvrefl_addon.renderer.preparation import Preparation  # noqa: E402
from curvrefl.curvrefl_addon.renderer.programs.image_pages import ImagePages  # noqa: E402
from curvrefl.curvrefl_addon.renderer.rays.ray_scene import RayScene  # noqa: E402
from curvrefl.curvrefl_addon.renderer.renderer import Renderer  # noqa: E402
from curvrefl.curvrefl_addon.scene.camera.view import View  # noqa: E402
from curvrefl.curvrefl_addon.scene.extract import SceneReader  # noqa: E402
from curvrefl.curvrefl_addon.scene.opened.blend_file import find_reflectors, view_of_camera  # noqa: E402
from curvrefl.curvrefl_addon.viewport.light import LightReader, ViewportLight  # noqa: E402
from curvrefl.curvrefl_addon.viewport.opening import SLICE_SECONDS  # noqa: E402
from curvrefl.curvrefl_addon.viewport.region import SETTLED_SECONDS, RegionPicture  # noqa: E402
from curvrefl.curvrefl_addon.viewport.shown_scene import Look, ViewportScene  # noqa: E402
from redraws.measure_viewport import HEIGHT, WIDTH, build, orbit  # noqa: E402

STAGES: tuple[tuple[type, str, str], ...] = (
    (SceneReader, "read", "reading"),
    (LightReader, "lit", "viewport's light"),
    (SceneGeometry, "updating", "chunks"),
    (Lighting, "__init__", "planning lights"),
    (Lighting, "follow", "planning lights"),
    (RayScene, "follow", "hierarchies"),
    (RayScene, "improve", "better hierarchies"),
    (ImagePages, "fill", "images"),
    (ShadowMaps, "draw", "shadow maps"),
    (IndirectLight, "advance", "bounced light"),
    (Preparation, "reflect", "choice and solve"),
    (Renderer, "add_sub_frame", "drawing"),
)
"""Methods whose time is told, less that of others called by them"""


class Clock:
    """Adds up what stages take, each without those inside of it."""

    def __init__(self, now: Callable[[], float]) -> None:
        self.now = now
        self.taken: dict[str, float] = {}
        self._inner: list[float] = []
        # (Which does not hold its texture.)
        self._texture = empty_texture(1, 1)
        self._target = frame_buffer(self._texture)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Until the GPU has done it."""
        start = self.now()
        self._inner.append(0.0)
        try:
            yield
        finally:
            wait_for(self._target)
            whole = self.now() - start
            self.taken[name] = self.taken.get(name, 0.0) + whole - self._inner.pop()
            if self._inner:
                self._inner[-1] += whole

    def timed(self, function: Callable[..., Any], name: str) -> Callable[..., Any]:
        """The function, told as this stage; of a shader by its label."""

        def call(*arguments: Any, **named: Any) -> Any:
            with self.stage(f"shader {arguments[0]}" if name == "shader" else name):
                return function(*arguments, **named)

        def steps(*arguments: Any, **named: Any) -> Any:
            made = function(*arguments, **named)
            while True:
                try:
                    with self.stage(name):
                        step = next(made)
                except StopIteration as end:
                    return end.value
                yield step

        return steps if isgeneratorfunction(function) else call

    @contextmanager
    def listening(self) -> Iterator[None]:
        """Every stage is timed."""
        with ExitStack() as stack:
            for owner, method, name in STAGES:
                stack.enter_context(patch.object(owner, method, self.timed(getattr(owner, method), name)))
            for module in [module for module in sys.modules.values() if hasattr(module, "build_shader")]:
                if module.__name__.startswith("curvrefl"):
                    compiled = self.timed(module.build_shader, "shader")
                    stack.enter_context(patch.object(module, "build_shader", compiled))
            yield


class Viewport:
    """A scene, its renderer and a region's picture, as the handlers have them."""

    def __init__(self, view: View, look: Look) -> None:
        self._view, self._look = view, look
        self.scene = ViewportScene()
        self.picture: RegionPicture | None = None
        self.has_pixels = False
        self._texture = empty_texture(view.width, view.height)
        self._buffer = frame_buffer(self._texture)

    def redraw(self) -> None:
        """Once."""
        chosen, options = bpy.context.scene.curvrefl, current_options()
        memory, images = options.memory_cap << 20, options.image_memory << 20
        renderer = self.scene.renderer_soon(
            bpy.context, self._look, settings_of(chosen), memory, images, self._view, SLICE_SECONDS
        )
        if renderer is None:
            if self.scene.sketch is not None:
                self.has_pixels = True
                self.scene.sketch.show(self._view, self._buffer, (0, 0, self._view.width, self._view.height))
                wait_for(self._buffer)
            return
        self.has_pixels = True
        if self.picture is None or self.picture.renderer is not renderer:
            self.picture = RegionPicture(self.scene, renderer)
        self.picture.advance(self._view, chosen, options, perf_counter(), False, {})
        self.picture.composite(self._buffer, (0, 0, self._view.width, self._view.height))
        wait_for(self._buffer)

    @property
    def is_complete(self) -> bool:
        """All that the scene needs is there, and a picture at full resolution has begun."""
        return self.picture is not None and not self.picture.is_coarse and not self.picture.progress

    @property
    def can_improve(self) -> bool:
        """Hierarchies are being built better, which changes no picture."""
        return self.picture is None or self.picture.renderer.hierarchies.can_improve


def measure(viewport: Viewport, clock: Clock, most_told: int) -> None:
    """Redraw until nothing is left, and print what each took."""
    begun = clock.now()
    longest, first_pixels, complete = (0.0, 0, ""), None, None
    with clock.listening():
        for number in range(MOST_REDRAWS):
            clock.taken.clear()
            start = clock.now()
            viewport.redraw()
            end = clock.now()
            rest = end - start - sum(clock.taken.values())
            parts = [*sorted(clock.taken.items(), key=lambda item: -item[1]), ("rest", rest)]
            told = ", ".join(f"{name} {1e3 * taken:.0f}" for name, taken in parts if taken >= 5e-4)
            longest = max(longest, (end - start, number, told))
            if number < most_told or end - start > 0.1:
                print(f"{number:4} at {end - begun:6.2f} s {1e3 * (end - start):7.1f} ms: {told}")
            if first_pixels is None and viewport.has_pixels:
                first_pixels = end - begun
            if complete is None and viewport.is_complete:
                complete = end - begun
            if complete is not None and not viewport.can_improve:
                break
            if viewport.picture is not None and viewport.picture.is_coarse and not viewport.picture.progress:
                sleep(SETTLED_SECONDS)
    whole = "never" if complete is None else f"{complete:.2f} s"
    print(f"first mirror pixels after {first_pixels:.2f} s, all there after {whole}, ", end="")
    print(f"at rest after {clock.now() - begun:.2f} s and {number + 1} redraws")
    print(f"longest redraw: {1e3 * longest[0]:.1f} ms, number {longest[1]}: {longest[2]}")


def studio_light() -> Look:
    """As Material Preview has it at first."""
    path = Path(bpy.utils.resource_path("LOCAL")) / "datafiles" / "studiolights" / "world" / "forest.exr"
    return Look(ViewportLight(False, str(path)))


def mark(mirrors: list[Any]) -> None:
    """As the panel does."""
    for mirror in mirrors:
        mirror.curvrefl.is_mirror = True


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--blend", type=Path, help="a file of one's own, seen by its camera")
    parser.add_argument("--mirrors", default="", help="names of its mirrors, with commas")
    parser.add_argument("--vertices", type=int, default=1_000_000, help="without a file: of the mesh to be mirrored")
    parser.add_argument("--studio", action="store_true", help="in the studio light of Material Preview")
    parser.add_argument("--processor", action="store_true", help="tell the processor's time")
    parser.add_argument("--told", type=int, default=12, help="redraws that are printed, beside those over 0.1 s")
    options = parser.parse_args()
    gpu.init()
    registration.register()
    if options.blend is None:
        build(1, options.vertices)
        mark([bpy.data.objects["Mirror"]])
        view = orbit(0.0)
    else:
        bpy.ops.wm.open_mainfile(filepath=str(options.blend), load_ui=False)
        scene = bpy.context.scene
        assert scene is not None
        mark(find_reflectors(scene, options.mirrors.split(",")))
        camera = scene.camera
        assert camera is not None
        view = view_of_camera(scene, camera, WIDTH, HEIGHT, bpy.context.evaluated_depsgraph_get())
    bpy.context.view_layer.update()
    viewport = Viewport(view, studio_light() if options.studio else Look(ViewportLight()))
    measure(viewport, Clock(process_time if options.processor else perf_counter), options.told)
    registration.unregister()


MOST_REDRAWS = 2000
"""Something is wrong after so many"""

if __name__ == "__main__":
    main()
