# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab in the 3D viewport's sidebar."""

from __future__ import annotations

from typing import Any

import bpy

from ..diagnostics.colors import LAMP_MODES, PATTERN_MODES
from ..options import marked_mirrors, newer_settings
from ..scene.opened.blend_file import SURFACE_TYPES
from ..scene.remarks import Remark, sentences
from ..settings_table import OF_SCENES
from .choices import PRESETS, active_preset
from .looks import draw_looks
from .messages import draw_message, draw_rows

MOST_LISTED = 12
"""Mirrors in the list of the panel"""


class _Tab:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Curvrefl"


class SubPanel(_Tab):
    bl_parent_id = "CURVREFL_PT_main"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender's own convention)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene is not None


class CURVREFL_PT_main(_Tab, bpy.types.Panel):
    """The switch, the mirrors, and what keeps them from showing"""

    bl_label = "Curved Reflections"

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.window_manager, "curvrefl_enabled", text="")

    def draw(self, context: bpy.types.Context) -> None:
        from ..renderer.proofs.verdict import known_verdict
        from ..viewport import handlers as viewport

        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        scene, item = context.scene, context.object
        if scene is None:
            return
        if item is None:
            layout.label(text="Select an object to make it a mirror", icon="INFO")
        elif item.type in SURFACE_TYPES:
            layout.prop(item.curvrefl, "is_mirror", text=f"{item.name} is a Mirror")
        else:
            layout.label(text=f"{item.name} has no surface", icon="INFO")
        mirrors = marked_mirrors(scene)
        if mirrors:
            _draw_list(layout, mirrors, context)
        else:
            draw_message(layout, "No object is marked as a mirror", context, "INFO")
        if waited_for := viewport.progress():
            layout.label(text=f"Preparing: {waited_for}", icon="TIME")
        newer = newer_settings(scene)
        of_materials = viewport.material_remarks()
        # (Each once: with the material that it concerns.)
        remarks = (Remark(cause, "material", name) for name, causes in of_materials.items() for cause in causes)
        told = frozenset(sentences(remarks))
        for message in dict.fromkeys([*([newer] if newer else []), *viewport.messages()]):
            if message not in told:
                draw_message(layout, message, context)
        if sentence := known_verdict().sentence:
            draw_message(layout, sentence, context)
            layout.operator("curvrefl.copy_report", icon="COPYDOWN")
        draw_looks(layout, of_materials, context)
        if mirrors and not context.window_manager.curvrefl_enabled and not viewport.messages():
            draw_message(layout, "Switched off: tick the box in this panel's header", context, "INFO")


class CURVREFL_PT_mirror(SubPanel, bpy.types.Panel):
    """How the active object reflects, and the map it is baked into"""

    bl_label = "Mirror"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.object is not None and context.object.curvrefl.is_mirror

    def draw(self, context: bpy.types.Context) -> None:
        from ..viewport import handlers as viewport

        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        item = context.object
        assert item is not None
        settings = item.curvrefl
        layout.prop(settings, "override")
        column = layout.column()
        column.active = settings.override
        column.prop(settings, "fresnel")
        if settings.fresnel == "DIELECTRIC":
            column.prop(settings, "ior")
        else:
            column.prop(settings, "tint")
        if rows := viewport.bake_state(item):
            draw_rows(layout, rows)
        else:
            layout.label(text="Not baked yet", icon="INFO")
        bake = layout.operator("curvrefl.bake_reflector", text="Bake to Files", icon="TEXTURE")
        bake.resolution = context.scene.curvrefl.map_resolution


class CURVREFL_PT_quality(SubPanel, bpy.types.Panel):
    """How reflections are found and how finely"""

    bl_label = "Quality"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        name = active_preset(context.scene.curvrefl)
        label = PRESETS[name][0] if name else "Custom"
        self.layout.emboss = "NONE"
        self.layout.menu("CURVREFL_MT_presets", text=label, icon="PRESET")

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.curvrefl
        for item in OF_SCENES:
            if item.panel == CURVREFL_PT_quality.bl_label:
                layout.prop(settings, item.name)


