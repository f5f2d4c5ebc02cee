# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What all situations start from: a file in the window, drawing; and where they are collected."""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import Any

import bpy
from scripted import Script, Wait, arguments, extension, in_view, view_3d

ARCHIVE, BLEND, FOLDER = arguments()[:3]
MIRROR, BLOCK = "Mirror Ball", "Block"
SAMPLES = 2
REDRAWS = 6
"""Enough to see a traceback that comes with every redraw"""

CAUSED = "caused"
type Steps = Generator[Wait | str]
"""Waits; after CAUSED the cause is put right"""

SITUATIONS: dict[str, Callable[[], Steps]] = {}
seen: dict[str, Any] = {"situations": {}}
"""By name, in the order played; and "all", the names of those there are"""


def situation(function: Callable[[], Steps]) -> Callable[[], Steps]:
    SITUATIONS[function.__name__] = function
    return function


def mirror() -> bpy.types.Object:
    return bpy.data.objects[MIRROR]


def block() -> bpy.types.Object:
    return bpy.data.objects[BLOCK]


def drawn() -> int:
    return extension("curvrefl_addon.viewport.handlers").counters().get("sub-frames", 0)


def redraws(count: int = REDRAWS) -> Script:
    for _ in range(count):
        view_3d()[0].tag_redraw()
        yield 0.1


def opened() -> Script:
    """The file in the window, drawing."""
    if bpy.context.object and bpy.context.object.mode != "OBJECT":
        with in_view():
            bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.window_manager.curvrefl_enabled = False
    bpy.ops.wm.open_mainfile(filepath=BLEND, load_ui=False)
    yield 0.2
    _area, space, _region = view_3d()
    space.overlay.show_overlays = False
    space.shading.type = "SOLID"
    space.region_3d.view_perspective = "CAMERA"
    bpy.context.scene.curvrefl.samples = SAMPLES
    mirror().curvrefl.is_mirror = True
    yield from switched_on()


def switched_on() -> Script:
    """Off and on again, until something is drawn."""
    bpy.context.window_manager.curvrefl_enabled = False
    yield 0.1
    before = drawn()
    bpy.context.window_manager.curvrefl_enabled = True
    yield lambda: drawn() >= before + SAMPLES or bool(extension("curvrefl_addon.viewport.handlers").messages())
    yield 0.1


def active(item: bpy.types.Object) -> None:
    for other in bpy.context.view_layer.objects:
        other.select_set(other == item)
    bpy.context.view_layer.objects.active = item
