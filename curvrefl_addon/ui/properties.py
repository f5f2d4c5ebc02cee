# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of objects and scenes, saved in the .blend file, and the switch, which is not."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import BoolProperty, IntProperty, PointerProperty

from ..options import SETTINGS_VERSION, current_options
from ..settings_table import OF_OBJECTS, OF_SCENES, OF_VIEW_LAYERS
from .table_properties import properties_of


def _is_switched(_self: Any, context: bpy.types.Context) -> None:
    from ..viewport import handlers as viewport

    enabled = context.window_manager.curvrefl_enabled
    if enabled:
        use_defaults()
    viewport.switch(enabled)


def _mirrors_changed(_self: Any, _context: bpy.types.Context | None) -> None:
    from ..film.follow import follow_films
    from ..viewport import handlers as viewport

    follow_films()
    viewport.mirrors_changed()


def _settings_changed(_self: Any, _context: bpy.types.Context | None) -> None:
    from ..viewport import handlers as viewport

    viewport.settings_changed()


def _passes_changed(self: Any, _context: bpy.types.Context | None) -> None:
    for view_layer in self.id_data.view_layers:
        view_layer.update_render_passes()


class CurvreflObject(bpy.types.PropertyGroup):
    """Settings of one object"""

    __annotations__ = properties_of(OF_OBJECTS, _mirrors_changed)


class CurvreflScene(bpy.types.PropertyGroup):
    """Settings of one scene"""

    __annotations__ = {
        **properties_of(OF_SCENES, _settings_changed),
        "version": IntProperty(options={"HIDDEN"}, default=0),
        "film_source": PointerProperty(
            type=bpy.types.Scene,
            name="Film Of",
            description="The scene whose mirrors this one renders for its film",
            options={"HIDDEN"},
        ),
        "film_collection": PointerProperty(
            type=bpy.types.Collection,
            name="Film's Mirrors",
            description="The mirrors that are held out of the film's second view layer",
            options={"HIDDEN"},
        ),
        "film_composited": BoolProperty(
            name="Composited Before the Film",
            description="Whether the scene was composited before its film was set up",
            options={"HIDDEN"},
            default=True,
        ),
    }


class CurvreflViewLayer(bpy.types.PropertyGroup):
    """Settings of one view layer"""

    __annotations__ = {
        **properties_of(OF_VIEW_LAYERS, _passes_changed),
        "is_held_out": BoolProperty(
            name="Held Out for the Film",
            description="The view layer of a film in which its mirrors are held out",
            options={"HIDDEN"},
            default=False,
        ),
    }


CLASSES = (CurvreflObject, CurvreflScene, CurvreflViewLayer)


def use_defaults() -> None:
    """Give scenes that were never used with the extension the settings of the preferences."""
    chosen = current_options()
    for scene in bpy.data.scenes:
        settings = scene.curvrefl
        if settings.version or not scene.is_editable:
            continue
        for name, value in chosen.new_scenes.items():
            if not settings.is_property_set(name):
                setattr(settings, name, value)
        settings.version = SETTINGS_VERSION


def add() -> None:
    """Attach the groups to Blender's types; the classes are registered."""
    bpy.types.Object.curvrefl = PointerProperty(type=CurvreflObject)
    bpy.types.Scene.curvrefl = PointerProperty(type=CurvreflScene)
    bpy.types.ViewLayer.curvrefl = PointerProperty(type=CurvreflViewLayer)
    bpy.types.WindowManager.curvrefl_enabled = BoolProperty(
        name="Curved Reflections",
        description="Show what the mirrors reflect in all 3D viewports",
        default=False,
        options={"SKIP_SAVE"},
        update=_is_switched,
    )


def remove() -> None:
    """Detach them again."""
    for owner, name in (
        (bpy.types.Object, "curvrefl"),
        (bpy.types.Scene, "curvrefl"),
        (bpy.types.ViewLayer, "curvrefl"),
        (bpy.types.WindowManager, "curvrefl_enabled"),
    ):
        if hasattr(owner, name):
            delattr(owner, name)
