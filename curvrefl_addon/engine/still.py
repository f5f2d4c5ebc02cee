# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of the open scene into a file, by an ordinary render with this engine."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy

from ..errors import InputError
from ..scene.opened.blend_file import find_camera
from ..scene.opened.render_depsgraph import use_camera
from ..scene.opened.temporary_settings import TemporarySettings, temporary_settings
from ..written_files import error_in
from .engine import ENGINE
from .job import Job, asked_for
from .passes import OF_MIRRORS


def render_still(scene: bpy.types.Scene, job: Job, width: int, height: int, path: Path, camera: str | None) -> None:
    """Render the scene's present frame into `path`: .png as shown, .exr scene-linear.

    With `job.multilayer` its passes are layers of the file, of every view layer. All else is as in the file: view
    layers, border, film, compositor, stamp. The file's own outputs of the compositor are not written. Settings are as
    before at the end. Raises InputError for what the user can put right: the camera, the reflectors; OSError where
    Blender cannot write, RuntimeError where it was stopped.
    """
    chosen = find_camera(scene, camera)
    with temporary_settings() as changes, asked_for(job):
        _use_engine(changes, scene, width, height, path, job.multilayer)
        if job.multilayer:
            switches = {OF_MIRRORS[name].setting: True for name in job.passes}
            layers: Any = scene.view_layers
            for layer in layers:
                changes.set(layer.curvrefl, **switches)
        use_camera(changes, scene, chosen)
        for node in file_outputs(scene.compositing_node_group):
            changes.set(node, mute=True)
        reason = why_not_rendered(scene, write_still=True)
    if job.error is not None:
        raise job.error
    require_all_shown(job)
    if not path.is_file():
        if reason:
            raise error_in(reason, path)
        raise RuntimeError(f'Blender did not finish the picture of scene "{scene.name}": it was stopped.')


def why_not_rendered(scene: bpy.types.Scene, **how: Any) -> str:
    """Render the scene as Blender's operator does; what that says where it fails, nothing where it does not."""
    try:
        bpy.ops.render.render(scene=scene.name, **how)
    except RuntimeError as error:
        return " ".join(str(error).removeprefix("Error:").split()).rstrip(".")
    return ""


def require_all_shown(job: Job) -> None:
    """Raises InputError where no view layer has shown some of the job's reflectors, unless they may be hidden: then
    that is a warning."""
    if not job.missing:
        return
    names = ", ".join(f'"{name}"' for name in job.reflectors if name in job.missing)
    if not job.may_be_hidden:
        raise InputError(f"{names} is hidden or not in the scene: show it or choose another reflector.")
    job.warnings.append(f"{names} is hidden or not in the scene in some frames: they are without its reflections.")


def _use_engine(
    changes: TemporarySettings, scene: bpy.types.Scene, width: int, height: int, path: Path, multilayer: bool
) -> None:
    changes.set(
        scene.render,
        engine=ENGINE,
        resolution_x=width,
        resolution_y=height,
        resolution_percentage=100,
        filepath=str(path),
        use_file_extension=False,
        use_overwrite=True,
        use_placeholder=False,
        use_sequencer=False,
        save_output=True,
    )
    is_png = path.suffix.lower() == ".png"
    changes.set(
        scene.render.image_settings,
        media_type="MULTI_LAYER_IMAGE" if multilayer else "IMAGE",
        file_format="PNG" if is_png else "OPEN_EXR_MULTILAYER" if multilayer else "OPEN_EXR",
        color_management="FOLLOW_SCENE",
        **({} if multilayer else {"color_mode": "RGBA"}),
        color_depth="8" if is_png else "32",
    )


def file_outputs(tree: bpy.types.NodeTree | None) -> Iterator[Any]:
    """Nodes of a compositor that write files, those in groups too."""
    seen: set[int] = set()
    trees: list[Any] = [] if tree is None else [tree]
    while trees:
        here = trees.pop()
        if here.session_uid in seen:
            continue
        seen.add(here.session_uid)
        for node in here.nodes:
            if node.type == "OUTPUT_FILE":
                yield node
            elif node.type == "GROUP" and node.node_tree is not None:
                trees.append(node.node_tree)
