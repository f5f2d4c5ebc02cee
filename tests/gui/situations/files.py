# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""History, and other files."""

from __future__ import annotations

from pathlib import Path

import bpy
from scripted import in_view
from situations.opened_file import BLOCK, CAUSED, FOLDER, Steps, active, block, opened, redraws, seen, situation


@situation
def undo_and_redo() -> Steps:
    with in_view():
        bpy.ops.ed.undo_push(message="before")
        active(block())
        bpy.ops.object.delete()
        bpy.ops.ed.undo_push(message="deleted")
    yield from redraws(2)
    with in_view():
        bpy.ops.ed.undo()
    yield from redraws(2)
    seen["block after undo"] = BLOCK in bpy.data.objects
    with in_view():
        bpy.ops.ed.redo()
    yield from redraws(2)
    with in_view():
        bpy.ops.ed.undo()
    yield CAUSED


@situation
def new_file() -> Steps:
    bpy.ops.wm.read_homefile(use_factory_startup=True, load_ui=False)
    yield CAUSED
    yield from opened()


@situation
def file_loaded_while_drawing() -> Steps:
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(FOLDER) / "other.blend"), copy=True)
    bpy.ops.wm.open_mainfile(filepath=str(Path(FOLDER) / "other.blend"), load_ui=False)
    yield from redraws(2)
    bpy.context.window_manager.curvrefl_enabled = True
    yield CAUSED


@situation
def file_of_a_newer_version() -> Steps:
    path = str(Path(FOLDER) / "newer.blend")
    stored = bpy.context.scene.bl_system_properties_get(do_create=True)["curvrefl"]
    stored["method"] = 57
    stored["from_the_future"] = "mirrors in mirrors"
    if "version" in bpy.context.scene.curvrefl.bl_rna.properties:
        stored["version"] = 1000
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    bpy.context.window_manager.curvrefl_enabled = True
    yield CAUSED
    yield from opened()
