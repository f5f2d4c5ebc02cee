# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Save what the camera sees, as the extension draws it: a still or the frame range, with or without a window."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Literal

import bpy
from bpy.props import BoolProperty, StringProperty

from ..curvrefl_addon.errors import InputError
from ..curvrefl_addon.options import marked_mirrors
from ..curvrefl_addon.settings_table import NAMED, STILL_SAMPLES
from ..curvrefl_addon.ui.table_properties import property_of
from .paths import ChoosesFile, output_path

SUFFIXES = (".png", ".exr")


class CURVREFL_OT_save_preview(ChoosesFile, bpy.types.Operator):
    """Save the camera's view with its curved reflections as a picture, or as one picture per frame"""

    bl_idname = "curvrefl.save_preview"
    bl_label = "Save Preview"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    filepath: StringProperty(  # type: ignore[valid-type]
        name="File",
        description="Picture to write, .png as it is displayed or .exr scene-linear; # stands for the frame's digits",
        subtype="FILE_PATH",
        default="//curvrefl_preview.png",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    animation: BoolProperty(  # type: ignore[valid-type]
        name="Animation", description="All frames of the scene's range, not the present one alone", default=False
    )
    samples: property_of(  # type: ignore[valid-type]
        NAMED["samples"], description="Pictures that are averaged against jagged edges", default=STILL_SAMPLES
    )
    filter_glob: StringProperty(default="*.png;*.exr", options={"HIDDEN"})  # type: ignore[valid-type]

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.scene is None or context.scene.camera is None:
            cls.poll_message_set("The scene has no active camera")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[Literal["CANCELLED", "FINISHED"]]:  # type: ignore[override]
        from ..curvrefl_addon.renderer.device.context import GpuUnavailableError

        try:
            count = self._save(context)
        except (InputError, GpuUnavailableError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Saved {count} pictures" if self.animation else f"Saved {self._path(None)}")
        return {"FINISHED"}

    def _save(self, context: bpy.types.Context) -> int:
        from ..curvrefl_addon.output import folder_to_publish
        from ..curvrefl_addon.report.as_shown import save_as_shown
        from ..curvrefl_addon.report.preview import PreviewRenderer

        scene = context.scene
        assert scene is not None
        frames = range(scene.frame_start, scene.frame_end + 1, scene.frame_step) if self.animation else [None]
        for frame in frames:
            self._path(frame)  # (before minutes of work)
        warnings: dict[str, None] = {}
        with _frame_kept(scene), PreviewRenderer(self._mirrors(context), self.samples) as renderer:
            context.window_manager.progress_begin(0, len(frames))
            try:
                for number, frame in enumerate(frames):
                    if frame is not None:
                        scene.frame_set(frame)
                    pixels, path = renderer.render(context), self._path(frame)
                    with folder_to_publish(path.parent) as part:
                        save_as_shown(part / path.name, pixels, scene)
                    warnings |= dict.fromkeys(renderer.warnings)
                    context.window_manager.progress_update(number + 1)
            finally:
                context.window_manager.progress_end()
        for warning in warnings:
            self.report({"WARNING"}, warning)
        return len(frames)

    def _mirrors(self, context: bpy.types.Context) -> list[str]:
        """Names of the marked mirrors, else of the selected meshes."""
        assert context.scene is not None
        names = [mirror.name for mirror in marked_mirrors(context.scene)]
        names = names or [obj.name for obj in context.selected_objects if obj.type == "MESH"]
        if not names:
            raise InputError("No object is marked as a mirror: mark one, or select a mesh.")
        return names

    def _path(self, frame: int | None) -> Path:
        from ..curvrefl_addon.output import checked_file, numbered

        path = output_path(self.filepath, "a file for the picture")
        if frame is not None:
            path = numbered(path, frame)
        return checked_file(path, SUFFIXES)


@contextmanager
def _frame_kept(scene: bpy.types.Scene) -> Iterator[None]:
    frame, subframe = scene.frame_current, scene.frame_subframe
    try:
        yield
    finally:
        if (scene.frame_current, scene.frame_subframe) != (frame, subframe):
            scene.frame_set(frame, subframe=subframe)


CLASSES = (CURVREFL_OT_save_preview,)
