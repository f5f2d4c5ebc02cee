# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the properties editor where the render engine is chosen."""

from __future__ import annotations

from typing import Any

import bpy

from ..engine.engine import ENGINE
from ..film.film import EEVEE
from ..options import marked_mirrors
from ..settings_table import OF_SCENES, OF_VIEW_LAYERS
from .panel import draw_film


def _column(layout: Any) -> Any:
    """A layout, for settings one below the other."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


class _OfEngine:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return getattr(context, "engine", "") == ENGINE


class CURVREFL_RENDER_PT_quality(_OfEngine, bpy.types.Panel):
    """How renders find reflections"""

    bl_label = "Curved Reflections"
    bl_context = "render"

    def draw(self, context: bpy.types.Context) -> None:
        layout = _column(self.layout)
        for item in OF_SCENES:
            # (Samples and motion are the viewports'.)
            if item.panel == "Quality" and item.name not in ("samples", "motion_resolution"):
                layout.prop(context.scene.curvrefl, item.name)


class CURVREFL_VIEW_LAYER_PT_passes(_OfEngine, bpy.types.Panel):
    """What renders have beside the picture"""

    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        layout = _column(self.layout)
        for item in OF_VIEW_LAYERS:
            layout.prop(context.view_layer.curvrefl, item.name)


class CURVREFL_RENDER_PT_film(bpy.types.Panel):
    """EEVEE's renders with true mirrors"""

    bl_label = "Curved Reflections"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 (Blender's own convention)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return (
            getattr(context, "engine", "") == EEVEE
            and context.scene is not None
            and bool(marked_mirrors(context.scene))
        )

    def draw(self, context: bpy.types.Context) -> None:
        layout = _column(self.layout)
        layout.prop(context.scene.curvrefl, "render_samples")
        layout.prop(context.scene.curvrefl, "reuse_frames")
        draw_film(layout, context)


CLASSES = (CURVREFL_RENDER_PT_film, CURVREFL_RENDER_PT_quality, CURVREFL_VIEW_LAYER_PT_passes)
