# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of the open scene into files: each is there whole or not at all, and a video as one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bpy

from ..engine.job import Job, asked_for
from ..engine.still import file_outputs, require_all_shown, why_not_rendered
from ..frames.progress import Pace, frames_left
from ..frames.video import VIDEOS, ending_of, is_video_of, use_video
from ..output import clean_up, folder_to_publish, numbered
from ..scene.opened.blend_file import find_camera
from ..scene.opened.render_depsgraph import use_camera
from ..scene.opened.temporary_settings import TemporarySettings, temporary_settings
from ..written_files import error_in, is_whole, require_whole
from .wiring import layers_files

STILLS = {".png": "PNG", ".exr": "OPEN_EXR"}
LAYERS_END = "_layers"
"""Behind a picture's name, of the file with its layers"""

type Said = Callable[[str], None]


def render_frames(
    scene: Any,
    frames: range,
    output: Path,
    job: Job,
    camera: str | None = None,
    resume: bool = False,
    say: Said = print,
) -> int:
    """Render `frames` of a scene that has its film into `output`; returns how many were rendered.

    `output`: a file .png or .exr, with the frame's number in place of #, or before the suffix where there are more; a
    video; or a folder, for files as the scene's output says. `resume` leaves out frames that are there whole, and a
    video with as many. Settings are as before at the end. Raises InputError for what the user can put right, OSError
    where files cannot be written, RuntimeError where Blender was stopped.
    """
    chosen = find_camera(scene, camera)
    clean_up(output.parent if output.suffix else output)
    with temporary_settings() as changes:
        changes.set(scene.render, use_sequencer=False, save_output=True, use_overwrite=True, use_placeholder=False)
        if camera is not None:
            # (Else markers choose, at each frame.)
            use_camera(changes, scene, chosen)
        own = set(layers_files(scene))
        for node in file_outputs(scene.compositing_node_group):
            if node not in own:
                changes.set(node, mute=True)
        suffix = output.suffix.lower()
        if suffix in VIDEOS:
            use_video(changes, scene, suffix)
        elif suffix in STILLS:
            _use_still(changes, scene, STILLS[suffix])
        if scene.render.is_movie_format:
            if suffix not in VIDEOS:
                output = output / f"{Path(scene.render.filepath).name or scene.name}{ending_of(scene)}"
            if resume and is_video_of(output, len(frames)):
                say(f"{output.name} is there already")
                return 0
            return _video(changes, scene, frames, output, job, say)
        if suffix not in STILLS:
            output = output / f"{Path(scene.render.filepath).name}####{scene.render.file_extension}"

        def is_done(frame: int) -> bool:
            path = numbered(output, frame, len(frames) > 1)
            return resume and all(map(is_whole, [path, *([_layers_of(path)] if own else [])]))

        count = 0
        for frame in frames_left(frames, is_done, say):
            _still(changes, scene, frame, numbered(output, frame, len(frames) > 1), job)
            count += 1
        return count


def _still(changes: TemporarySettings, scene: Any, frame: int, path: Path, job: Job) -> None:
    scene.frame_set(frame)
    with folder_to_publish(path.parent) as folder:
        changes.set(scene.render, filepath=str(folder / path.name), use_file_extension=False)
        for node in layers_files(scene):
            changes.set(node, directory=str(folder), file_name=f"{path.stem}{LAYERS_END}")
        _render(scene, job, folder / path.name, write_still=True)
        for layers in folder.glob(f"{path.stem}{LAYERS_END}*"):
            # (Blender puts the frame's number behind the name, which has it already.)
            layers.rename(_layers_of(folder / path.name))


def _layers_of(picture: Path) -> Path:
    """The file with the layers of a picture."""
    return picture.with_name(f"{picture.stem}{LAYERS_END}.exr")


def _video(changes: TemporarySettings, scene: Any, frames: range, path: Path, job: Job, say: Said) -> int:
    changes.set(scene, frame_start=frames[0], frame_end=frames[-1], frame_step=frames.step, use_preview_range=False)
    with folder_to_publish(path.parent) as folder, _told(frames, say):
        changes.set(scene.render, filepath=str(folder / path.name), use_file_extension=False)
        for node in layers_files(scene):
            changes.set(node, directory=str(folder), file_name=f"{path.stem}{LAYERS_END}_")
        _render(scene, job, folder / path.name, animation=True)
    return len(frames)


def _render(scene: Any, job: Job, path: Path, **how: Any) -> None:
    """Raises what went wrong, also where Blender has written a file all the same."""
    job.missing = set(job.reflectors)
    with asked_for(job):
        reason = why_not_rendered(scene, **how)
    if job.error is not None:
        raise job.error
    if reason:
        raise error_in(reason, path)
    require_all_shown(job)
    if not path.is_file():
        raise RuntimeError(f'Blender did not finish the picture of scene "{scene.name}": it was stopped.')
    require_whole(path)


@contextmanager
def _told(frames: Sequence[int], say: Said) -> Iterator[None]:
    """A line for each frame that a video is about to get."""
    pace = Pace(len(frames))

    def written(scene: Any, *_arguments: Any) -> None:
        pace.done()
        if pace.number <= pace.count:
            say(f"Frame {pace.place_of(frames[pace.number - 1])}")

    say(f"Frame {pace.place_of(frames[0])}")
    bpy.app.handlers.render_write.append(written)
    try:
        yield
    finally:
        bpy.app.handlers.render_write.remove(written)


def _use_still(changes: TemporarySettings, scene: Any, file_format: str) -> None:
    settings = scene.render.image_settings
    is_png = file_format == "PNG"
    changes.set(
        settings,
        media_type="IMAGE",
        file_format=file_format,
        color_management="FOLLOW_SCENE",
        color_mode="RGBA",
        color_depth="8" if is_png else "32",
    )
