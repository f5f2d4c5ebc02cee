# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Bake a material of which something is not drawn into images that are drawn in its place."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from collections.abc import Iterator
from typing import Any, Literal

import bpy
from bpy.props import IntProperty, StringProperty

from ..curvrefl_addon.errors import InputError
from .looks.bake import Step, bake_look, forget_look

type Result = set[Literal["CANCELLED", "FINISHED", "RUNNING_MODAL", "PASS_THROUGH"]]
NAMES = {
    "base_color": "base color",
    "surface": "metallic, roughness and alpha",
    "layers": "transmission, IOR level and coat",
    "emission": "emission",
    "normal": "normals",
}


class CURVREFL_OT_bake_look(bpy.types.Operator):
    """Bake the material's channels by Cycles into images, which Curvrefl draws in its place until its nodes change"""

    bl_idname = "curvrefl.bake_look"
    bl_label = "Bake Look"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender's own convention)

    material: StringProperty(  # type: ignore[valid-type]
        name="Material", description="Name of the material; the active one if empty"
    )
    resolution: IntProperty(  # type: ignore[valid-type]
        name="Resolution", description="Pixels along a side of the images", default=1024, min=16, max=16384
    )
    samples: IntProperty(  # type: ignore[valid-type]
        name="Samples", description="Cycles' samples: more where nodes such as Ambient Occlusion are noisy", default=64,
        min=1, max=65536,
    )  # fmt: skip

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.scene is None or context.mode != "OBJECT":
            cls.poll_message_set("Only in Object Mode")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> Result:  # type: ignore[override]
        try:
            for _ in self._steps(context):
                pass
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return self._done(context)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> Result:  # type: ignore[override]
        manager = context.window_manager
        self._baking = self._steps(context)
        self._timer = manager.event_timer_add(0.01, window=context.window)
        manager.progress_begin(0.0, 1.0)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> Result:  # type: ignore[override]
        if event.type == "ESC":
            self.cancel(context)
            self.report({"INFO"}, "Nothing was baked")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            step = next(self._baking)
        except StopIteration:
            self._leave(context)
            return self._done(context)
        except InputError as error:
            self._leave(context)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.window_manager.progress_update(step.number / step.count)
        place = f"{step.number + 1} of {step.count}"
        context.workspace.status_text_set(f"Baking {NAMES[step.holds]} of {self._name} ({place}). Esc: stop")
        return {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Leave the file as it was."""
        self._baking.close()
        self._leave(context)

    def _leave(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)

    def _steps(self, context: bpy.types.Context) -> Iterator[Step]:
        material = _material(self.material, context)
        self._name = material.name
        scene, view_layer = context.scene, context.view_layer
        assert scene is not None and view_layer is not None
        yield from bake_look(scene, view_layer, material, self.resolution, self.samples)

    def _done(self, context: bpy.types.Context) -> Result:
        self.report({"INFO"}, f'The look of "{self._name}" is drawn in its place until its nodes change')
        for area in context.screen.areas if context.screen is not None else ():
            area.tag_redraw()
        return {"FINISHED"}


class CURVREFL_OT_forget_look(bpy.types.Operator):
    """Remove the images that were baked of the material, and draw its nodes"""

    bl_idname = "curvrefl.forget_look"
    bl_label = "Remove Look"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender's own convention)

    material: StringProperty(  # type: ignore[valid-type]
        name="Material", description="Name of the material; the active one if empty"
    )

    def execute(self, context: bpy.types.Context) -> Result:  # type: ignore[override]
        try:
            material = _material(self.material, context)
        except InputError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        forget_look(material)
        material.update_tag()
        return {"FINISHED"}


def _material(name: str, context: bpy.types.Context) -> Any:
    if name:
        if name not in bpy.data.materials:
            raise InputError(f'There is no material "{name}".')
        return bpy.data.materials[name]
    active = context.object.active_material if context.object is not None else None
    if active is None:
        raise InputError("No material: name one, or make an object active that has one.")
    return active


CLASSES = (CURVREFL_OT_bake_look, CURVREFL_OT_forget_look)