class CURVREFL_PT_environment(SubPanel, bpy.types.Panel):
    """What lights the reflected scene"""

    bl_label = "Environment"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.curvrefl
        layout.prop(settings, "environment", text="Source")
        if settings.environment == "IMAGE":
            layout.template_ID(settings, "environment_image", open="image.open")
            column = layout.column()
            column.active = settings.environment_image is not None
            column.prop(settings, "environment_strength")
            column.prop(settings, "environment_rotation")


class CURVREFL_PT_diagnostics(SubPanel, bpy.types.Panel):
    """Views that show how the reflection comes about"""

    bl_label = "Diagnostic View"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        draw_show(layout, context.scene.curvrefl)


class CURVREFL_PT_tools(SubPanel, bpy.types.Panel):
    """Operators that work with the mirrors"""

    bl_label = "Tools"

    def draw(self, context: bpy.types.Context) -> None:
        from ..viewport import tracing

        column = self.layout.column()
        column.operator("curvrefl.trace_at_cursor", icon="LIGHT_SUN")
        column.operator("curvrefl.trace_at_cursor", text="Place by Reflection", icon="PIVOT_CURSOR").place = "ACTIVE"
        if (found := tracing.shown()) is not None:
            draw_rows(column.box(), found.rows())
            column.operator("curvrefl.clear_trace", icon="X")
        column.separator()
        column.operator("curvrefl.save_preview", icon="RENDER_STILL").animation = False
        column.operator(
            "curvrefl.save_preview", text="Save Preview Animation", icon="RENDER_ANIMATION"
        ).animation = True
        column.operator("curvrefl.compare_with_cycles", icon="RENDER_RESULT")
        column.separator()
        draw_film(column, context)


class CURVREFL_PT_statistics(SubPanel, bpy.types.Panel):
    """What the last picture took"""

    bl_label = "Statistics"

    def draw(self, context: bpy.types.Context) -> None:
        from ..viewport import handlers as viewport

        draw_rows(self.layout, viewport.statistics())
        if reason := viewport.reason():
            draw_message(self.layout, reason, context, icon="INFO")
        self.layout.operator("curvrefl.copy_report", icon="COPYDOWN")


def draw_film(layout: Any, context: bpy.types.Context) -> None:
    """Whether EEVEE's renders of the scene have true mirrors, and how to get and to lose them."""
    from ..film.film import film_of

    assert context.scene is not None
    has_film = film_of(context.scene) is not None
    layout.operator(
        "curvrefl.set_up_film", text="Set Up Film Again" if has_film else "Set Up Film", icon="RENDER_ANIMATION"
    )
    if has_film:
        layout.operator("curvrefl.remove_film", icon="X")


def draw_show(layout: Any, settings: Any) -> None:
    """The diagnostic views and what they can be set to."""
    layout.prop(settings, "show")
    show = settings.show
    if show in PATTERN_MODES:
        layout.prop(settings, "stripe_count")
        if show in LAMP_MODES:
            layout.prop(settings, "stripe_width")
        layout.prop(settings, "stripe_direction")
        layout.prop(settings, "stripe_lock")
        layout.prop(settings, "stripe_softness")
    elif show == "CURVATURE":
        layout.prop(settings, "curvature_kind")
        layout.prop(settings, "curvature_range")
        layout.prop(settings, "curvature_directions")
    if show in PATTERN_MODES or show == "CURVATURE":
        layout.prop(settings, "pattern_transparency")


def _draw_list(layout: Any, mirrors: list[bpy.types.Object], context: bpy.types.Context) -> None:
    """The scene's mirrors: seen or not, and a way to make them none."""
    box = layout.box().column(align=True)
    for mirror in mirrors[:MOST_LISTED]:
        row = box.row(align=True)
        seen = mirror.visible_get(view_layer=context.view_layer)
        row.label(text=mirror.name, icon="HIDE_OFF" if seen else "HIDE_ON")
        row.prop(mirror.curvrefl, "is_mirror", text="", icon="X", emboss=False)
    if len(mirrors) > MOST_LISTED:
        box.label(text=f"and {len(mirrors) - MOST_LISTED} more")


CLASSES = (
    CURVREFL_PT_main,
    CURVREFL_PT_mirror,
    CURVREFL_PT_quality,
    CURVREFL_PT_environment,
    CURVREFL_PT_diagnostics,
    CURVREFL_PT_tools,
    CURVREFL_PT_statistics,
)
