# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the verbs read: files, names, sizes, settings, and the GPU that they need."""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from ..errors import InputError
from ..frames import progress
from ..memory import require_memory
from ..settings_table import LARGEST_SIDE, Settings
from ..streams import STDERR, STDOUT, dropped, readable
from ..supervised import stage

if TYPE_CHECKING:
    import bpy

    from ..scene.arrays import SceneArrays
    from ..scene.camera.view import View


ROOT = Path(__file__).resolve().parent.parent.parent
"""Of the source tree"""
PICTURE_BYTES = 350
"""For a pixel of a picture with all its passes, measured on a software renderer"""
SETTING = "setting_"
"""Before the names of settings among the parsed options"""


def say(text: str) -> None:
    """A line on stderr: stdout is for results."""
    print(f"curvrefl: {text}", file=sys.stderr, flush=True)


def open_scene(file: Path | str, frame: int | None = None) -> bpy.types.Scene:
    """Open the file and go to a frame of it; returns the file's active scene."""
    import bpy

    from ..scene.opened.blend_file import open_blend

    with dropped(STDOUT), stage(f'read "{file}"'):
        open_blend(file)
    scene = bpy.context.scene
    assert scene is not None, "an open file has a scene"
    if frame is not None:
        scene.frame_set(frame)
    return scene


def frames_left(options: argparse.Namespace, scene: bpy.types.Scene, is_done: Callable[[int], bool]) -> Iterator[int]:
    """The frames of `--frames`, each shown by the scene; with `--resume` without those that are done. Tells of each."""
    for frame in progress.frames_left(
        options.frames or range(0),
        lambda frame: options.resume and is_done(frame),
        lambda line: print(line, flush=True),
    ):
        with dropped(STDOUT):
            scene.frame_set(frame)
        yield frame


def resolution_of(options: argparse.Namespace, scene: bpy.types.Scene) -> tuple[int, int]:
    """The chosen width and height, or those that the scene renders with.

    Raises InputError for a picture that is too large, also for the memory that is free.
    """
    from ..scene.camera.film import rendered_size

    width, height = options.resolution or rendered_size(scene.render)
    if max(width, height) > LARGEST_SIDE:
        raise InputError(
            f"The scene renders with {width}x{height} pixels, more than {LARGEST_SIDE} a side: choose a --resolution."
        )
    require_memory(PICTURE_BYTES * width * height, f"A picture of {width}x{height}", "choose a smaller --resolution")
    return width, height


def view_layer_of(scene: bpy.types.Scene) -> bpy.types.ViewLayer:
    """The one that is in use in the open scene."""
    import bpy

    view_layer = bpy.context.view_layer
    return scene.view_layers[0] if view_layer is None else view_layer


def read_scene(
    options: argparse.Namespace, scene: bpy.types.Scene, reflectors: Sequence[str]
) -> tuple[SceneArrays, View]:
    """The open scene at its frame as it renders, with these mirrors, and what the chosen camera sees of it in the
    chosen resolution."""
    import bpy

    from ..scene.opened.render_depsgraph import read_render_scene

    size = resolution_of(options, scene)
    with stage(f'read "{bpy.data.filepath}"'):
        return read_render_scene(scene, view_layer_of(scene), reflectors, *size, options.camera)


def chosen_settings(options: argparse.Namespace) -> Settings:
    """Those that the verb's arguments set; the others are as by default."""
    return Settings(**_given(options))


def settings_of_file(options: argparse.Namespace, scene: Any) -> Settings:
    """Those that the verb's arguments set; the others are the scene's, as for F12. The extension is registered."""
    from dataclasses import replace

    from ..options import settings_of

    chosen: Any = scene.curvrefl
    return replace(settings_of(chosen, chosen.render_samples), **_given(options))


def _given(options: argparse.Namespace) -> dict[str, Any]:
    """By the settings' names, what arguments set."""
    return {name.removeprefix(SETTING): value for name, value in vars(options).items() if name.startswith(SETTING)}


@contextlib.contextmanager
def registered() -> Iterator[None]:
    """The extension's properties and its engine are Blender's for the time being.

    Where it is installed they are so already; a plain Python's Blender does not know them yet.
    """
    import bpy

    from .. import registration

    if hasattr(bpy.types.Object, "curvrefl"):
        yield
        return
    registration.register()
    try:
        yield
    finally:
        registration.unregister()


def read_names(text: str, what: str) -> list[str]:
    """The parts of a list with commas, once each. Raises InputError when there are none."""
    names = list(dict.fromkeys(name.strip() for name in readable(text).split(",") if name.strip()))
    if not names:
        raise InputError(f"Name at least one {what}.")
    return names


def require_known(names: Sequence[str], known: Sequence[str], what: str) -> None:
    for name in names:
        if name not in known:
            raise InputError(f'There is no {what} "{name}": choose from {", ".join(known)}.')


def warn_of(warnings: Sequence[str]) -> None:
    for warning in dict.fromkeys(warnings):
        say(f"Warning: {warning}")


def start_gpu() -> None:
    """Make the GPU context. Raises InputError, with how to get one, where there is none."""
    import bpy  # noqa: F401  (with the wheel, before gpu)

    from ..renderer.device.context import GpuUnavailableError, require_gpu

    try:
        # EGL tries configurations that do not match and says so, at length, though all is well.
        with dropped(STDERR):
            require_gpu()
    except GpuUnavailableError as error:
        message = str(error).rstrip(".")
        raise InputError(f"{message[:1].upper()}{message[1:]}.") from error

    from ..viewport.device_run import take_what_is_known

    if problem := take_what_is_known():
        warn_of([problem])


def repository_tool(name: str, verb: str) -> ModuleType:
    """`tools/<name>.py`, which is there in a copy of the source and not in the installed extension."""
    path = ROOT / "tools" / f"{name}.py"
    spec = importlib.util.spec_from_file_location(f"curvrefl_tools_{path.stem}", path) if path.is_file() else None
    if spec is None or spec.loader is None:
        raise InputError(f"The verb {verb} needs a copy of Curvrefl's source: call ./curvrefl {verb} there.")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
