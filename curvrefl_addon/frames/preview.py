# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A range of previews into pictures or a video, frame after frame."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import bpy

from ..errors import InputError
from ..output import checked_file, clean_up, folder_to_publish, numbered
from ..report.as_shown import save_as_shown
from ..report.compare import Step
from ..report.preview import PreviewRenderer
from ..written_files import is_whole
from .progress import frames_left
from .video import VIDEOS, ending_of, is_video_of, write_video

SUFFIXES = (".png", ".exr", *VIDEOS)

type Draw = Callable[[int, Path], None]
"""Of a frame, into a file"""


@dataclass(slots=True)
class Previews:
    """What is to be saved, and what has been."""

    path: Path
    """.png or .exr, with the frame's number in place of # or before the suffix; or a video"""
    frames: range | None
    """None for the present frame alone"""
    resume: bool = False
    saved: int = 0
    """Frames that were drawn"""
    there: int = 0
    """Frames that were there already"""
    warnings: dict[str, None] = field(default_factory=dict)
    """What is not shown, a sentence each"""

    @property
    def is_video(self) -> bool:
        return self.path.suffix.lower() in VIDEOS

    def file(self, frame: int) -> Path:
        """Of a frame."""
        return self.path if self.frames is None else numbered(self.path, frame)

    def is_done(self, frame: int) -> bool:
        """Whether it is to be left out."""
        return self.resume and is_whole(self.file(frame))

    @property
    def said(self) -> str:
        """What came of it."""
        if self.frames is None:
            return f"Saved {self.path}"
        there = f", {self.there} were there already" if self.there else ""
        if self.is_video:
            return f"Saved {self.saved} frames as {self.path}" if self.saved else f"{self.path} is there already"
        return f"Saved {self.saved} pictures{there}"


def checked_previews(scene: bpy.types.Scene, path: Path, frames: range | None, resume: bool) -> Previews:
    """What a path asks for: one without a suffix gets that of the scene's output.

    Raises InputError for a path that cannot be written, and a video of one frame alone.
    """
    if not path.suffix:
        settings = scene.render.image_settings
        still = ".exr" if settings.file_format in ("OPEN_EXR", "OPEN_EXR_MULTILAYER") else ".png"
        ending = ending_of(scene) if scene.render.is_movie_format and frames is not None else still
        path = path.with_name(f"{path.name}{ending}")
    found = Previews(path, frames, resume)
    if frames is not None and not frames:
        raise InputError("There are no frames in the range: its end comes before its start.")
    if not found.is_video:
        for frame in (scene.frame_current,) if frames is None else (frames[0], frames[-1]):
            checked_file(found.file(frame), SUFFIXES)
    elif frames is None:
        raise InputError(
            f'"{path.name}" is a video, which has several frames: choose Animation, or a .png or .exr file.'
        )
    else:
        checked_file(path, SUFFIXES)
    return found


def preview_steps(
    scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer, mirrors: Sequence[str], samples: int, previews: Previews
) -> Generator[Step, None, Previews]:
    """Draw all that is asked for; yields before each frame, and returns `previews` with what came of it.

    Closed between two frames it leaves those that are done, of a video nothing, and in any case the scene as it was.
    Raises InputError for what the user can put right, OSError where files cannot be written.
    """
    clean_up(previews.path.parent)
    with _time_kept(scene), PreviewRenderer(mirrors, samples, previews.frames is not None) as renderer:

        def draw(frame: int, path: Path) -> None:
            if previews.frames is not None:
                scene.frame_set(frame)
            save_as_shown(path, renderer.render(scene, view_layer), scene)
            previews.warnings |= dict.fromkeys(renderer.warnings)
            previews.saved += 1

        if previews.is_video:
            yield from _video_steps(scene, previews, draw)
        else:
            yield from _still_steps(scene, previews, draw)
    return previews


def _still_steps(scene: bpy.types.Scene, previews: Previews, draw: Draw) -> Generator[Step]:
    frames = (scene.frame_current,) if previews.frames is None else previews.frames
    said: list[str] = []
    for frame in frames_left(frames, previews.is_done, said.append):
        yield Step(said[-1], (previews.saved + previews.there) / len(frames))
        path = previews.file(frame)
        with folder_to_publish(path.parent) as part:
            draw(frame, part / path.name)
    previews.there = len(frames) - previews.saved


def _video_steps(scene: bpy.types.Scene, previews: Previews, draw: Draw) -> Generator[Step]:
    assert previews.frames is not None, "a video is of a range"
    path, frames = previews.path, previews.frames
    if previews.resume and is_video_of(path, len(frames)):
        return
    said: list[str] = []
    with folder_to_publish(path.parent) as part:
        pictures = [part / f"{number:07d}.png" for number in range(len(frames))]
        for frame, picture in zip(frames_left(frames, lambda _frame: False, said.append), pictures, strict=False):
            yield Step(said[-1], previews.saved / len(frames))
            draw(frame, picture)
        yield Step(f"Writing {path.name}", 1.0)
        write_video(scene, pictures, part / path.name)
        for picture in pictures:
            picture.unlink()


@contextmanager
def _time_kept(scene: bpy.types.Scene) -> Iterator[None]:
    """The scene shows its present frame, by its present camera, again at the end."""
    frame, subframe, camera = scene.frame_current, scene.frame_subframe, scene.camera
    try:
        yield
    finally:
        if (scene.frame_current, scene.frame_subframe) != (frame, subframe):
            scene.frame_set(frame, subframe=subframe)
        if scene.camera != camera:
            scene.camera = camera
