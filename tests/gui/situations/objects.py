# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that are deleted, emptied, edited or linked."""

from __future__ import annotations

from pathlib import Path

import bpy
from scripted import in_view
from situations.opened_file import (
    BLOCK,
    CAUSED,
    FOLDER,
    MIRROR,
    Steps,
    active,
    block,
    mirror,
    opened,
    redraws,
    situation,
)


def mode(name: str) -> None:
    with in_view():
        bpy.ops.object.mode_set(mode=name)


@situation
def scenery_deleted() -> Steps:
    bpy.data.objects.remove(block())
    yield CAUSED


@situation
def mirror_deleted() -> Steps:
    bpy.data.objects.remove(mirror())
    yield CAUSED
    yield from opened()


def emptied(item: bpy.types.Object) -> Steps:
    active(item)
    mode("EDIT")
    with in_view():
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.delete(type="VERT")
    yield from redraws(2)
    mode("OBJECT")
    yield CAUSED
    yield from opened()


@situation
def scenery_emptied() -> Steps:
    yield from emptied(block())


@situation
def mirror_emptied() -> Steps:
    yield from emptied(mirror())


def edited(item: bpy.types.Object) -> Steps:
    active(item)
    mode("EDIT")
    yield from redraws(2)
    with in_view():
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.transform.resize(value=(0.9, 0.9, 0.9))
    yield CAUSED
    mode("OBJECT")


@situation
def scenery_in_edit_mode() -> Steps:
    yield from edited(block())


@situation
def mirror_in_edit_mode() -> Steps:
    yield from edited(mirror())


def sculpted(item: bpy.types.Object) -> Steps:
    active(item)
    mode("SCULPT")
    yield from redraws(2)
    with in_view():
        bpy.ops.sculpt.mesh_filter("EXEC_DEFAULT", type="SCALE", strength=0.2)
    yield from redraws(2)
    with in_view():
        # A filter changes nothing without a mouse; this does.
        bpy.ops.sculpt.symmetrize()
    yield CAUSED
    mode("OBJECT")


@situation
def scenery_in_sculpt_mode() -> Steps:
    yield from sculpted(block())


@situation
def mirror_in_sculpt_mode() -> Steps:
    yield from sculpted(mirror())


def library() -> str:
    """A file to link from: the one that is open, its ball a mirror."""
    path = str(Path(FOLDER) / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    return path


def linked(name: str) -> Steps:
    path = library()
    bpy.data.objects.remove(bpy.data.objects[name])
    with bpy.data.libraries.load(path, link=True) as (_there, here):
        here.objects = [name]
    bpy.context.scene.collection.objects.link(here.objects[0])
    yield CAUSED


@situation
def scenery_linked() -> Steps:
    yield from linked(BLOCK)


@situation
def mirror_linked() -> Steps:
    yield from linked(MIRROR)
