# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""For scripts that play inside a Blender window: a script is a generator that yields what it waits for."""

from __future__ import annotations

import importlib
import shutil
import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Generator
from contextlib import AbstractContextManager
from pathlib import Path
from types import ModuleType
from typing import Any

import bpy

type Wait = float | Callable[[], bool]
"""Seconds, or a condition that will come true"""
type Script = Generator[Wait]

TICK = 0.05
PATIENCE = 600.0
"""Seconds until a condition that does not come true is given up: only a session that hangs waits so long"""
EXTENSION = "bl_ext.user_default.curvrefl"


def arguments() -> list[str]:
    """What follows `--` on the command line."""
    return sys.argv[sys.argv.index("--") + 1 :]


def install(archive: str, measures_devices: bool = False) -> None:
    """The extension, enabled. `measures_devices`: as its preference; without it `auto` chooses alike everywhere."""
    bpy.context.preferences.view.show_splash = False
    bpy.ops.extensions.package_install_files(repo="user_default", filepath=archive, enable_on_install=True)
    bpy.context.preferences.addons[EXTENSION].preferences.measures_devices = measures_devices


def extension(name: str) -> ModuleType:
    """A module of the installed extension: `curvrefl_addon.viewport.handlers`."""
    return importlib.import_module(f"{EXTENSION}.{name}")


def view_3d() -> tuple[bpy.types.Area, bpy.types.SpaceView3D, bpy.types.Region]:
    window = bpy.context.window_manager.windows[0]
    area: Any = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return area, area.spaces[0], next(region for region in area.regions if region.type == "WINDOW")


def rests() -> bool:
    """All 3D regions have complete pictures."""
    pictures = extension("curvrefl_addon.viewport.handlers").pictures().values()
    return bool(pictures) and all(picture.is_complete and not picture.is_coarse for picture in pictures)


def screenshot(path: Path) -> None:
    """A picture of the screen where ImageMagick is there; Blender's own is black on a virtual screen."""
    if shutil.which("import"):
        subprocess.run(["import", "-window", "root", str(path)], check=True)


def in_view() -> AbstractContextManager[Any]:
    """A context with window, area and region, which operators called from a timer lack."""
    area, _space, region = view_3d()
    return bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=region)


def play(script: Script, on_end: Callable[[str], None]) -> None:
    """Play the script from a timer; at its end `on_end` gets the traceback of what stopped it, or nothing."""
    wait: Wait = 0.0
    deadline = 0.0

    def advance() -> float | None:
        nonlocal wait, deadline
        try:
            if callable(wait) and not wait():
                if time.monotonic() < deadline:
                    return TICK
                wait = script.throw(TimeoutError(f"{getattr(wait, '__qualname__', wait)} did not come true"))
            else:
                wait = next(script)
        except StopIteration:
            on_end("")
            return None
        except Exception:
            on_end(traceback.format_exc())
            return None
        deadline = time.monotonic() + PATIENCE
        return TICK if callable(wait) else wait

    bpy.app.timers.register(advance, first_interval=2.0, persistent=True)
