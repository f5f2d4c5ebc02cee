# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Save what the camera sees, as the extension draws it: a still or a range of frames, with or without a window."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from collections.abc import Generator
from typing import Any

import bpy
from bpy.props import BoolProperty, IntProperty, StringProperty

from ..curvrefl_addon.errors import InputError
from ..curvrefl_addon.options import marked_mirrors
from ..curvrefl_addon.settings_table import NAMED, STILL_SAMPLES
from ..curvrefl_addon.ui.table_properties import property_of
from .modal.steps import TakesSteps
from .paths import ChoosesFile, output_path

RANGE = ("frame_start", "frame_end", "frame_step")
"""Properties that are the scene's own where nobody has set them"""


class CURVREFL_OT_save_preview(TakesSteps, ChoosesFile, bpy.types.Operator):
    """Save the camera's view with its curved reflections as a picture, as one picture per frame, or as a video"""

    bl_idname = "curvrefl.save_preview"
    bl_label = "Save Preview"
    bl_options = {"REGISTER"}  # noqa: RUF012 (Blender's own convention)

    doing = "Saving previews"
    canceled = "Canceled: frames that are done stay"

    filepath: StringProperty(  # type: ignore[valid-type]
        name="File",
        description="Picture to write, .png as it is displayed or .exr scene-linear, # for the frame's digits; or a "
        "video, .mp4, .mov, .mkv or .webm; without an ending as the scene's output",
        subtype="FILE_PATH",
        default="//curvrefl_preview.png",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    animation: BoolProperty(  # type: ignore[valid-type]
        name="Animation", description="All frames of a range, not the present one alone", default=False
    )
    frame_start: IntProperty(  # type: ignore[valid-type]
        name="Start", description="First frame of the range (the scene's)", default=1
    )
    frame_end: IntProperty(  # type: ignore[valid-type]
        name="End", description="Last frame of the range (the scene's)", default=250
    )
    frame_step: IntProperty(  # type: ignore[valid-type]
        name="Step", description="From one frame to the next (the scene's)", default=1, min=1
    )
    resume: BoolProperty(  # type: ignore[valid-type]
        name="Resume",
        description="Leave out frames whose pictures are there whole, and a video that has as many frames",
        default=False,
    )
    samples: property_of(  # type: ignore[valid-type]
        NAMED["samples"], description="Pictures that are averaged against jagged edges", default=STILL_SAMPLES
    )
    filter_glob: StringProperty(  # type: ignore[valid-type]
        default="*.png;*.exr;*.mp4;*.mov;*.mkv;*.webm", options={"HIDDEN"}
    )

    _is_in_window = False

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.scene is None or context.scene.camera is None:
            cls.poll_message_set("The scene has no active camera")
            return False
        return True

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Any:
        """A caller that has set the file is not asked for it."""
        assert context.scene is not None
        self._is_in_window = not bpy.app.background
        for name in RANGE:
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(context.scene, name))
        if self.properties.is_property_set("filepath"):
            return self.execute(context)
        return super().invoke(context, event)

    def execute(self, context: bpy.types.Context) -> Any:
        """In a window that the user has called it from, frame by frame between redraws; else all at once."""
        from ..curvrefl_addon.renderer.device.context import GpuUnavailableError

        try:
            steps = self._steps_of(context)
            if self._is_in_window and self.animation:
                return self.begin(context, steps)
            self.finish(context, self._taken(context, steps))
        except (InputError, GpuUnavailableError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "samples")
        layout.prop(self, "animation")
        column = layout.column(align=True)
        column.active = self.animation
        for name in (*RANGE, "resume"):
            column.prop(self, name)

    def finish(self, context: bpy.types.Context, result: Any) -> None:
        for warning in result.warnings:
            self.report({"WARNING"}, warning)
        self.report({"INFO"}, result.said)

    def _steps_of(self, context: bpy.types.Context) -> Generator[Any, None, Any]:
        from ..curvrefl_addon.frames.preview import checked_previews, preview_steps

        scene, view_layer = context.scene, context.view_layer
        assert scene is not None and view_layer is not None
        mirrors = self._mirrors(context)
        path = output_path(self.filepath, "a file for the picture")
        previews = checked_previews(scene, path, self._range(scene) if self.animation else None, self.resume)
        return preview_steps(scene, view_layer, mirrors, self.samples, previews)

    def _range(self, scene: bpy.types.Scene) -> range:
        start, end, step = (getattr(self if self.properties.is_property_set(name) else scene, name) for name in RANGE)
        return range(start, end + 1, step)

    def _taken(self, context: bpy.types.Context, steps: Generator[Any, None, Any]) -> Any:
        """All of the steps; returns what they return."""
        manager = context.window_manager
        manager.progress_begin(0, 100)
        try:
            while True:
                step = next(steps)
                manager.progress_update(100.0 * step.done)
                if bpy.app.background and self.animation:
                    print(step.label, flush=True)
        except StopIteration as end:
            return end.value
        finally:
            manager.progress_end()

    def _mirrors(self, context: bpy.types.Context) -> list[str]:
        """Names of the marked mirrors, else of the selected meshes."""
        assert context.scene is not None
        names = [mirror.name for mirror in marked_mirrors(context.scene)]
        names = names or [obj.name for obj in context.selected_objects if obj.type == "MESH"]
        if not names:
            raise InputError("No object is marked as a mirror: mark one, or select a mesh.")
        return names


CLASSES = (CURVREFL_OT_save_preview,)
