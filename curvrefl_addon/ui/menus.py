# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's own menus and in the overlay popover."""

from __future__ import annotations

from typing import Any

import bpy

from .choices import PRESETS, active_preset
from .panel import draw_show


class CURVREFL_MT_presets(bpy.types.Menu):
    """Settings for speed or for accuracy"""

    bl_label = "Quality Presets"

    def draw(self, context: Any) -> None:
        active = active_preset(context.scene.curvrefl)
        for name, (label, _, _) in PRESETS.items():
            icon: Any = "CHECKMARK" if name == active else "BLANK1"
            self.layout.operator("curvrefl.apply_preset", text=label, icon=icon).preset = name


def draw_object_entry(self: Any, context: bpy.types.Context) -> None:
    """In the object menu and in its context menu."""
    item = context.object
    is_mirror = item is not None and item.curvrefl.is_mirror
    self.layout.separator()
    self.layout.operator("curvrefl.toggle_mirror", icon="CHECKBOX_HLT" if is_mirror else "CHECKBOX_DEHLT")


def draw_overlay_entry(self: Any, context: bpy.types.Context) -> None:
    """In the overlay popover."""
    layout = self.layout
    layout.label(text="Curvrefl")
    layout.prop(context.window_manager, "curvrefl_enabled")
    column = layout.column()
    column.active = context.window_manager.curvrefl_enabled
    if context.scene is not None:
        draw_show(column, context.scene.curvrefl)


_ENTRIES = (
    ("VIEW3D_MT_object_context_menu", draw_object_entry),
    ("VIEW3D_MT_object", draw_object_entry),
    ("VIEW3D_PT_overlay", draw_overlay_entry),
)
CLASSES = (CURVREFL_MT_presets,)


def add() -> None:
    """Put the entries into Blender's menus."""
    for menu, entry in _ENTRIES:
        getattr(bpy.types, menu).append(entry)


def remove() -> None:
    """Take them out again."""
    for menu, entry in _ENTRIES:
        getattr(bpy.types, menu).remove(entry)
