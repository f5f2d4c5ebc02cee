# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opening a .blend file and finding in it what the user named; every mistake is an InputError of one sentence."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from pathlib import Path

import bpy
import numpy as np

from ..errors import InputError
from .extract import SURFACE_TYPES
from .view import View


def open_blend(path: str | Path) -> bpy.types.Scene:
    """Open the file and return its active scene, set to show what a render would."""
    path = Path(path)
    if not path.is_file():
        raise InputError(f"There is no file {path}.")
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path.resolve()), load_ui=False)
    except RuntimeError as error:
        raise InputError(f"{path} could not be opened as a .blend file: it is damaged or of another kind.") from error
    scene = bpy.context.scene
    show_as_rendered(scene)
    return scene


def show_as_rendered(scene: bpy.types.Scene) -> None:
    """Make the viewport's evaluation that of a render: visibility, modifiers, subdivision levels.

    Python can only evaluate for the viewport. Changes the open file's data; meant for a file opened to be rendered.
    """
    for item in scene.objects:
        item.hide_viewport = item.hide_render
        if item.name in bpy.context.view_layer.objects:
            item.hide_set(False)
        for modifier in item.modifiers:
            modifier.show_viewport = modifier.show_render
            if modifier.type in ("SUBSURF", "MULTIRES"):
                modifier.levels = modifier.render_levels
    for collection in scene.collection.children_recursive:
        collection.hide_viewport = collection.hide_render

    def unhide(layer: bpy.types.LayerCollection) -> None:
        layer.hide_viewport = False
        for child in layer.children:
            unhide(child)

    unhide(bpy.context.view_layer.layer_collection)
    bpy.context.view_layer.update()


def find_camera(scene: bpy.types.Scene, name: str | None = None) -> bpy.types.Object:
    """The named camera, or the scene's own."""
    if name is None:
        if scene.camera is None:
            raise InputError("The scene has no camera: add one, or name one with --camera.")
        return scene.camera
    cameras = [item.name for item in scene.objects if item.type == "CAMERA"]
    if name not in cameras:
        raise InputError(f'There is no camera "{name}".{_near(name, cameras)}')
    return scene.objects[name]


def view_of_camera(
    scene: bpy.types.Scene,
    camera: bpy.types.Object,
    width: int,
    height: int,
    depsgraph: bpy.types.Depsgraph | None = None,
) -> View:
    """What the camera sees in a picture of `width` x `height` square pixels."""
    depsgraph = depsgraph or bpy.context.evaluated_depsgraph_get()
    evaluated = camera.evaluated_get(depsgraph)
    if evaluated.type == "CAMERA" and evaluated.data.type == "PANO":
        raise InputError(f'"{camera.name}" is a panoramic camera: use a perspective or orthographic one.')
    projection = np.array(
        evaluated.calc_matrix_camera(
            depsgraph, x=width, y=height, scale_x=scene.render.pixel_aspect_x, scale_y=scene.render.pixel_aspect_y
        )
    )
    # A scaled camera sees no differently: only its turn and place count.
    world = evaluated.matrix_world.normalized()
    return View(np.linalg.inv(np.array(world)), projection, width, height)


def find_reflectors(scene: bpy.types.Scene, names: Sequence[str]) -> list[bpy.types.Object]:
    """The named objects, in order and each once."""
    if not names:
        raise InputError("Name at least one reflector.")
    surfaces = [item.name for item in scene.objects if item.type in SURFACE_TYPES]
    found = []
    for name in dict.fromkeys(names):
        if name not in scene.objects:
            raise InputError(f'There is no object "{name}".{_near(name, surfaces)}')
        item = scene.objects[name]
        if item.type not in SURFACE_TYPES:
            raise InputError(f'"{name}" is a {item.type.lower()}, not a mesh: a reflector needs a surface.')
        found.append(item)
    return found


def _near(name: str, names: Sequence[str]) -> str:
    """A hint at what was meant, with a space before it; empty where there is nothing near."""
    lower = {item.lower(): item for item in names}
    matches = difflib.get_close_matches(name.lower(), list(lower), n=3, cutoff=0.4)
    if matches:
        return " Did you mean " + " or ".join(f'"{lower[match]}"' for match in matches) + "?"
    if names:
        return " There are: " + ", ".join(f'"{item}"' for item in names[:8]) + "."
    return ""
