# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Videos by Blender's own writer: which containers there are, and pictures that are there already as one of them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bpy

from ..scene.opened.temporary_settings import TemporarySettings, temporary_settings
from ..streams import STDERR, dropped
from ..written_files import error_in, is_whole, require_whole

VIDEOS = {".mp4": "MPEG4", ".mov": "QUICKTIME", ".mkv": "MKV", ".webm": "WEBM"}
_OTHERS = {"AVI": ".avi", "DV": ".dv", "FLASH": ".flv", "MPEG1": ".mpg", "MPEG2": ".mpg", "OGG": ".ogv"}


def ending_of(scene: Any) -> str:
    """The suffix of the videos that a scene renders, which it does."""
    endings = {container: suffix for suffix, container in VIDEOS.items()} | _OTHERS
    return endings[scene.render.ffmpeg.format]


def use_video(changes: TemporarySettings, scene: Any, suffix: str) -> None:
    """The scene's own codec where it writes such a container already, else that which plays everywhere."""
    settings, ffmpeg, container = scene.render.image_settings, scene.render.ffmpeg, VIDEOS[suffix]
    if scene.render.is_movie_format and ffmpeg.format == container:
        return
    changes.set(settings, media_type="VIDEO", file_format="FFMPEG", color_management="FOLLOW_SCENE", color_mode="RGB")
    changes.set(ffmpeg, format=container, codec="WEBM" if container == "WEBM" else "H264", audio_codec="NONE")
    changes.set(ffmpeg, constant_rate_factor="HIGH")


def is_video_of(path: Path, count: int) -> bool:
    """Whether a video is there whole and has so many frames."""
    if not is_whole(path):
        return False
    try:
        clip = bpy.data.movieclips.load(str(path))
    except RuntimeError:  # (it is none)
        return False
    try:
        return clip.frame_duration == count
    finally:
        bpy.data.movieclips.remove(clip)


def write_video(scene: Any, pictures: Sequence[Path], path: Path) -> None:
    """Pictures (.png, of one size, in one folder) one after the other as a video, their bytes as they are.

    Frame rate, codec and quality are the scene's where it renders such videos. Raises OSError where the file cannot be
    written, or not whole.
    """
    double: Any = scene.copy()
    try:
        _show(double, pictures)
        render = double.render
        render.filepath, render.use_file_extension = str(path), False
        with temporary_settings() as changes:
            use_video(changes, double, path.suffix.lower())
            # (That of the sequencer has been seen: what comes of it is read.)
            double.render.image_settings.color_management = "FOLLOW_SCENE"
            reason = _rendered(double)
        if reason:
            raise error_in(reason, path)
        require_whole(path)
    finally:
        bpy.data.scenes.remove(double)


def _rendered(scene: Any) -> str:
    """Render all frames; what Blender says where it fails."""
    try:
        with dropped(STDERR):
            bpy.ops.render.render(scene=scene.name, animation=True)
    except RuntimeError as error:
        return " ".join(str(error).removeprefix("Error:").split()).rstrip(".")
    return ""


def _show(scene: Any, pictures: Sequence[Path]) -> None:
    """Have the sequencer show the pictures, and no color management between them and the file."""
    if scene.sequence_editor is not None:
        scene.sequence_editor_clear()
    first: Any = bpy.data.images.load(str(pictures[0]))
    width, height = tuple(first.size)
    bpy.data.images.remove(first)
    strip = scene.sequence_editor_create().strips.new_image("pictures", str(pictures[0]), channel=1, frame_start=1)
    for picture in pictures[1:]:
        strip.elements.append(picture.name)
    scene.frame_start, scene.frame_end, scene.frame_step = 1, len(pictures), 1
    scene.use_preview_range = False
    # What is encoded as for such a display goes through to such a display.
    strip.colorspace_settings.name = scene.sequencer_colorspace_settings.name = "sRGB"
    scene.display_settings.display_device = "sRGB"
    view = scene.view_settings
    view.view_transform, view.look, view.exposure, view.gamma = "Standard", "None", 0.0, 1.0
    view.use_curve_mapping = view.use_white_balance = False
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.use_sequencer, render.use_compositing, render.use_multiview = True, False, False
    render.use_border = render.use_stamp = False
    render.use_overwrite, render.use_placeholder = True, False
    scene.timeline_markers.clear()
